/* Replaces exit() of the C library. */
#include "tests/fuzz/shared/ending.h"

#include "ipc/process/log.h"
#include "world/runtime/check.h"

#include <stdbool.h>

_Noreturn void __wrap_exit(int code);
_Noreturn void __real_exit(int code);

jmp_buf ending;
static bool catching;

void ending_begin(void)
{
    catching = true;
}

void ending_done(void)
{
    catching = false;
}

_Noreturn void __wrap_exit(int code)
{
    if (!catching)
        __real_exit(code);
    CHECK(code == EXIT_OK || code == EXIT_REFUSED || code == EXIT_USAGE);
    longjmp(ending, 1);
}
