/* Lines of standard input, as they come, without ever waiting for the rest of one. */
#ifndef JOLON_CLIENTS_HARNESS_INPUT_H
#define JOLON_CLIENTS_HARNESS_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define INPUT_LINE_MAX 65536u /* with its newline */

struct input {
    char bytes[INPUT_LINE_MAX + 1];
    size_t used;
    uint32_t line; /* number of the last line given, from 1 */
    bool ended;    /* nothing more comes */
    bool skipping; /* the rest of a line that found no room */
};

enum input_result { INPUT_NONE, INPUT_LINE, INPUT_TOO_LONG };

/* Reads what there is to read. Blocks when poll() did not say that there is. */
void input_read(struct input *input);

/* Takes the next line out into line, terminated and without its newline; bytes: its length. The
 * last one needs no newline. INPUT_NONE: none is whole yet. */
enum input_result input_next(struct input *input, char line[INPUT_LINE_MAX + 1], size_t *bytes);

/* Has it room to read into? */
bool input_room(const struct input *input);

#endif
