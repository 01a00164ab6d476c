/* The writer's side of a command ring, which has one writing process. */
#ifndef JOLON_IPC_FRAME_COMMAND_RING_H
#define JOLON_IPC_FRAME_COMMAND_RING_H

#include "ipc/segment/segment.h"

/* Adds a command to a ring that this process writes, and rings the mover. Returns 0; -1 with EEXIST
 * when the ring still holds a command of the same (source, source_sequence), -1 with ENOBUFS when
 * the ring is full. */
int command_put(struct view *view, enum command_ring ring, const struct command *command);

/* Adds a record or command without looking for a repetition: for a writer of thousands a second
 * that may say a thing twice. taken: a number up to which the mover has certainly taken the ring's
 * commands, such as the cursor of a snapshot. Rings nobody. Returns 0, or -1 with ENOBUFS when the
 * ring is full. */
int command_append(struct view *view, enum command_ring ring, const struct command *command,
                   uint64_t taken);

#endif
