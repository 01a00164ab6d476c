/* The frame protocol: the waits and the two commits. Comments name the rules of ipc/README.md. */
#include "ipc/frame/frame_protocol.h"

#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/segment/frame_check.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/runtime/check.h"

#include <errno.h>
#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#define WAIT_MAX_NS (20 * (uint64_t)NS_PER_MS) /* no wait without a heartbeat is longer */
#define STEP_MAX_NS ((uint64_t)NS_PER_S) /* even the slowest world takes commands every second */

/* A quarter of a frame: the most that one lost doorbell may cost. */
static uint64_t bell_wait_ns(const struct view *view)
{
    uint64_t quarter = (uint64_t)(view->world.params->dt_s * 0.25e9);
    return quarter < WAIT_MAX_NS ? quarter : WAIT_MAX_NS;
}

void frame_protocol_beat(struct view *view)
{
    CHECK(view->role < ROLE_COUNT);
    CRASH_POINT("beat");
    atomic_store_explicit(&view->slot[view->role]->beat_ns, clock_now_ns(), memory_order_relaxed);
}

void frame_protocol_stage_done(struct view *view, uint64_t number, uint64_t stage_ns)
{
    struct role_slot *slot = view->slot[view->role];
    histogram_add(&slot->stage, stage_ns);
    CRASH_POINT("stage's time");
    atomic_store_explicit(&slot->stage_ns, stage_ns, memory_order_relaxed);
    CRASH_POINT("stage's frame");
    atomic_store_explicit(&slot->frame, number, memory_order_relaxed);
}

static bool head_finished(const struct view *view, const struct state_head *head, uint64_t commit)
{
    uint64_t limit = view->world.params->frame_limit;
    return head->quit || (limit != 0 && commit >= limit);
}

bool frame_protocol_finished(const struct view *view)
{
    uint64_t commit = segment_load(&view->commit->commit);
    return head_finished(view, view->w[commit & 1].head, commit);
}

/* Rule 1. A world that breaks it was written by another process than its two writers, so no process
 * may continue from it. */
static void check_words(const struct view *view, uint64_t commit, uint64_t moved)
{
    if (moved != commit && moved != commit + 1)
        die_refused("world \"%s\" is damaged: moved = %llu beside commit = %llu; it can only be "
                    "the same or one more",
                    view->name, (unsigned long long)moved, (unsigned long long)commit);
}

static void check_frame(struct view *view, uint64_t commit)
{
    const struct state_head *head = view->w[commit & 1].head;
    struct error_text error;
    if (head->frame != commit)
        die_refused("world \"%s\" is damaged: buffer %llu holds frame %llu; commit = %llu",
                    view->name, (unsigned long long)(commit & 1), (unsigned long long)head->frame,
                    (unsigned long long)commit);
    if (segment_check_head(view, head, &error) != 0)
        die_refused("world \"%s\" is damaged: %s", view->name, error.text);
    if (view->checked)
        return; /* later frames were computed from whole ones */
    if (segment_check_state(view, commit, &error) != 0 ||
        (view->role == ROLE_COLLIDER && segment_check_moved(view, commit + 1, &error) != 0))
        die_refused("world \"%s\" is damaged: %s", view->name, error.text);
    view->checked = true;
}

static bool commands_wait(const struct frame_protocol *frame, const struct state_head *head)
{
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        if (frame->command_head[i] > head->command_cursor[i])
            return true;
    }
    return false;
}

/* Returns true when the frame may begin by the mover's clock, else waits and returns false. If the
 * frame is due at the first look, the previous frame was late: it was committed after this one was
 * due. When the mover is more than one frame behind, the clock starts again from now, so that lost
 * time is not made up. */
static bool due(struct frame_protocol *frame, struct view *view, const struct state_head *head)
{
    struct role_slot *slot = view->slot[ROLE_MOVER];
    uint64_t now = clock_now_ns();
    uint64_t step = (uint64_t)(view->world.params->dt_s * 1e9 / head->time_scale);
    uint64_t due_ns = atomic_load_explicit(&slot->due_ns, memory_order_relaxed);
    step = step < STEP_MAX_NS ? step : STEP_MAX_NS;
    if (view->world.params->pace == PACE_MAX)
        return true;
    if (due_ns == 0) {
        CRASH_POINT("first due time");
        atomic_store_explicit(&slot->due_ns, now + step, memory_order_relaxed);
        return true;
    }
    if (now < due_ns) {
        frame->in_time = true;
        doorbell_wait(view->doorbells, ROLE_MOVER,
                      due_ns - now < WAIT_MAX_NS ? due_ns : now + WAIT_MAX_NS);
        return false;
    }
    if (!frame->in_time) {
        CRASH_POINT("late frame");
        atomic_fetch_add_explicit(&slot->late_frames, 1, memory_order_relaxed);
    }
    if (now > due_ns + step)
        due_ns = now;
    CRASH_POINT("next due time");
    atomic_store_explicit(&slot->due_ns, due_ns + step, memory_order_relaxed);
    return true;
}

uint64_t frame_protocol_commands_end(const struct view *view, uint64_t number, int ring,
                                     uint64_t head)
{
    const struct moved_word *words = view->moved_word;
    return words->repeat_frame == number && words->repeat_end[ring] < head ? words->repeat_end[ring]
                                                                           : head;
}

static void look_for_commands(struct frame_protocol *frame, const struct view *view,
                              uint64_t number)
{
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        frame->command_head[i] =
            frame_protocol_commands_end(view, number, i, segment_load(&view->commands[i]->head));
}

int frame_protocol_mover_begin(struct frame_protocol *frame, struct view *view)
{
    frame->in_time = false;
    while (!process_stopping()) {
        uint64_t commit = segment_load(&view->commit->commit);
        uint64_t moved = segment_load(&view->moved_word->moved);
        frame_protocol_beat(view);
        check_words(view, commit, moved);
        if (moved == commit + 1) { /* rule 3: the collider may read M until it commits */
            doorbell_wait(view->doorbells, ROLE_MOVER, clock_now_ns() + bell_wait_ns(view));
            continue;
        }
        const struct state_head *head = view->w[commit & 1].head;
        check_frame(view, commit);
        if (head_finished(view, head, commit))
            return -1;
        look_for_commands(frame, view, commit + 1);
        if (head->paused && head->steps_left == 0 && !commands_wait(frame, head)) {
            CRASH_POINT("no due time");
            atomic_store_explicit(&view->slot[ROLE_MOVER]->due_ns, 0, memory_order_relaxed);
            doorbell_wait(view->doorbells, ROLE_MOVER, clock_now_ns() + WAIT_MAX_NS);
            continue;
        }
        if (!due(frame, view, head))
            continue;
        frame->number = commit + 1;
        frame->begun_ns = clock_now_ns();
        log_frame(frame->number);
        CRASH_POINT_GUARD_STORES(view->m.head, view->layout.bytes[REGION_MOVED]);
        return 0;
    }
    return -1;
}

void frame_protocol_mover_end(struct frame_protocol *frame, struct view *view)
{
    uint64_t stage_ns = clock_now_ns() - frame->begun_ns;
    CRASH_POINT_UNGUARD();
    CRASH_POINT("mover's time");
    view->m.head->mover_ns = stage_ns;
    frame_protocol_stage_done(view, frame->number, stage_ns);
    CRASH_POINT("moved");
    atomic_store_explicit(&view->moved_word->moved, frame->number, memory_order_release);
    doorbell_ring(view->doorbells, ROLE_COLLIDER);
}

int frame_protocol_collider_begin(struct frame_protocol *frame, struct view *view)
{
    while (!process_stopping()) {
        uint64_t commit = atomic_load_explicit(&view->commit->commit, memory_order_relaxed);
        uint64_t moved = segment_load(&view->moved_word->moved);
        frame_protocol_beat(view);
        check_words(view, commit, moved);
        if (moved == commit + 1) {
            check_frame(view, commit);
            frame->number = commit + 1;
            frame->begun_ns = clock_now_ns();
            log_frame(frame->number);
            /* Readers of this buffer must see that it is being written (rule 6). */
            CRASH_POINT("writing");
            atomic_store_explicit(&view->commit->writing, frame->number, memory_order_relaxed);
            atomic_thread_fence(memory_order_release);
            CRASH_POINT("first store to the back buffer");
            CRASH_POINT_GUARD_STORES(view->w[0].head, view->layout.offset[REGION_MOVED_WORD] -
                                                          view->layout.offset[REGION_WORLD_A]);
            return 0;
        }
        if (frame_protocol_finished(view))
            return -1;
        doorbell_wait(view->doorbells, ROLE_COLLIDER, clock_now_ns() + bell_wait_ns(view));
    }
    return -1;
}

/* The low half of the commit word is the futex that readers wait on. */
static long commit_futex(const struct view *view, int operation, uint32_t value,
                         const struct timespec *timeout)
{
    return syscall(SYS_futex, (uintptr_t)&view->commit->commit, operation, value, timeout, NULL, 0);
}

void frame_protocol_collider_end(struct frame_protocol *frame, struct view *view)
{
    CRASH_POINT_UNGUARD();
    uint64_t mover_ns = view->m.head->mover_ns;
    uint64_t stage_ns = clock_now_ns() - frame->begun_ns;
    frame_protocol_stage_done(view, frame->number, stage_ns);
    histogram_add(&view->slot[ROLE_COLLIDER]->whole, mover_ns + stage_ns);
    CRASH_POINT("commit");
    atomic_store_explicit(&view->commit->commit, frame->number, memory_order_release);
    doorbell_ring(view->doorbells, ROLE_MOVER);
    for (int role = 0; role < ROLE_COUNT; role++) {
        if (role_has((enum role)role, ROLE_DRAWS))
            doorbell_ring(view->doorbells, (enum role)role);
    }
    CRASH_POINT("readers' wake");
    commit_futex(view, FUTEX_WAKE, INT32_MAX, NULL);
}

uint64_t frame_protocol_wait(const struct view *view, uint64_t seen, uint64_t until_ns)
{
    for (;;) {
        uint64_t commit = segment_load(&view->commit->commit);
        uint64_t now = clock_now_ns();
        if (commit > seen || now >= until_ns || process_stopping())
            return commit;
        if (role_has(view->role, ROLE_DRAWS)) {
            doorbell_wait(view->doorbells, view->role, until_ns);
            continue;
        }
        uint64_t left = until_ns - now;
        struct timespec wait = {.tv_sec = (time_t)(left / NS_PER_S),
                                .tv_nsec = (long)(left % NS_PER_S)};
        commit_futex(view, FUTEX_WAIT, (uint32_t)commit, &wait);
    }
}
