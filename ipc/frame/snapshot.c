/* Copies of a committed frame. */
#include "ipc/frame/snapshot.h"

#include "ipc/segment/frame_check.h"
#include "world/cruise_pose.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/table_write.h"
#include "world/params.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define TRIES 100

/* Rule 6: a copy of frame's buffer is whole if the collider had not begun to write that buffer
 * again, which first happens for frame + 2. The fence orders the copy before the check. */
static bool still_whole(const struct view *view, uint64_t frame)
{
    atomic_thread_fence(memory_order_acquire);
    return atomic_load_explicit(&view->commit->writing, memory_order_relaxed) < frame + 2;
}

int snapshot_init(struct snapshot *snapshot, const struct view *view)
{
    *snapshot = (struct snapshot){0};
    snapshot->memory = calloc(1, entities_bytes(view->header->capacity));
    snapshot->fixed_damage = calloc(view->header->counts.fixed + 1, 1);
    snapshot->contacts = calloc(view->header->contact_slots + 1u, sizeof *snapshot->contacts);
    if (!snapshot->memory || !snapshot->fixed_damage || !snapshot->contacts ||
        (view->world.params->cruise &&
         crater_index_init(&snapshot->craters, &view->world.terrain.squares, view->w[0].craters) !=
             0)) {
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
    free(snapshot->contacts);
    crater_index_free(&snapshot->craters);
    *snapshot = (struct snapshot){0};
}

/* Compares rows, damage and lists with the head's checksum. */
static bool copy_good(struct snapshot *snapshot, const struct view *view, uint64_t frame)
{
    struct state copy = snapshot_state(snapshot, view);
    struct error_text error;
    if (snapshot->head.frame != frame || segment_check_head(view, &snapshot->head, &error) != 0)
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
        uint32_t used = snapshot->head.used, contacts = snapshot->head.contact_count;
        if (used > view->header->capacity || contacts > view->header->contact_slots)
            used = contacts = 0; /* torn or damaged, which the checks below find */
        entities_copy(&snapshot->entities, &from->entities, 0, used);
        table_clear_unused(&snapshot->entities, used, snapshot->held);
        snapshot->held = used;
        memcpy(snapshot->fixed_damage, from->fixed_damage, view->header->counts.fixed);
        memcpy(snapshot->contacts, from->contacts, contacts * sizeof *from->contacts);
        if (!still_whole(view, frame)) {
            snapshot->overtaken++;
            continue;
        }
        if (copy_good(snapshot, view, frame))
            return 0;
        /* A repair may have gone back a frame during the copy, so it is tried once more. */
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

void snapshot_settle_poses(struct snapshot *snapshot, const struct view *view)
{
    if (!view->world.params->cruise)
        return;
    crater_index_update(&snapshot->craters, snapshot->head.crater_count);
    cruise_pose_settle(&snapshot->entities, &view->world, &snapshot->craters, snapshot->head.used,
                       snapshot->head.tick);
}

int snapshot_take_poses(struct snapshot *snapshot, const struct view *view)
{
    int result = snapshot_take(snapshot, view);
    if (result == 0)
        snapshot_settle_poses(snapshot, view);
    return result;
}

/* Sets the columns of these rows, which are those of the head's frame, to where they are in it. */
static void settle_rows(struct snapshot *snapshot, const struct view *view, const uint32_t *rows,
                        uint32_t count)
{
    if (!view->world.params->cruise)
        return;
    crater_index_update(&snapshot->craters, snapshot->head.crater_count);
    for (uint32_t k = 0; k < count; k++)
        cruise_pose_settle_row(&snapshot->entities, &view->world, &snapshot->craters, rows[k],
                               snapshot->head.tick);
}

bool snapshot_take_row_poses(struct snapshot *snapshot, const struct view *view,
                             const uint32_t *rows, uint32_t count)
{
    for (int i = 0; i < TRIES; i++) {
        uint64_t frame = segment_load(&view->commit->commit);
        const struct state *from = &view->w[frame & 1];
        struct state_head head = *from->head;
        if (frame == snapshot->head.frame)
            return false;
        for (uint32_t k = 0; k < count; k++)
            entities_copy(&snapshot->entities, &from->entities, rows[k], 1);
        if (still_whole(view, frame) && head.frame == frame) {
            snapshot->head = head;
            settle_rows(snapshot, view, rows, count);
            return true;
        }
        snapshot->overtaken++;
    }
    return false;
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
                          .contacts = snapshot->contacts,
                          .craters = view->w[0].craters,
                          .dents = view->w[0].dents};
}
