/* One line an entry to standard error: monotonic time, role, level, frame, text. Untrusted bytes
 * in the text are escaped. log_* in a loop is rate-limited by the caller's log_due(). */
#ifndef JOLON_IPC_PROCESS_LOG_H
#define JOLON_IPC_PROCESS_LOG_H

#include <stdbool.h>
#include <stdint.h>

/* Exit codes of every program. */
enum exit_code { EXIT_OK = 0, EXIT_REFUSED = 1, EXIT_USAGE = 2, EXIT_GAVE_UP = 3 };

void log_open(const char *role);
void log_frame(uint64_t frame); /* shown in the lines that follow */
void log_info(const char *format, ...) __attribute__((format(printf, 1, 2)));
void log_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* True at most once every interval; keep one uint64_t for each place. */
bool log_due(uint64_t *last_ns, uint64_t interval_ns);

/* "PROGRAM: text" to standard error and exit: refused (1), wrong usage (2). */
_Noreturn void die_refused(const char *format, ...) __attribute__((format(printf, 1, 2)));
_Noreturn void die_usage(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* The same from within a signal handler: writes at once and ends the process without clean-up. */
_Noreturn void die_at_once(const char *text);

#endif
