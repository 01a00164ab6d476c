/* What a role says that is tried again after a refusal. It would say the same line at every try, so
 * the keeper holds its words back until it knows whether they are new: they come through a pipe
 * instead of into the log. Once the role is up they are passed on as they come.
 *
 * Only the keeper's one thread uses it. Begin with zeros. */
#ifndef JOLON_SUPERVISOR_WORDS_H
#define JOLON_SUPERVISOR_WORDS_H

#include <stdbool.h>
#include <stddef.h>

#define WORDS_BYTES 4096u

struct words {
    bool open;
    int fd; /* the pipe's end that is read */
    size_t used;
    char text[WORDS_BYTES + 1]; /* held back; ends with a NUL */
};

/* Opens a pipe. Its other end, which the caller closes after fork; -1 with errno. */
int words_open(struct words *words);

/* Takes what was said meanwhile; never blocks. pass: it goes to the log (a descriptor), with what
 * was held back, and so does what there is no more room for. */
void words_take(struct words *words, int log_fd, bool pass);

/* Takes the last of it, and passes it on or forgets it. */
void words_end(struct words *words, int log_fd, bool pass);

#endif
