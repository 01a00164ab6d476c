/* Snapshots are never torn: while another process commits as fast as it can, all values of a
 * snapshot are of one frame. */
#include "ipc/frame/snapshot.h"

#include "tests/support/bare_view.h"
#include "tests/support/child.h"
#include "tests/support/numbered_frame.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define CAPACITY  48u
#define FIXED     333u
#define SNAPSHOTS 300000 /* of each of two readers */

static struct view view;

static void fill(const struct state *next)
{
    struct entities entities = next->entities;
    uint64_t frame = next->head->frame;
    next->head->crater_count = (uint32_t)(frame % 16);
    numbered_frame_fill(next->head, &entities, 1 + (uint32_t)(frame * 7 % CAPACITY));
    memset(next->fixed_damage, (int)(frame & 0xff), FIXED);
}

static int write_frames(void *context)
{
    const _Atomic bool *stop = context;
    struct view collider = bare_view_as(&view, ROLE_COLLIDER);
    while (!atomic_load(stop)) {
        fill(bare_view_begin(&collider));
        bare_view_end(&collider);
    }
    return 0;
}

static bool head_whole(const struct state_head *head)
{
    return numbered_frame_head(head) && head->crater_count == head->frame % 16;
}

static bool whole(const struct snapshot *s)
{
    uint64_t frame = s->head.frame;
    if (!head_whole(&s->head) || !numbered_frame_rows(&s->head, &s->entities))
        return false;
    for (uint32_t i = 0; i < FIXED; i++) {
        if (s->fixed_damage[i] != (frame & 0xff))
            return false;
    }
    return true;
}

enum { WHOLE, NO_MEMORY, DAMAGED, TORN, TORN_HEAD, BACKWARDS };

/* Runs also in a child, so it has no asserts. EAGAIN is a valid answer. */
static int read_snapshots(void *context)
{
    const struct view *reader = context;
    struct snapshot snapshot;
    struct state_head head;
    uint64_t last = 0;
    if (snapshot_init(&snapshot, reader) != 0)
        return NO_MEMORY;
    for (int taken = 0; taken < SNAPSHOTS;) {
        if (snapshot_take(&snapshot, reader) != 0) {
            if (errno != EAGAIN)
                return DAMAGED;
            continue;
        }
        taken++;
        if (!whole(&snapshot))
            return TORN;
        if (snapshot.head.frame < last)
            return BACKWARDS;
        last = snapshot.head.frame;
        if (snapshot_head(&head, reader) == 0 && !head_whole(&head))
            return TORN_HEAD;
    }
    snapshot_free(&snapshot);
    return WHOLE;
}

static void test_snapshots_are_never_torn(void **state)
{
    const struct bare_sizes sizes = {.capacity = CAPACITY,
                                     .fixed = FIXED,
                                     .event_slots = 64,
                                     .events_per_frame = 8,
                                     .command_slots = 8};
    (void)state;
    bare_view_make(&view, &sizes);
    /* A word that the children share: nobody moves here, so the moved table's intents are free. */
    _Atomic bool *stop = (_Atomic bool *)(void *)view.m.intents;
    pid_t writer = child_start(write_frames, stop);
    pid_t reader = child_start(read_snapshots, &view);
    int here = read_snapshots(&view);
    int there = child_wait(reader);
    atomic_store(stop, true);
    assert_int_equal(child_wait(writer), 0);
    uint64_t frames = atomic_load(&view.commit->commit);
    print_message("2 x %d snapshots beside %llu frames\n", SNAPSHOTS, (unsigned long long)frames);
    assert_int_equal(here, WHOLE);
    assert_int_equal(there, WHOLE);
    assert_true(frames > 1000); /* there were enough races */
    segment_abandon(&view);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_snapshots_are_never_torn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
