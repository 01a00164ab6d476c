/* The one writer's side of a command ring. */
#ifndef JOLON_IPC_FRAME_COMMAND_RING_H
#define JOLON_IPC_FRAME_COMMAND_RING_H

#include "ipc/segment/segment.h"

/* Adds a command to a ring that this process writes. 0; -1 with ENOBUFS when the ring is full,
 * EEXIST when the ring's memory already holds (source, source_sequence). */
int command_put(struct view *view, enum command_ring ring, const struct command *command);

#endif
