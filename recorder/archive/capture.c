/* Copies a frame, the command rings and the moved table consistently. */
#include "recorder/archive/capture.h"

#include "ipc/frame/frame_protocol.h"
#include "world/entity/event.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define TRIES 100

static uint64_t larger(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

int capture_init(struct capture *capture, const struct view *view)
{
    const struct segment_header *header = view->header;
    *capture = (struct capture){0};
    if (snapshot_init(&capture->snapshot, view) != 0)
        return -1;
    bool complete = true;
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        capture->ring[i].slot = calloc(layout_ring_slots(header, i), sizeof(struct command));
        complete = complete && capture->ring[i].slot;
    }
    capture->memory = aligned_alloc(TABLE_ALIGN, entities_bytes(header->capacity));
    capture->moved.intents = calloc(header->intents_per_frame + 1, sizeof(struct event));
    if (!complete || !capture->memory || !capture->moved.intents) {
        capture_free(capture);
        errno = ENOMEM;
        return -1;
    }
    capture->moved.head = &capture->moved_head;
    entities_bind(&capture->moved.entities, header->capacity, capture->memory);
    return 0;
}

void capture_free(struct capture *capture)
{
    snapshot_free(&capture->snapshot);
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        free(capture->ring[i].slot);
    free(capture->memory);
    free(capture->moved.intents);
    *capture = (struct capture){0};
}

/* Copies the moved table if it holds the frame after the snapshot's. The mover overwrites it only
 * after that frame's commit (rule 3), so the copy is whole if the frame is not committed yet.
 * Returns false if the caller must try again. */
static bool take_moved(struct capture *capture, const struct view *view)
{
    uint64_t frame = capture->snapshot.head.frame;
    const struct moved *from = &view->m;
    capture->inputs = segment_load(&view->moved_word->moved) == frame + 1;
    if (!capture->inputs)
        return segment_load(&view->commit->commit) == frame;
    capture->moved_head = *from->head;
    uint32_t used = from->head->used, intents = from->head->intent_count;
    if (used > view->header->capacity || intents > view->header->intents_per_frame)
        used = intents = 0; /* torn or damaged: the checks below find it */
    entities_copy(&capture->moved.entities, &from->entities, 0, used);
    memcpy(capture->moved.intents, from->intents, intents * sizeof(struct event));
    atomic_thread_fence(memory_order_acquire);
    return atomic_load_explicit(&view->commit->commit, memory_order_relaxed) == frame &&
           capture->moved_head.frame == frame + 1 && capture->moved_head.used == used &&
           capture->moved_head.intent_count == intents;
}

/* Copies the commands before end that the ring still holds. Its writer may go on during the copy.
 * Slots that it has written since, and the slot that it writes next if the ring is not full, are
 * dropped. Returns false if an untaken command is among them. */
static bool take_ring(struct capture *capture, const struct view *view, int ring, uint64_t end)
{
    const struct command_ring_words *words = view->commands[ring];
    struct command *slot = capture->ring[ring].slot;
    uint64_t slots = layout_ring_slots(view->header, ring), mask = slots - 1;
    uint64_t cursor = capture->snapshot.head.command_cursor[ring];
    uint64_t first = end > slots ? end - slots : 0;
    struct state_head now;
    for (uint64_t i = first; i < end; i++)
        slot[i & mask] = words->slot[i & mask];
    atomic_thread_fence(memory_order_acquire);
    uint64_t head = atomic_load_explicit(&words->head, memory_order_relaxed);
    if (snapshot_head(&now, view) != 0)
        return false;
    bool full = head - now.command_cursor[ring] >= slots;
    if (head >= slots)
        first = larger(first, full ? head - slots : head - slots + 1);
    capture->ring[ring].first = first < end ? first : end;
    capture->ring[ring].end = end;
    return capture->ring[ring].first <= cursor;
}

static bool take(struct capture *capture, const struct view *view, bool inputs)
{
    uint64_t head[COMMAND_RING_COUNT];
    bool whole = true;
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        head[i] = segment_load(&view->commands[i]->head);
    if (snapshot_take(&capture->snapshot, view) != 0)
        return false;
    errno = EAGAIN;
    capture->inputs = false;
    if (inputs && !take_moved(capture, view))
        return false;
    for (int i = 0; i < COMMAND_RING_COUNT && whole; i++) {
        uint64_t end =
            larger(frame_protocol_commands_end(view, capture->snapshot.head.frame + 1, i, head[i]),
                   capture->snapshot.head.command_cursor[i]);
        if (capture->inputs)
            end = larger(end, capture->moved_head.command_cursor[i]);
        whole = take_ring(capture, view, i, end);
    }
    return whole;
}

int capture_take(struct capture *capture, const struct view *view, bool inputs)
{
    errno = EAGAIN;
    for (int i = 0; i < TRIES; i++) {
        if (take(capture, view, inputs))
            return 0;
        if (errno == EBADMSG)
            return -1;
    }
    return -1;
}
