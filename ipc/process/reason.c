/* Reasons. */
#include "ipc/process/reason.h"

#include "world/runtime/utf8.h"

#include <stdarg.h>

int reason_set(struct reason *reason, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    (void)utf8_format(reason->text, sizeof reason->text, format, args);
    va_end(args);
    reason->foreign = reason->damaged = false;
    return -1;
}
