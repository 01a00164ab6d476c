/* Queue of bytes with three limits. */
#include "clients/harness/output.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A pipe that is writable takes this many bytes without blocking (PIPE_BUF). */
#define WRITE_AT_ONCE 4096u

static void append(struct output *output, const char *line)
{
    size_t length = strlen(line) + 1;
    if (output->begin && output->begin + output->used + length > output->room) {
        memmove(output->bytes, output->bytes + output->begin, output->used);
        output->begin = 0;
    }
    if (output->used + length > output->room) {
        size_t room = (output->used + length) * 2;
        char *bytes = realloc(output->bytes, room);
        if (!bytes) {
            output->closed = true;
            return;
        }
        output->bytes = bytes;
        output->room = room;
    }
    memcpy(output->bytes + output->begin + output->used, line, length);
    output->used += length;
    output->bytes[output->begin + output->used - 1] = '\n';
}

static void write_missed(struct output *output)
{
    char line[64];
    if (!output->missed)
        return;
    (void)snprintf(line, sizeof line, "{\"missed\":%llu}", (unsigned long long)output->missed);
    output->missed = 0;
    append(output, line);
}

void output_line(struct output *output, enum output_kind kind, const char *line)
{
    if (kind == OUTPUT_STATE && !output_takes_states(output))
        return;
    if (kind == OUTPUT_EVENT && output->used >= OUTPUT_EVENTS_MAX) {
        output->missed++;
        return;
    }
    if (kind == OUTPUT_EVENT)
        write_missed(output);
    append(output, line);
}

void output_object(struct output *output, enum output_kind kind, cJSON *object)
{
    char *line = cJSON_PrintUnformatted(object);
    if (line)
        output_line(output, kind, line);
    else
        output->closed = true;
    cJSON_free(line);
    cJSON_Delete(object);
}

void output_missed(struct output *output, uint64_t count)
{
    output->missed += count;
}

bool output_takes_states(const struct output *output)
{
    return output->used < OUTPUT_STATES_MAX;
}

void output_write(struct output *output)
{
    size_t bytes = output->used < WRITE_AT_ONCE ? output->used : WRITE_AT_ONCE;
    ssize_t put = bytes ? write(STDOUT_FILENO, output->bytes + output->begin, bytes) : 0;
    if (put < 0) {
        output->closed |= errno != EINTR && errno != EAGAIN;
        return;
    }
    output->begin += (size_t)put;
    output->used -= (size_t)put;
    if (output->used == 0) {
        output->begin = 0;
        write_missed(output);
    }
}

void output_close(struct output *output)
{
    free(output->bytes);
    *output = (struct output){0};
}
