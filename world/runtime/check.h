/* Checks of conditions that must hold, in every build. The process ends when one fails. */
#ifndef JOLON_WORLD_RUNTIME_CHECK_H
#define JOLON_WORLD_RUNTIME_CHECK_H

/* A false condition is a bug: the place is reported and the process aborts. Any thread. */
#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition))                                                                          \
            check_failed(#condition, __FILE__, __LINE__);                                          \
    } while (0)
_Noreturn void check_failed(const char *condition, const char *file, int line);

/* Reports one line: to standard error until log_open() directs it into the log. */
extern void (*check_report)(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
