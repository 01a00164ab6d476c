/* Reads lines of standard input without waiting for the rest of a line. */
#ifndef JOLON_CLIENTS_HARNESS_INPUT_H
#define JOLON_CLIENTS_HARNESS_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define INPUT_LINE_MAX 65536u /* with its newline */

struct input {
    char bytes[INPUT_LINE_MAX + 1];
    size_t used;
    uint32_t line; /* number of the last line returned, from 1 */
    bool ended;    /* standard input has ended */
    bool skipping; /* dropping the rest of a line that is too long */
};

enum input_result { INPUT_NONE, INPUT_LINE, INPUT_TOO_LONG };

/* Reads the bytes that have come. Blocks if there are none. */
void input_read(struct input *input);

/* Moves the next line to `line`, NUL-terminated and without its newline, and its length to bytes.
 * The last line needs no newline. INPUT_NONE: no line is complete yet. */
enum input_result input_next(struct input *input, char line[INPUT_LINE_MAX + 1], size_t *bytes);

/* Returns true if input_read() has room to read into. */
bool input_room(const struct input *input);

#endif
