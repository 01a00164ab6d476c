/* Water that vehicles cross, and ground that holds them less: fords and skid pans. */
#include "mover/motion/fording.h"
#include "mover/motion/ground_grip.h"
#include "tests/support/steps.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define HZ 60

/* Fords of 0.5 and 1.2 m beside each other, one of 1.2 m with gentle banks, and a skid pan. */
static const char scene[] =
    "world = { seed = 1; capacity = 64; };\n"
    "earthworks = ( { shape = \"ford\"; at = [25000.0, 25000.0]; length_m = 40.0;\n"
    "                 width_m = 30.0; depth_m = 0.5; edge_m = 5.0; },\n"
    "               { shape = \"ford\"; at = [25000.0, 25200.0]; length_m = 40.0;\n"
    "                 width_m = 30.0; depth_m = 1.2; edge_m = 5.0; },\n"
    "               { shape = \"ford\"; at = [25000.0, 25600.0]; length_m = 80.0;\n"
    "                 width_m = 80.0; depth_m = 1.2; edge_m = 38.0; },\n"
    "               { shape = \"skid_pan\"; at = [25000.0, 25400.0]; length_m = 60.0;\n"
    "                 width_m = 60.0; grip = 0.2; } );\n";

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, scene);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static void test_a_ford_is_crossed_by_who_is_tall_enough(void **state)
{
    struct serial_context serial;
    struct step_context context;
    (void)state;
    steps_serial_context(&f, &context, &serial);
    const struct kind *jeep = steps_kind(&f, "jeep"), *tank = steps_kind(&f, "tank");
    assert_true(fording_is_water(&context, 25000.0, 25000.0));
    assert_false(fording_is_water(&context, 25100.0, 25000.0));
    assert_true(fording_passable(&context, jeep, 25000.0, 25000.0));
    assert_false(fording_passable(&context, jeep, 25000.0, 25200.0));
    assert_true(fording_passable(&context, tank, 25000.0, 25200.0));
}

/* Drives a jeep along z with full throttle. Returns how far east it gets [m]. */
static double drives(double z)
{
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                           .at = {24960.0, FIXTURE_GROUND_M, z},
                                                           .heading_rad = HALF_PI});
    for (int frame = 0; frame < 60 * HZ; frame++)
        steps_drive(&f, row, 0.5, 0.0, 0.0);
    return steps_rows(&f).row[row].x - 24960.0;
}

static void test_a_jeep_crosses_a_shallow_ford_and_stops_at_a_deep_one(void **state)
{
    (void)state;
    assert_true(drives(25000.0) > 100.0);
    double stopped = drives(25200.0);
    assert_true(stopped > 10.0 && stopped < 40.0);
}

/* An agent with a goal beyond the fords crosses the shallow one and never goes into the deep one.
 */
static void test_agents_heed_the_depth(void **state)
{
    static const double z[3] = {25000.0, 25200.0, 25600.0};
    double deepest[3] = {0.0, 0.0, 0.0}, farthest[3] = {0.0, 0.0, 0.0};
    (void)state;
    for (int n = 0; n < 3; n++) {
        uint32_t row =
            fixture_put(&f, (struct fixture_entity){.kind = "jeep",
                                                    .at = {24950.0, FIXTURE_GROUND_M, z[n]},
                                                    .heading_rad = HALF_PI});
        steps_rows(&f).row[row].behaviour = steps_rows(&f).row[row].order = BEHAVIOUR_PATROL;
        for (int frame = 0; frame < 20 * HZ; frame++) {
            struct entities e = steps_rows(&f);
            e.row[row].goal_x = 25100.0;
            e.row[row].goal_z = z[n];
            fixture_run(&f, 1);
            e = steps_rows(&f);
            deepest[n] = maths_max(
                deepest[n], terrain_water_depth(&f.view.world.terrain, e.row[row].x, e.row[row].z));
            farthest[n] = maths_max(farthest[n], e.row[row].x);
        }
    }
    for (int n = 0; n < 3; n++)
        printf("agent: %.2f m deep, as far as %.0f m\n", deepest[n], farthest[n] - 24950.0);
    assert_true(deepest[0] > 0.4 && farthest[0] > 25030.0);
    assert_true(deepest[1] <= 0.53 && deepest[2] <= 0.53);
}

static void test_a_skid_pan_holds_a_fifth(void **state)
{
    struct serial_context serial;
    struct step_context context;
    (void)state;
    steps_serial_context(&f, &context, &serial);
    double dry = ground_grip_at(&context, 25100.0, 25400.0).friction;
    double wet = ground_grip_at(&context, 25000.0, 25400.0).friction;
    assert_true(fabs(wet - 0.2 * dry) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_a_ford_is_crossed_by_who_is_tall_enough, open_world,
                                        close_world),
        cmocka_unit_test_setup_teardown(test_a_jeep_crosses_a_shallow_ford_and_stops_at_a_deep_one,
                                        open_world, close_world),
        cmocka_unit_test_setup_teardown(test_agents_heed_the_depth, open_world, close_world),
        cmocka_unit_test_setup_teardown(test_a_skid_pan_holds_a_fifth, open_world, close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
