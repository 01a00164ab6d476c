/* Ends the process when a check fails. */
#include "world/runtime/check.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

__attribute__((format(printf, 1, 2))) static void report(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    (void)vfprintf(stderr, format, args);
    va_end(args);
    (void)fputc('\n', stderr);
}

void (*check_report)(const char *format, ...) __attribute__((format(printf, 1, 2))) = report;

void check_failed(const char *condition, const char *file, int line)
{
    check_report("bug: %s does not hold at %s:%d", condition, file, line);
    abort();
}
