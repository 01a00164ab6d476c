/* Attaching to a world in a role, and leaving it. */
#ifndef JOLON_IPC_SEGMENT_SEGMENT_ATTACH_H
#define JOLON_IPC_SEGMENT_SEGMENT_ATTACH_H

#include "ipc/segment/segment.h"

/* Attaches to a world in a role: takes the role's lock, checks owner, mode, magic, version, layout
 * hash, counts and size, maps, and marks the slot as starting. Returns 0. Returns -1 with the
 * reason when the world does not exist, is of another build, or a live process holds the role. Does
 * not block. */
int segment_attach(struct view *view, const char *name, enum role role, struct error_text *error);

/* As segment_attach(), but leaves the role's lock to segment_take(): for a process that waits until
 * the role's holder dies. */
int segment_stand_by(struct view *view, const char *name, enum role role, struct error_text *error);

/* Blocks in the kernel until the role's lock is free, and takes it. Before this returns 0 the
 * process must not write to the world, and what it reads may change. Returns -1 with EINTR when the
 * process is asked to stop. Returns 0 at once for a view that holds its role. */
int segment_take(struct view *view);

/* Writes the holder's pid into its slot and marks the role as ready. */
void segment_ready(struct view *view);

/* Marks the slot as absent, unmaps and drops the lock. */
void segment_detach(struct view *view);

#endif
