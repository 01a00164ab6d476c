/* The rest of a role's region behind its slot: notes that a role leaves for the process that takes
 * the role after it was killed. Only the role's holder writes them, and no result of the world
 * depends on them. They are 0 in a new world, and no image has them. */
#ifndef JOLON_IPC_SEGMENT_ROLE_NOTES_H
#define JOLON_IPC_SEGMENT_ROLE_NOTES_H

#include "ipc/segment/role.h"

#define ROLE_NOTES_BYTES (ROLE_SLOT_BYTES - sizeof(struct role_slot))

static inline void *role_notes(struct role_slot *slot)
{
    return slot + 1;
}

#endif
