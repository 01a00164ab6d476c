/* Attaching to a world in a role, and leaving it. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_ATTACH_H
#define JOLON_IPC_SEGMENT_SEGMENT_ATTACH_H

#include "ipc/segment/segment.h"

/* Attaches to a world in a role: takes the role's lock, checks magic, version, layout hash, size,
 * owner, mode and counts, maps, and marks the slot as starting. -1 with the reason when the world
 * does not exist, is not this build's, or the role is held by a live process. Does not block. */
int segment_attach(struct view *view, const char *name, enum role role, struct error_text *error);

/* The same without the role's lock: to be ready for the day that its holder dies. */
int segment_stand_by(struct view *view, const char *name, enum role role, struct error_text *error);

/* Waits, blocked in the kernel, until the role's lock is free, and takes it. Nothing of the world
 * may have been written, and nothing read from it counts, before this returns 0. -1 with EINTR when
 * the process is asked to stop meanwhile. A view that holds its role already has it at once. */
int segment_take(struct view *view);

/* The holder says that it is up, and who it is; readers may now count on it. */
void segment_ready(struct view *view);

/* Unmaps and drops the lock; marks the slot absent. */
void segment_detach(struct view *view);

#endif
