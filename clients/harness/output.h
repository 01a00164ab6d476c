/* Queue of lines for standard output.
 *
 * A slow reader loses states first and then events, but never an answer: while many bytes wait, no
 * more commands are read, so that the memory for answers is bounded. No function blocks. */
#ifndef JOLON_CLIENTS_HARNESS_OUTPUT_H
#define JOLON_CLIENTS_HARNESS_OUTPUT_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Numbers of waiting bytes from which states are dropped, no commands are read, events are dropped.
 */
#define OUTPUT_STATES_MAX 65536u
#define OUTPUT_HOLD       262144u
#define OUTPUT_EVENTS_MAX 1048576u

enum output_kind { OUTPUT_ANSWER, OUTPUT_EVENT, OUTPUT_STATE };

struct output {
    char *bytes;
    size_t begin, used, room; /* bytes[begin .. begin + used) wait */
    uint64_t missed;          /* dropped events that were not reported yet */
    bool closed;              /* the reader has gone, or there was no memory */
};

/* Appends a line, given without its newline. A state or an event may be dropped. */
void output_line(struct output *output, enum output_kind kind, const char *line);

/* Appends a JSON object as a line and frees the object. */
void output_object(struct output *output, enum output_kind kind, cJSON *object);

/* Adds events that were lost elsewhere to those to be reported as missed. */
void output_missed(struct output *output, uint64_t count);

/* Returns true if a state would not be dropped. */
bool output_takes_states(const struct output *output);

/* Writes what standard output takes without blocking, when poll() says that it is writable. */
void output_write(struct output *output);

void output_close(struct output *output);

#endif
