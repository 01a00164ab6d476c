/* Snapshots: a reader's private, whole copy of a committed frame.
 *
 * Readers register nothing, wait for nothing and map everything read-only: any number of them may
 * come, go and be killed. */
#ifndef JOLON_IPC_FRAME_SNAPSHOT_H
#define JOLON_IPC_FRAME_SNAPSHOT_H

#include "ipc/segment/segment.h"
#include "world/checksum.h"

struct snapshot {
    struct state_head head;
    struct entities entities; /* rows 0 .. head.used - 1 */
    uint8_t *fixed_damage;    /* [world.counts.fixed] */
    struct list_hashes lists; /* of the craters and dents seen so far */
    uint64_t overtaken;       /* copies since init that the world had gone on from: taken again */
    uint64_t damaged; /* ... that failed their checksum: while a repair went back, or wrong */
    void *memory;
};

/* Space for the view's capacity. 0, or -1 with errno. */
int snapshot_init(struct snapshot *snapshot, const struct view *view);
void snapshot_free(struct snapshot *snapshot);

/* Copies the last committed frame. 0; -1 with EAGAIN when the world went on faster than it could be
 * copied, 100 times in a row; -1 with EBADMSG when the copy fails its checksum (a damaged world).*/
int snapshot_take(struct snapshot *snapshot, const struct view *view);

/* Copies the head alone; same errors. */
int snapshot_head(struct state_head *head, const struct view *view);

/* The snapshot as a state, for state_digest() and the like; craters are the view's own list. */
struct state snapshot_state(const struct snapshot *snapshot, const struct view *view);

#endif
