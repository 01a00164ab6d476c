/* The worlds that jolon-bench frame measures: what their vehicles do, how close they are, and that
 * frames go on after a burst of bombs until all are gone. */
#include "tests/bench/burst.h"
#include "tests/bench/world.h"
#include "tests/support/fixture.h"

#include "recorder/replay/frame_stepper.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define VEHICLES 60u
#define BOMBS    200u

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
        assert_int_equal(e->behaviour[i], behaviour);
        assert_true(fabs(e->x[i] - BENCH_MIDDLE_M) <= 0.5 * side_m + 50.0);
        assert_true(fabs(e->z[i] - BENCH_MIDDLE_M) <= 0.5 * side_m + 50.0);
        at_will += (e->flags[i] & ENTITY_FLAG_FIRE_AT_WILL) != 0;
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

static void test_a_burst_begins_and_ends(void **state)
{
    struct frame_stepper stepper;
    (void)state;
    bench_world_mode(&view, BENCH_MODE_IDLE, VEHICLES, BOMBS);
    burst_drop(&view, BOMBS);
    assert_int_equal(view.w[0].head->munitions, BOMBS);
    assert_int_equal(frame_stepper_init(&stepper, &view, 1), 0);
    for (uint32_t frame = 1; frame <= 130; frame++) {
        frame_stepper_step(&stepper, NULL);
        const struct state *now = &view.w[frame & 1];
        if (frame < 50)
            assert_int_equal(now->head->munitions, BOMBS);
    }
    assert_int_equal(view.w[0].head->munitions, 0);
    assert_int_equal(view.w[0].head->tally.detonations, BOMBS);
    assert_int_equal(view.w[0].head->tally.destroyed, 0);
    frame_stepper_free(&stepper);
    segment_abandon(&view);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_vehicles_do_what_the_mode_says),
        cmocka_unit_test(test_a_burst_begins_and_ends),
    };
    return cmocka_run_group_tests(tests, data_of_tests, NULL);
}
