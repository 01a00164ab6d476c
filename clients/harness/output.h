/* Lines for standard output, kept until the reader takes them.
 *
 * A slow reader loses states first, then events, and never an answer: while much waits no more
 * commands are read, so that what answers need is bounded. Nothing here blocks. */
#ifndef JOLON_CLIENTS_HARNESS_OUTPUT_H
#define JOLON_CLIENTS_HARNESS_OUTPUT_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define OUTPUT_STATES_MAX 65536u   /* bytes that wait, from which states are left out */
#define OUTPUT_HOLD       262144u  /* ... from which no more commands are read */
#define OUTPUT_EVENTS_MAX 1048576u /* ... from which events are missed */

enum output_kind { OUTPUT_ANSWER, OUTPUT_EVENT, OUTPUT_STATE };

struct output {
    char *bytes;
    size_t begin, used, room; /* bytes[begin .. begin + used) wait */
    uint64_t missed;          /* events left out and not yet told */
    bool closed;              /* nobody reads any more, or there was no memory */
};

/* Appends a line, given without its newline. A state or an event may be left out. */
void output_line(struct output *output, enum output_kind kind, const char *line);

/* Appends a JSON object as a line and frees the object. */
void output_object(struct output *output, enum output_kind kind, cJSON *object);

/* Events that were lost elsewhere: told like those left out here. */
void output_missed(struct output *output, uint64_t count);

/* Is a state worth making? */
bool output_takes_states(const struct output *output);

/* Writes what the reader takes at once; to be called when poll() says that it takes some. */
void output_write(struct output *output);

void output_close(struct output *output);

#endif
