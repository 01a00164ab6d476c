/* A pipe that holds back. */
#include "supervisor/words.h"

#include <fcntl.h>
#include <string.h>
#include <unistd.h>

int words_open(struct words *words)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return -1;
    (void)fcntl(ends[0], F_SETFL, O_NONBLOCK); /* of this end alone: who speaks may wait */
    *words = (struct words){.open = true, .fd = ends[0]};
    return ends[1];
}

static void pass_on(struct words *words, int log_fd)
{
    ssize_t written = write(log_fd, words->text, words->used);
    (void)written; /* a log that cannot be written holds nobody up */
    words->used = 0;
    words->text[0] = '\0';
}

void words_take(struct words *words, int log_fd, bool pass)
{
    ssize_t count = 1;
    while (words->open && count > 0) {
        if (words->used == WORDS_BYTES)
            pass_on(words, log_fd);
        count = read(words->fd, words->text + words->used, WORDS_BYTES - words->used);
        words->used += count > 0 ? (size_t)count : 0;
        words->text[words->used] = '\0';
    }
    if (pass && words->used > 0)
        pass_on(words, log_fd);
}

void words_end(struct words *words, int log_fd, bool pass)
{
    if (!words->open)
        return;
    words_take(words, log_fd, pass);
    close(words->fd);
    words->open = false;
    words->used = 0;
}
