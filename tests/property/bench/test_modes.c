/* The worlds that jolon-bench frame measures: what their vehicles do, how close they are, and that
 * frames go on after a burst of bombs until all are gone. */
#include "tests/bench/burst.h"
#include "tests/bench/world.h"
#include "tests/support/fixture.h"

#include "recorder/replay/frame_stepper.h"
#include "world/checksum.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define VEHICLES 60u
#define BOMBS    2000u
#define FRAMES   140u /* bombs burst from 60 to 120 */

static struct view view;

static int data_of_tests(void **state)
{
    (void)state;
    setenv("JOLON_DATA", fixture_shipped_dir(), 1);
    return 0;
}

static void is_world(enum bench_mode mode, enum behaviour behaviour, bool at_war, double side_m)
{
    bench_world_mode(&view, mode, VEHICLES, 0);
    const struct entities *e = &view.w[0].entities;
    uint32_t at_will = 0;
    assert_int_equal(view.w[0].head->vehicles, VEHICLES);
    for (uint32_t i = 0; i < VEHICLES; i++) {
        assert_int_equal(e->row[i].behaviour, behaviour);
        assert_true(fabs(e->row[i].x - BENCH_MIDDLE_M) <= 0.5 * side_m + 50.0);
        assert_true(fabs(e->row[i].z - BENCH_MIDDLE_M) <= 0.5 * side_m + 50.0);
        at_will += (e->row[i].flags & ENTITY_FLAG_FIRE_AT_WILL) != 0;
    }
    assert_int_equal(at_will, at_war ? VEHICLES : 0);
    segment_abandon(&view);
}

static void test_vehicles_do_what_the_mode_says(void **state)
{
    (void)state;
    is_world(BENCH_MODE_IDLE, BEHAVIOUR_IDLE, false, 50000.0);
    is_world(BENCH_MODE_PATROL, BEHAVIOUR_PATROL, false, 50000.0);
    is_world(BENCH_MODE_WAR, BEHAVIOUR_PATROL, true, 50000.0);
    is_world(BENCH_MODE_DENSE, BEHAVIOUR_PATROL, false, sqrt(800.0 * VEHICLES));
}

/* Rows after those in use are zero in each table, so that references to them are void. */
static void is_empty_beyond(const struct entities *e, uint32_t used)
{
    for (uint32_t row = used; row < e->capacity; row++)
        assert_true(e->row[row].id == 0 && e->row[row].state == ENTITY_FREE &&
                    e->row[row].x == 0.0);
}

static struct frame_stepper stepper;

static void begin(uint32_t threads)
{
    bench_world_mode(&view, BENCH_MODE_IDLE, VEHICLES, BOMBS);
    burst_drop(&view, BOMBS);
    assert_int_equal(frame_stepper_init(&stepper, &view, threads), 0);
}

static void end(void)
{
    frame_stepper_free(&stepper);
    segment_abandon(&view);
}

static void test_a_burst_begins_and_ends(void **state)
{
    (void)state;
    begin(1);
    for (uint32_t frame = 1; frame <= FRAMES; frame++) {
        frame_stepper_step(&stepper, NULL);
        const struct state *now = &view.w[frame & 1];
        if (frame < 50)
            assert_int_equal(now->head->munitions, BOMBS);
        is_empty_beyond(&now->entities, now->head->used);
        is_empty_beyond(&view.m.entities, view.m.head->used);
        assert_true(state_whole(now, view.world.counts.fixed) && moved_whole(&view.m));
    }
    const struct state_head *head = view.w[FRAMES & 1].head;
    assert_int_equal(head->munitions, 0);
    assert_int_equal(head->tally.detonations, BOMBS);
    assert_int_equal(head->tally.destroyed, 0);
    assert_true(head->used < VEHICLES + BOMBS / 4); /* rows in use fell back */
    end();
}

static uint64_t digest(uint32_t frame)
{
    return state_digest(&view.world, &view.w[frame & 1]);
}

/* New mover and collider processes know nothing of what the tables hold beyond the rows in use. */
static void test_rows_in_use_do_not_depend_on_threads_and_restarts(void **state)
{
    uint64_t random = fixture_seed(11), digests[FRAMES + 1];
    (void)state;
    begin(1);
    for (uint32_t frame = 1; frame <= FRAMES; frame++) {
        frame_stepper_step(&stepper, NULL);
        digests[frame] = digest(frame);
    }
    end();
    begin(2);
    for (uint32_t frame = 1; frame <= FRAMES; frame++) {
        if (fixture_random(&random) % 4 == 0) {
            frame_stepper_free(&stepper);
            view.m.entities.row[view.m.entities.capacity - 1].id = 77; /* of a frame that is lost */
            view.w[frame & 1].entities.row[view.m.entities.capacity - 2].id = 78;
            assert_int_equal(frame_stepper_init(&stepper, &view, 1 + frame % 2), 0);
        }
        frame_stepper_step(&stepper, NULL);
        assert_true(digest(frame) == digests[frame]);
        is_empty_beyond(&view.w[frame & 1].entities, view.w[frame & 1].head->used);
        is_empty_beyond(&view.m.entities, view.m.head->used);
    }
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_vehicles_do_what_the_mode_says),
        cmocka_unit_test(test_a_burst_begins_and_ends),
        cmocka_unit_test(test_rows_in_use_do_not_depend_on_threads_and_restarts),
    };
    return cmocka_run_group_tests(tests, data_of_tests, NULL);
}
