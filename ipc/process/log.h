/* The log: each entry is one line on standard error with monotonic time, role, level, frame and
 * text. Control bytes of untrusted text become '?'. A loop calls log_due() first, which limits the
 * rate. */
#ifndef JOLON_IPC_PROCESS_LOG_H
#define JOLON_IPC_PROCESS_LOG_H

#include <stdbool.h>
#include <stdint.h>

/* Exit codes of every program. */
enum exit_code { EXIT_OK = 0, EXIT_REFUSED = 1, EXIT_USAGE = 2, EXIT_GAVE_UP = 3 };

void log_open(const char *role);
void log_frame(uint64_t frame); /* the lines that follow show it */
void log_info(const char *format, ...) __attribute__((format(printf, 1, 2)));
void log_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Returns true at most once in every interval. Each place in the code keeps its own last_ns, 0 at
 * first. */
bool log_due(uint64_t *last_ns, uint64_t interval_ns);

/* Writes "PROGRAM: text" to standard error and ends the process: refused (exit 1), wrong usage
 * (exit 2). */
_Noreturn void die_refused(const char *format, ...) __attribute__((format(printf, 1, 2)));
_Noreturn void die_usage(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* As die_refused(), for a signal handler: ends the process without clean-up. */
_Noreturn void die_at_once(const char *text);

#endif
