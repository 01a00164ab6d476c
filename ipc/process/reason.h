/* A reason: the line that says what was refused and why. */
#ifndef JOLON_IPC_PROCESS_REASON_H
#define JOLON_IPC_PROCESS_REASON_H

#include <stdbool.h>

/* A place to say in one line what was refused and why. */
struct reason {
    char text[512];
    bool foreign; /* what was refused is no world of this build: nothing is lost with it */
    bool damaged; /* a check looked at the world and found it damaged; else it may be good */
};

/* Formats into reason and returns -1, so that a failing path reads "return reason_set(...)". */
int reason_set(struct reason *reason, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
