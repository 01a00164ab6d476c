/* Splits bytes into lines. */
#include "clients/harness/input.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

bool input_room(const struct input *input)
{
    return input->used < INPUT_LINE_MAX;
}

void input_read(struct input *input)
{
    ssize_t got = read(STDIN_FILENO, input->bytes + input->used, INPUT_LINE_MAX - input->used);
    if (got > 0)
        input->used += (size_t)got;
    else if (got == 0 || (errno != EINTR && errno != EAGAIN))
        input->ended = true;
}

static void drop(struct input *input, size_t bytes)
{
    input->used -= bytes;
    memmove(input->bytes, input->bytes + bytes, input->used);
}

enum input_result input_next(struct input *input, char line[INPUT_LINE_MAX + 1], size_t *bytes)
{
    const char *end = memchr(input->bytes, '\n', input->used);
    size_t length = end ? (size_t)(end - input->bytes) : input->used;
    if (!end && input->used < INPUT_LINE_MAX && !(input->ended && input->used))
        return INPUT_NONE;
    bool skipped = input->skipping;
    input->skipping = !end && !input->ended;
    if (!skipped)
        input->line++;
    if (!skipped && !input->skipping) {
        memcpy(line, input->bytes, length);
        line[length] = '\0';
        *bytes = length;
    }
    drop(input, end ? length + 1 : length);
    if (skipped)
        return input->skipping ? INPUT_NONE : input_next(input, line, bytes);
    return input->skipping ? INPUT_TOO_LONG : INPUT_LINE;
}
