/* Complaints: the line that says why no world can be made. */
#ifndef JOLON_WORLD_RUNTIME_ERROR_TEXT_H
#define JOLON_WORLD_RUNTIME_ERROR_TEXT_H

#include <stddef.h>

struct error_text {
    char *text; /* of the caller, at most bytes with the NUL */
    size_t bytes;
};

/* Formats the line and returns -1. */
int error_text_say(const struct error_text *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
int error_text_memory(const struct error_text *to);

#endif
