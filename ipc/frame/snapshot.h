/* Snapshots: a reader's private, whole copy of a committed frame.
 *
 * Readers register nothing, wait for nothing and map everything read-only. Any number of them may
 * start, end and be killed. */
#ifndef JOLON_IPC_FRAME_SNAPSHOT_H
#define JOLON_IPC_FRAME_SNAPSHOT_H

#include "ipc/segment/segment.h"
#include "world/checksum.h"
#include "world/terrain/crater.h"

struct snapshot {
    struct state_head head;
    struct entities entities;            /* rows 0 .. head.used - 1; those after them have no id */
    uint8_t *fixed_damage;               /* [world.counts.fixed] */
    struct persistent_contact *contacts; /* [head.contact_count] */
    struct list_hashes lists;            /* of the craters and dents copied so far */
    struct crater_index craters;         /* of snapshot_take_poses() */
    uint64_t overtaken; /* copies that were taken again, because the buffer was being written */
    uint64_t damaged;   /* copies that failed their checksum, during a repair or by damage */
    uint32_t held;      /* rows that the last copy filled, whole or not */
    void *memory;
};

/* Allocates space for the view's capacity. Returns 0, or -1 with errno. */
int snapshot_init(struct snapshot *snapshot, const struct view *view);
void snapshot_free(struct snapshot *snapshot);

/* Copies the last committed frame. Returns 0; -1 with EAGAIN when the world wrote the buffer during
 * 100 copies in a row; -1 with EBADMSG when the copy fails its checksum (a damaged world). */
int snapshot_take(struct snapshot *snapshot, const struct view *view);

/* Sets the columns of the vehicles that cruise (world/entity/cruise.h) to where they are in the
 * frame of a copy: for readers that look at places, and make no digest. */
void snapshot_settle_poses(struct snapshot *snapshot, const struct view *view);

/* Copies the last committed frame with such places. */
int snapshot_take_poses(struct snapshot *snapshot, const struct view *view);

/* Returns the one of two copies that is of a later frame. Pure; any thread. */
static inline const struct snapshot *snapshot_later(const struct snapshot *a,
                                                    const struct snapshot *b)
{
    return a->head.frame > b->head.frame ? a : b;
}

/* Brings the head and these rows of the last copy to the last committed frame, with the places of
 * those that cruise, without its checksum and without contacts and damage of fixed objects: for
 * readers that follow a few rows from frame to frame, and take the next whole copy soon.
 * Returns false if there is no later frame, or if the world wrote the buffer during 100 copies in a
 * row. */
bool snapshot_take_row_poses(struct snapshot *snapshot, const struct view *view,
                             const uint32_t *rows, uint32_t count);

/* Copies the head alone, with the same errors. */
int snapshot_head(struct state_head *head, const struct view *view);

/* Returns the snapshot as a state, for state_digest(). Craters and dents are the view's own
 * lists. */
struct state snapshot_state(const struct snapshot *snapshot, const struct view *view);

#endif
