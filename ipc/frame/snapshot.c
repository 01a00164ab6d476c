/* A reader's copies: of a frame, of events; and the one writer's side of a command ring. */
#include "ipc/frame/snapshot.h"

#include "ipc/process/crash_point.h"
#include "world/entity/event.h"
#include "world/params.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define TRIES 100

/* Rule 6: what was copied of frame's buffer is whole if nobody began to write that buffer again,
 * which first happens for frame + 2. The fence keeps the copy before the look. */
static bool still_whole(const struct view *view, uint64_t frame)
{
    atomic_thread_fence(memory_order_acquire);
    return atomic_load_explicit(&view->commit->writing, memory_order_relaxed) < frame + 2;
}

int snapshot_init(struct snapshot *snapshot, const struct view *view)
{
    size_t columns = entities_bytes(view->header->capacity);
    *snapshot = (struct snapshot){0};
    snapshot->memory = aligned_alloc(COLUMN_ALIGN, columns);
    snapshot->fixed_damage = calloc(view->header->counts.fixed + 1, 1);
    if (!snapshot->memory || !snapshot->fixed_damage) {
        snapshot_free(snapshot);
        errno = ENOMEM;
        return -1;
    }
    entities_bind(&snapshot->entities, view->header->capacity, snapshot->memory);
    return 0;
}

void snapshot_free(struct snapshot *snapshot)
{
    free(snapshot->memory);
    free(snapshot->fixed_damage);
    *snapshot = (struct snapshot){0};
}

/* Rows, damage and lists against the head's checksum. */
static bool copy_good(struct snapshot *snapshot, const struct view *view, uint64_t frame)
{
    struct state copy = snapshot_state(snapshot, view);
    struct reason reason;
    if (snapshot->head.frame != frame || segment_check_head(view, &snapshot->head, &reason) != 0)
        return false;
    list_hashes_extend(&snapshot->lists, &copy);
    return state_checksum_of(&copy, rows_hash_again(&copy.entities, copy.head->used),
                             state_fixed_hash(&copy, view->header->counts.fixed),
                             &snapshot->lists) == snapshot->head.checksum;
}

int snapshot_take(struct snapshot *snapshot, const struct view *view)
{
    int bad = 0;
    for (int i = 0; i < TRIES; i++) {
        uint64_t frame = segment_load(&view->commit->commit);
        const struct state *from = &view->w[frame & 1];
        snapshot->head = *from->head;
        uint32_t used = snapshot->head.used;
        if (used > view->header->capacity)
            used = 0; /* torn, or damaged: found out below */
        entities_copy(&snapshot->entities, &from->entities, 0, used);
        memcpy(snapshot->fixed_damage, from->fixed_damage, view->header->counts.fixed);
        if (!still_whole(view, frame)) {
            snapshot->overtaken++;
            continue;
        }
        if (copy_good(snapshot, view, frame))
            return 0;
        /* A repair may have gone back a frame while this one was copied: look once more. */
        snapshot->lists = (struct list_hashes){0};
        snapshot->damaged++;
        if (++bad == 2) {
            errno = EBADMSG;
            return -1;
        }
    }
    errno = EAGAIN;
    return -1;
}

int snapshot_head(struct state_head *head, const struct view *view)
{
    for (int i = 0; i < TRIES; i++) {
        uint64_t frame = segment_load(&view->commit->commit);
        *head = *view->w[frame & 1].head;
        if (still_whole(view, frame)) {
            if (head->frame == frame)
                return 0;
            errno = EBADMSG;
            return -1;
        }
    }
    errno = EAGAIN;
    return -1;
}

struct state snapshot_state(const struct snapshot *snapshot, const struct view *view)
{
    return (struct state){.head = (struct state_head *)(uintptr_t)&snapshot->head,
                          .entities = snapshot->entities,
                          .fixed_damage = snapshot->fixed_damage,
                          .craters = view->w[0].craters,
                          .dents = view->w[0].dents};
}

/* The oldest event that no writer can be about to overwrite: one frame's most is left free. */
static uint64_t oldest_safe(const struct view *view, uint64_t end)
{
    uint64_t kept = view->header->event_slots - view->world.params->events_per_frame;
    uint64_t first = view->header->first_event;
    return end > kept && end - kept > first ? end - kept : first;
}

uint32_t events_read(const struct view *view, struct event_cursor *cursor, struct event *events,
                     uint32_t max)
{
    struct state_head head;
    uint32_t count = 0;
    if (snapshot_head(&head, view) != 0)
        return 0;
    uint64_t oldest = oldest_safe(view, head.event_end);
    if (cursor->next < view->header->first_event) /* never were in this ring: no gap */
        cursor->next = view->header->first_event;
    if (cursor->next < oldest) {
        cursor->gap += oldest - cursor->next;
        cursor->next = oldest;
    }
    uint64_t first = cursor->next;
    while (count < max && first + count < head.event_end) {
        events[count] = view->events[(first + count) & (view->header->event_slots - 1)];
        count++;
    }
    /* What the writer may have begun to overwrite while we copied is lost, not wrong. */
    atomic_thread_fence(memory_order_acquire);
    if (snapshot_head(&head, view) != 0)
        return 0;
    oldest = oldest_safe(view, head.event_end);
    if (first < oldest) {
        uint64_t lost = oldest - first < count ? oldest - first : count;
        memmove(events, events + lost, (count - lost) * sizeof *events);
        cursor->gap += lost;
        first += lost;
        count -= (uint32_t)lost;
    }
    cursor->next = first + count;
    return count;
}

/* Is the command among slots first .. end - 1? */
static bool command_known(const struct command_ring_words *words, const struct command *command,
                          uint64_t slots, uint64_t first, uint64_t end)
{
    for (uint64_t i = first; i < end; i++) {
        const struct command *old = &words->slot[i & (slots - 1)];
        if (old->source == command->source && old->source_sequence == command->source_sequence)
            return true;
    }
    return false;
}

int command_put(struct view *view, enum command_ring ring, const struct command *command)
{
    struct command_ring_words *words = view->commands[ring];
    struct state_head head;
    uint64_t slots = view->header->command_slots;
    uint64_t end = atomic_load_explicit(&words->head, memory_order_relaxed);
    bool full = snapshot_head(&head, view) != 0 || end - head.command_cursor[ring] >= slots;
    /* While there is room, the slot that comes next is no memory: a writer that was killed before
     * it moved the head may have left this very command there, and it does not count yet. */
    uint64_t remembered = full ? slots : slots - 1;
    if (command_known(words, command, slots, end > remembered ? end - remembered : 0, end)) {
        errno = EEXIST;
        return -1;
    }
    if (full) {
        errno = ENOBUFS;
        return -1;
    }
    struct command *slot = &words->slot[end & (slots - 1)];
    CRASH_POINT("command");
    *slot = *command;
    CRASH_POINT("command's sequence");
    slot->sequence = end;
    CRASH_POINT("command ring's head");
    atomic_store_explicit(&words->head, end + 1, memory_order_release);
    doorbell_ring(view->doors, ROLE_MOVER);
    CRASH_POINT("after a command");
    return 0;
}
