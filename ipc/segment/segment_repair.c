/* A damaged world goes back to its newest whole frame.
 *
 * A frame is a pure function of the frame before and of its commands. The collider writes only the
 * other buffer, so the frame before the last committed one is intact until the next frame is
 * written. When the last frame is damaged, the frame before it is committed again, and what was
 * lost is computed again to the same bytes. */
#include "ipc/segment/segment_repair.h"

#include "ipc/process/crash_point.h"
#include "ipc/segment/frame_check.h"
#include "ipc/segment/segment_check.h"
#include "ipc/segment/segment_internal.h"

#include <inttypes.h>
#include <sys/mman.h>
#include <unistd.h>

/* What the world's memory holds. */
struct findings {
    uint64_t commit, moved;
    bool whole[2];              /* W[i] holds a whole frame of its parity */
    struct error_text state[2]; /* why not */
    bool committed;             /* W[commit & 1] holds frame commit, whole */
    bool moved_whole;           /* M holds the frame after commit */
    struct error_text table;    /* why not */
};

static struct findings inspect(const struct view *view)
{
    struct findings found = {.commit = atomic_load(&view->commit->commit),
                             .moved = atomic_load(&view->moved_word->moved)};
    for (uint64_t i = 0; i < 2; i++) {
        uint64_t frame = view->w[i].head->frame;
        if ((frame & 1) != i)
            error_text_set(&found.state[i], "%s holds frame %" PRIu64,
                           region_name(i ? REGION_WORLD_B : REGION_WORLD_A), frame);
        else
            found.whole[i] = segment_check_state(view, frame, &found.state[i]) == 0;
    }
    uint64_t last = found.commit & 1;
    found.committed = found.whole[last] && view->w[last].head->frame == found.commit;
    if (found.whole[last] && !found.committed)
        error_text_set(&found.state[last], "commit = %" PRIu64 ", and %s holds frame %" PRIu64,
                       found.commit, region_name(last ? REGION_WORLD_B : REGION_WORLD_A),
                       view->w[last].head->frame);
    found.moved_whole = segment_check_moved(view, found.commit + 1, &found.table) == 0;
    return found;
}

/* Checks that the commands which the frames after this one will take again are still in their
 * rings. */
static int commands_kept(const struct view *view, uint64_t frame, struct error_text *report)
{
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        uint64_t cursor = view->w[frame & 1].head->command_cursor[i];
        uint64_t head = atomic_load(&view->commands[i]->head);
        if (head - cursor > layout_ring_slots(view->header, i))
            return error_text_set(report,
                                  "ring %d holds the last %u commands, and %" PRIu64
                                  " came since frame %" PRIu64,
                                  i, layout_ring_slots(view->header, i), head - cursor, frame);
    }
    return 0;
}

/* Limits the commands of the frame that is made again to those that it took the first time, if the
 * damaged head's cursors are possible. */
static void limit_commands(const struct view *view, uint64_t frame)
{
    struct moved_word *words = view->moved_word;
    const struct state_head *good = view->w[frame & 1].head, *lost = view->w[~frame & 1].head;
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        uint64_t head = atomic_load(&view->commands[i]->head);
        bool likely =
            lost->command_cursor[i] >= good->command_cursor[i] && lost->command_cursor[i] <= head;
        CRASH_POINT("end of commands to take again");
        words->repeat_end[i] = likely ? lost->command_cursor[i] : head;
    }
    CRASH_POINT("frame to make again");
    words->repeat_frame = frame + 1;
}

static void put_words(const struct view *view, uint64_t commit, uint64_t moved)
{
    CRASH_POINT("repaired writing");
    atomic_store(&view->commit->writing, commit + 1); /* a reader that copies that buffer sees it */
    atomic_thread_fence(memory_order_seq_cst);
    CRASH_POINT("repaired moved");
    atomic_store(&view->moved_word->moved, moved);
    CRASH_POINT("repaired commit");
    atomic_store(&view->commit->commit, commit);
}

/* W[commit & 1] is whole, and the moved table or its word is not. */
static int move_again(const struct view *view, const struct findings *found,
                      struct error_text *report)
{
    if (found->moved == found->commit + 1)
        error_text_set(report, "world \"%s\": %s: frame %" PRIu64 " is moved again", view->name,
                       found->table.text, found->commit + 1);
    else
        error_text_set(report,
                       "world \"%s\": moved = %" PRIu64 " beside commit = %" PRIu64
                       ": goes on from "
                       "frame %" PRIu64,
                       view->name, found->moved, found->commit, found->commit);
    put_words(view, found->commit, found->commit + (found->moved_whole ? 1 : 0));
    return 1;
}

static int go_back(const struct view *view, const struct findings *found, struct error_text *report)
{
    struct error_text detail;
    uint64_t last = found->commit & 1;
    if (!found->whole[0] && !found->whole[1]) {
        error_text_set(report, "world \"%s\" is damaged in both buffers: %s; %s", view->name,
                       found->state[last].text, found->state[!last].text);
        return -1;
    }
    uint64_t frame = view->w[found->whole[0] ? 0 : 1].head->frame;
    if (found->whole[0] && found->whole[1] && view->w[1].head->frame > frame)
        frame = view->w[1].head->frame;
    if (commands_kept(view, frame, &detail) != 0) {
        error_text_set(report, "world \"%s\" is damaged: %s; frame %" PRIu64 " is whole, but %s",
                       view->name, found->state[last].text, frame, detail.text);
        return -1;
    }
    bool moved = segment_check_moved(view, frame + 1, &detail) == 0;
    if (!moved && frame + 1 == found->commit)
        limit_commands(view, frame);
    put_words(view, frame, frame + (moved ? 1 : 0));
    error_text_set(report, "world \"%s\": %s: goes on from frame %" PRIu64 ", the newest whole one",
                   view->name, found->state[last].text, frame);
    return 1;
}

static int repair(const struct view *view, struct error_text *report)
{
    struct error_text detail;
    if (segment_verify(view, &detail) != 0)
        return error_text_set(report, "world \"%s\" is %s", view->name, detail.text);
    struct findings found = inspect(view);
    if (!found.committed)
        return go_back(view, &found, report);
    if (found.moved != found.commit && !(found.moved == found.commit + 1 && found.moved_whole))
        return move_again(view, &found, report);
    error_text_set(report, "world \"%s\": good at frame %" PRIu64, view->name, found.commit);
    return 0;
}

static bool frame_words_only(enum role role, enum region region)
{
    (void)role;
    return region == REGION_COMMIT || region == REGION_MOVED_WORD;
}

int segment_repair(const char *name, struct error_text *report)
{
    static const enum role writers[] = {ROLE_MOVER, ROLE_COLLIDER};
    struct segment_paths paths;
    struct view view;
    int held[2] = {-1, -1};
    int result = -1;
    if (segment_view_named(&view, name, ROLE_NONE, report) != 0 ||
        segment_paths(&paths, name, report) != 0)
        return -1;
    bool exists = paths.object[0] != '\0'; /* if not, segment_map() refuses */
    for (int i = 0; i < 2 && exists; i++) {
        view.role = writers[i];
        if (segment_lock(&view, paths.lock, false, report) != 0)
            goto err_lock;
        held[i] = view.lock_fd;
    }
    if (segment_map(&view, frame_words_only, report) != 0)
        goto err_lock;
    result = repair(&view, report);
    report->damaged = result < 0;
    munmap(view.base, view.layout.total);
    posts_file_close(&view.posts_file);
err_lock:
    for (int i = 0; i < 2; i++) {
        if (held[i] >= 0)
            close(held[i]);
    }
    return result;
}
