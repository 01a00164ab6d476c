/* Piles: a column that runs into a tank, and vehicles that begin all at one place (thesis rows 36,
 * 46). They do not get deeper into each other, nobody is flung away or lifted, and no frame takes
 * without bound. SEED=n turns the vehicles. */
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <time.h>

#include <cmocka.h>

#define OVERLAP_M    2e-5 /* of a column, at a frame's end */
#define HELD_M       1e-6 /* off the ground at most */
#define JEEPS        20
#define CROWD        100
#define CROWD_FRAMES 300
#define CROWD_DEEP_M 0.01 /* at the end; test_parting.c has more */
#define FASTEST_MPS  3.0
#define SLOW_S       5.0 /* of the processor, a frame: sanitizers are slow */

static struct fixture f;

static void open_world(double hz)
{
    char text[128];
    snprintf(text, sizeof text,
             "world = { seed = 1; hz = %g; capacity = 2048; };\n"
             "collision = { shape = \"model\"; };\n",
             hz);
    fixture_open(&f, text);
}

/* --- what is measured --------------------------------------------------------------------------*/

static double fastest(uint32_t count)
{
    double mps = 0.0;
    for (uint32_t i = 0; i < count; i++)
        mps = maths_max(mps, steps_speed(&f, i));
    return mps;
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* --- columns -----------------------------------------------------------------------------------*/

/* Jeeps that drive behind each other at 15 m/s run into a tank that stands. */
static void run_column(double hz)
{
    double overlap = 0.0, longest = 0.0;
    open_world(hz);
    fixture_put(
        &f, (struct fixture_entity){.kind = "tank", .at = {25000.0, FIXTURE_GROUND_M, 24980.0}});
    for (uint32_t i = 0; i < JEEPS; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = "jeep",
                                            .at = {25000.0, FIXTURE_GROUND_M, 25000.0 + 6.0 * i},
                                            .velocity = {0.0, 0.0, -15.0}});
    steps_kind(&f, "tank")->resistance_j = steps_kind(&f, "jeep")->resistance_j = 1e12;
    for (uint32_t frame = 0; frame < (uint32_t)(10.0 * hz); frame++) {
        double began = now_s();
        fixture_continue(&f, 1);
        longest = maths_max(longest, now_s() - began);
        overlap = maths_max(overlap, steps_deepest(&f, JEEPS + 1));
    }
    print_message("column of %d jeeps at %g Hz: overlap %.3f mm, %.1f ms at most\n", JEEPS, hz,
                  1e3 * overlap, 1e3 * longest);
    assert_true(overlap <= OVERLAP_M);
    assert_true(steps_off_the_ground(&f, JEEPS + 1) <= HELD_M);
    assert_true(longest < SLOW_S);
    fixture_close(&f);
}

static void test_rows_36_46_a_column_runs_into_a_tank(void **state)
{
    (void)state;
    run_column(60.0);
    run_column(10.0);
}

/* --- one place ---------------------------------------------------------------------------------*/

static void test_row_46_a_crowd_at_one_place_parts(void **state)
{
    uint64_t random = fixture_seed(46);
    double longest = 0.0, sum = 0.0, fast = 0.0, height = 0.0;
    (void)state;
    open_world(60.0);
    for (uint32_t i = 0; i < CROWD; i++)
        fixture_put(&f,
                    (struct fixture_entity){.kind = i % 3 == 0 ? "tank" : "jeep",
                                            .at = {25000.0, FIXTURE_GROUND_M, 25000.0},
                                            .heading_rad = fixture_uniform(&random, 0.0, TWO_PI)});
    for (uint32_t frame = 0; frame < CROWD_FRAMES; frame++) {
        double began = now_s(), took;
        fixture_continue(&f, 1);
        took = now_s() - began;
        longest = maths_max(longest, took);
        sum += took;
        fast = maths_max(fast, fastest(CROWD));
        height = maths_max(height, steps_off_the_ground(&f, CROWD));
    }
    print_message("%d at one place: %.2f m deep after %d frames, %.1f ms at most, %.1f ms on "
                  "average, %.2f m/s at most, off the ground %.1e m\n",
                  CROWD, steps_deepest(&f, CROWD), CROWD_FRAMES, 1e3 * longest,
                  1e3 * sum / CROWD_FRAMES, fast, height);
    assert_true(steps_deepest(&f, CROWD) < CROWD_DEEP_M);
    assert_true(height <= HELD_M);
    assert_true(fast <= FASTEST_MPS);
    assert_true(longest < SLOW_S);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_36_46_a_column_runs_into_a_tank),
        cmocka_unit_test(test_row_46_a_crowd_at_one_place_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
