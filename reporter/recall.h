/* What a new holder of a command ring has to know before it takes its first command. */
#ifndef JOLON_REPORTER_RECALL_H
#define JOLON_REPORTER_RECALL_H

#include "ipc/segment.h"
#include "reporter/book.h"

/* Fills the book as the predecessor's was: with the answers that the event ring holds, and with the
 * commands that wait in the ring. Without it a command that the ring's memory has lost, or loses to
 * the next one put, would be done again when its sender repeats it. Reads the whole event ring:
 * some milliseconds. 0; -1 with errno EBADMSG when the world is damaged. */
int recall(struct book *book, const struct view *view, enum command_ring ring);

#endif
