/* Error texts: one line that says what was refused and why. */
#ifndef JOLON_WORLD_RUNTIME_ERROR_TEXT_H
#define JOLON_WORLD_RUNTIME_ERROR_TEXT_H

#include <stdbool.h>

/* What was refused and why, in one line. */
struct error_text {
    char text[1024]; /* of a file: "file:line: key = value: what is wrong; what would be right" */
    bool foreign; /* what was refused is not a world of this build, so removing it loses nothing */
    bool damaged; /* a check looked at the world and found it damaged; else it may be good */
};

/* Formats the line, which is cut between two characters where it is too long, and clears both
 * flags. No argument may point into the line itself. Returns -1, so that a failing path reads
 * "return error_text_set(...)". */
int error_text_set(struct error_text *error, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Sets the line for a world whose tables do not fit into memory. Returns -1. */
int error_text_memory(struct error_text *error);

#endif
