/* Complaints: the line that says why no world can be made. */
#ifndef JOLON_WORLD_COMPLAINT_H
#define JOLON_WORLD_COMPLAINT_H

#include <stddef.h>

struct complaint {
    char *text; /* of the caller, at most bytes with the NUL */
    size_t bytes;
};

/* Formats the line and returns -1. */
int complaint_say(const struct complaint *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
int complaint_memory(const struct complaint *to);

#endif
