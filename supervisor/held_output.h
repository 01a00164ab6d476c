/* The output of a role that is started again after a refusal. It would repeat the same line at
 * every attempt. So its output goes through a pipe instead of into the log, and the keeper holds it
 * back until it knows whether the text is new. Once the role is ready, its output is passed on at
 * once.
 *
 * Only the keeper's one thread uses it. Start with zeros. */
#ifndef JOLON_SUPERVISOR_HELD_OUTPUT_H
#define JOLON_SUPERVISOR_HELD_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>

#define HELD_OUTPUT_BYTES 4096u

struct held_output {
    bool open;
    int fd; /* reading end of the pipe */
    size_t used;
    char text[HELD_OUTPUT_BYTES + 1]; /* held back, NUL-terminated */
};

/* Opens a pipe. Returns its writing end, which the caller closes after fork(), or -1 with errno. */
int held_output_open(struct held_output *held);

/* Reads new output; never blocks. pass: writes it to the log (a descriptor), after the output held
 * back so far. Output for which there is no more room is written in any case. */
void held_output_read(struct held_output *held, int log_fd, bool pass);

/* Reads the last output, writes it to the log or discards it, and closes the pipe. */
void held_output_close(struct held_output *held, int log_fd, bool pass);

#endif
