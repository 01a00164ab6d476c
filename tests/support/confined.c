/* Children that enter sandboxes. */
#include "tests/support/confined.h"

#include "ipc/sandbox/sandbox.h"
#include "tests/support/child.h"

#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

char confined_output[512];
char confined_folder[] = "/tmp/jolon-sandbox-XXXXXX";

int confined_make_folder(void **state)
{
    (void)state;
    return mkdtemp(confined_folder) ? 0 : -1;
}

int confined_remove_folder(void **state)
{
    (void)state;
    return rmdir(confined_folder);
}

static int is_there(void *context)
{
    struct sandbox sandbox;
    struct error_text error;
    (void)context;
    return sandbox_begin(&sandbox, ROLE_RECORDER, false, &error) == 0 && sandbox.on;
}

bool confined_available(void)
{
    return child_run(is_there, NULL) != 0;
}

int confined_skip(void)
{
    (void)puts("ok 1 - sandbox # skip the roles of a sanitized build have none");
    return 0;
}

int confined_run(int (*body)(void *context), void *context)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    int before = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 10);
    assert_true(dup2(fileno(file), STDERR_FILENO) >= 0);
    pid_t pid = child_start(body, context);
    dup2(before, STDERR_FILENO);
    close(before);
    int status = child_wait(pid);
    rewind(file);
    confined_output[fread(confined_output, 1, sizeof confined_output - 1, file)] = '\0';
    fclose(file);
    int result = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    if (result == NOT_ENTERED)
        fail_msg("the sandbox is not entered: %s", confined_output);
    return result;
}

void confined_use_memory(void)
{
    for (size_t bytes = 1; bytes < 64u << 20; bytes *= 3) {
        unsigned char *volatile block = malloc(bytes);
        if (block)
            block[bytes - 1] = 1;
        block = realloc(block, bytes * 2);
        free(block);
    }
}
