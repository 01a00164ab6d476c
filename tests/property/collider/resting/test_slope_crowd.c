/* A crowd on a steep slope parts as soon as one on the level, and costs about as much: vehicles
 * that lean were measured exactly, each pair of a crowd by itself, so that 50 tanks within 4 m took
 * 4 s a frame on a slope of 22 degrees, and 100 took 24 s (thesis row 46). SEED=n draws other
 * crowds. */
#include "tests/support/steps.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#define BODIES  60u
#define REACH_M 4.0
#define FRAMES  80u
#define DEARER                                                                                     \
    4.0 /* so many times as dear is a crowd on a slope, at most; 1.2 to 2.4 times is usual */
#define STEEP 0.4 /* 22 degrees */

static struct fixture f;

static double processor_s(void)
{
    struct timespec now;
    assert_int_equal(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now), 0);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Returns how deep the deepest overlap is [m]. */
static double deepest(void)
{
    const struct entities e = steps_rows(&f);
    double most = 0.0;
    struct swept_body body[BODIES];
    for (uint32_t i = 0; i < BODIES; i++)
        body[i] = body_motion_standing(&f.stepper.collider.motion, &e, i);
    for (uint32_t i = 0; i < BODIES; i++) {
        for (uint32_t j = i + 1; j < BODIES; j++)
            most = maths_max(most, -level_gap_least(&body[i], &body[j], 0.0, 0.1));
    }
    return most;
}

/* Returns the processor time that a crowd of tanks needs to part on a slope [s]. */
static double time_on(double slope)
{
    uint64_t random = fixture_seed(1);
    fixture_open(&f, "world = { capacity = 256; }; collision = { shape = \"model\"; };");
    steps_plane(&f, 0.8 * slope, 0.6 * slope);
    for (uint32_t i = 0; i < BODIES; i++) {
        double x = 25000.0 + fixture_uniform(&random, -REACH_M, REACH_M);
        double z = 25000.0 + fixture_uniform(&random, -REACH_M, REACH_M);
        fixture_put(&f,
                    (struct fixture_entity){.kind = "tank",
                                            .at = {x, steps_ground_at(&f, x, z), z},
                                            .heading_rad = fixture_uniform(&random, 0.0, TWO_PI)});
    }
    fixture_continue(&f, 1); /* the ground turns them */
    assert_true(deepest() > 1.0);
    double began = processor_s();
    fixture_continue(&f, FRAMES);
    double time_s = processor_s() - began;
    fixture_close(&f);
    return time_s;
}

static void test_row_46_a_crowd_on_a_slope_costs_as_on_the_level(void **state)
{
    double level_s = time_on(0.0), steep_s = time_on(STEEP);
    (void)state;
    print_message("%.0f ms on the level, %.0f ms on the slope\n", 1e3 * level_s, 1e3 * steep_s);
    assert_true(steep_s < DEARER * level_s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_46_a_crowd_on_a_slope_costs_as_on_the_level)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
