/* Which stretches land vehicles are moved by, and how far these lead. */
#include "tests/support/steps.h"
#include "world/entity/cruise.h"
#include "world/state.h"
#include "world/terrain/rest_pose.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ 60

static struct fixture f;

/* Opens a world in which agents decide as seldom as in a crowd of 100,000, so that stretches of
 * land vehicles last for up to two seconds. */
static void open_crowd(bool cruise)
{
    fixture_open(&f,
                 cruise ? "world = { seed = 1; capacity = 64; cruise = true; }; "
                          "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = 31.25; };"
                        : "world = { seed = 1; capacity = 64; cruise = false; }; "
                          "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = 31.25; };");
    f.stepper.mover.decides_every = 33;
}

/* Puts a vehicle that is on its way north, far from its goal. */
static uint32_t put(const char *kind, double x, double speed_mps)
{
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                .at = {x, steps_ground_at(&f, x, 25000.0), 25000.0},
                                                .velocity = {0.0, 0.0, -speed_mps},
                                                .behaviour = BEHAVIOUR_PATROL});
    struct entities e = steps_rows(&f);
    const struct rest_pose pose =
        rest_pose_of(&f.view.world.terrain, NULL, steps_kind(&f, kind), x, 25000.0, 0.0);
    e.row[row].pitch = pose.pitch_rad;
    e.row[row].roll = pose.roll_rad;
    e.row[row].goal_x = x;
    e.row[row].goal_z = 10000.0;
    return row;
}

static bool cruises(uint32_t row)
{
    const struct state state = fixture_state(&f);
    return cruise_goes(&state.entities, row, state.head->tick);
}

/* Runs so many frames. Returns in how many of them the row cruises on from one to the next. */
static uint32_t run(uint32_t row, uint32_t frames)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < frames; i++) {
        fixture_run(&f, 1);
        count += cruises(row);
    }
    return count;
}

/* Where a vehicle is that starts from rest, and how fast. */
struct start {
    double way_m[3], mps[3]; /* after 4, 8 and 12 s */
    uint32_t cruised;        /* frames */
};

static struct start start_of(const char *kind, bool cruise)
{
    struct start start = {0};
    open_crowd(cruise);
    uint32_t row = put(kind, 25000.0, 0.0);
    for (int n = 0; n < 3; n++) {
        start.cruised += run(row, 4 * HZ);
        const struct state state = fixture_state(&f);
        const double dt_s = 1.0 / HZ;
        start.way_m[n] = 25000.0 - cruise_position(&state.entities, row, state.head->tick, dt_s).z;
        start.mps[n] = -cruise_velocity(&state.entities, row, state.head->tick, dt_s).z;
    }
    fixture_close(&f);
    return start;
}

/* A vehicle that gains speed does so by stretches too, of which each leads as far as its frames:
 * its engine pulls as it does half way. */
static void test_a_start_by_stretches_is_that_by_frames(void **state)
{
    static const char *const kinds[] = {"tank", "truck", "jeep"};
    (void)state;
    fixture_close(&f);
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        struct start frames = start_of(kinds[k], false), stretches = start_of(kinds[k], true);
        assert_int_equal(frames.cruised, 0);
        for (int n = 0; n < 3; n++) {
            print_message("# figures: %s after %d s: %.2f m, %.2f m/s by frames, %.2f m, %.2f m/s "
                          "by stretches, of %u frames %u\n",
                          kinds[k], 4 * (n + 1), frames.way_m[n], frames.mps[n], stretches.way_m[n],
                          stretches.mps[n], 12 * HZ, stretches.cruised);
            assert_true(fabs(stretches.way_m[n] - frames.way_m[n]) < 1.0 + 0.04 * frames.way_m[n]);
            assert_true(fabs(stretches.mps[n] - frames.mps[n]) < 0.03 * frames.mps[n]);
        }
        assert_true(stretches.cruised > 8 * HZ);
    }
    open_crowd(true); /* the teardown closes it */
}

#define VALLEY 0.3 /* tangent of both sides */

static double valley(double x, double z, const void *context)
{
    (void)z, (void)context;
    return 100.0 + VALLEY * fabs(x - 25000.0);
}

/* Beside the floor of a valley the ground bends within half a post's spacing, but not under the
 * tank. Stretches were refused there. */
static void test_a_tank_beside_the_floor_of_a_valley_cruises(void **state)
{
    (void)state;
    steps_ground(&f, valley, NULL);
    uint32_t row = put("tank", 25008.0, 8.0);
    assert_true(run(row, 10 * HZ) > 8 * HZ);
    assert_false(steps_rows(&f).row[row].flags & ENTITY_FLAG_CHASSIS);
}

static int open_cruising(void **state)
{
    (void)state;
    open_crowd(true);
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_cruising, close_world)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_start_by_stretches_is_that_by_frames),
        TEST(test_a_tank_beside_the_floor_of_a_valley_cruises),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
