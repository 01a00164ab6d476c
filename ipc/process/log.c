/* The log, and the ways a program ends before its time. */
#include "ipc/process/log.h"

#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"
#include "world/runtime/check.h"
#include "world/runtime/utf8.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LINE_MAX_BYTES 1024

static const char *log_role = "jolon";
static uint64_t log_frame_number;

void log_open(const char *role)
{
    log_role = role;
    check_report = log_warn;
    CRASH_POINT_ROLE(role);
}

void log_frame(uint64_t frame)
{
    log_frame_number = frame;
}

/* Writes the line with one write(), so that lines of several processes do not mix. Control bytes
 * become '?'. The buffer has room for one more byte. */
static void write_line(char *line, int length)
{
    if (length < 0)
        return;
    for (int i = 0; i < length; i++) {
        if ((unsigned char)line[i] < 0x20 || line[i] == 0x7f)
            line[i] = '?';
    }
    line[length++] = '\n';
    ssize_t written = write(STDERR_FILENO, line, (size_t)length);
    (void)written; /* an error could not be reported anywhere */
}

__attribute__((format(printf, 2, 0))) static void log_line(const char *level, const char *format,
                                                           va_list args)
{
    char line[LINE_MAX_BYTES];
    uint64_t now = clock_now_ns();
    int length = snprintf(line, sizeof line,
                          "%llu.%06llu %s %s frame %llu: ", (unsigned long long)(now / NS_PER_S),
                          (unsigned long long)(now % NS_PER_S / 1000), log_role, level,
                          (unsigned long long)log_frame_number);
    if (length > 0 && length < (int)sizeof line)
        length += (int)utf8_format(line + length, sizeof line - 1 - (size_t)length, format, args);
    write_line(line, length);
}

void log_info(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_line("info", format, args);
    va_end(args);
}

void log_warn(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    log_line("warning", format, args);
    va_end(args);
}

bool log_due(uint64_t *last_ns, uint64_t interval_ns)
{
    uint64_t now = clock_now_ns();
    if (*last_ns != 0 && now - *last_ns < interval_ns)
        return false;
    *last_ns = now;
    return true;
}

__attribute__((format(printf, 1, 0))) static void fatal_line(const char *format, va_list args)
{
    char line[LINE_MAX_BYTES];
    int length = snprintf(line, sizeof line, "jolon: ");
    if (strcmp(log_role, "jolon") != 0)
        length = snprintf(line, sizeof line, "jolon-%s: ", log_role);
    length += (int)utf8_format(line + length, sizeof line - 1 - (size_t)length, format, args);
    write_line(line, length);
}

void die_refused(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fatal_line(format, args);
    va_end(args);
    exit(EXIT_REFUSED);
}

void die_usage(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fatal_line(format, args);
    va_end(args);
    exit(EXIT_USAGE);
}

void die_at_once(const char *text)
{
    const char *const parts[] = {"jolon",
                                 strcmp(log_role, "jolon") != 0 ? "-" : "",
                                 strcmp(log_role, "jolon") != 0 ? log_role : "",
                                 ": ",
                                 text,
                                 "\n"};
    char line[LINE_MAX_BYTES];
    size_t length = 0;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        for (const char *at = parts[i]; *at != '\0' && length < sizeof line; at++)
            line[length++] = *at;
    }
    ssize_t written = write(STDERR_FILENO, line, length);
    (void)written;
    _exit(EXIT_REFUSED);
}
