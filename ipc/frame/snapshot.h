/* Snapshots: a reader's private, whole copy of a committed frame, and its walk along the events.
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

struct event_cursor {
    uint64_t next; /* sequence of the event to read next */
    uint64_t gap;  /* events lost since the last read, because the ring had gone round */
};

/* Copies up to max committed events from cursor on; how many. Adds to cursor->gap what was lost.
 * Of a world that goes on from an image, the ring begins at header->first_event: what was before
 * is not to be had here, is skipped and is no gap. A reader that wants those looks at first_event
 * itself. A cursor beyond the last event reads nothing until the world comes there. */
uint32_t events_read(const struct view *view, struct event_cursor *cursor, struct event *events,
                     uint32_t max);

/* Adds a command to a ring that this process writes. 0; -1 with ENOBUFS when the ring is full,
 * EEXIST when the ring's memory already holds (source, source_sequence). */
int command_put(struct view *view, enum command_ring ring, const struct command *command);

#endif
