/* Holds output back in a buffer. */
#include "supervisor/held_output.h"

#include <fcntl.h>
#include <string.h>
#include <unistd.h>

int held_output_open(struct held_output *held)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return -1;
    (void)fcntl(ends[0], F_SETFL, O_NONBLOCK); /* the role's end stays blocking */
    *held = (struct held_output){.open = true, .fd = ends[0]};
    return ends[1];
}

static void pass_on(struct held_output *held, int log_fd)
{
    ssize_t written = write(log_fd, held->text, held->used);
    (void)written; /* a failed write must not block the keeper */
    held->used = 0;
    held->text[0] = '\0';
}

void held_output_read(struct held_output *held, int log_fd, bool pass)
{
    ssize_t count = 1;
    while (held->open && count > 0) {
        if (held->used == HELD_OUTPUT_BYTES)
            pass_on(held, log_fd);
        count = read(held->fd, held->text + held->used, HELD_OUTPUT_BYTES - held->used);
        held->used += count > 0 ? (size_t)count : 0;
        held->text[held->used] = '\0';
    }
    if (pass && held->used > 0)
        pass_on(held, log_fd);
}

void held_output_close(struct held_output *held, int log_fd, bool pass)
{
    if (!held->open)
        return;
    held_output_read(held, log_fd, pass);
    close(held->fd);
    held->open = false;
    held->used = 0;
}
