/* Stretches of aircraft in a crowd: how long they are, their height over hills, others. */
#include "mover/motion/air/even_flight.h"
#include "tests/support/steps.h"
#include "world/entity/cruise.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define DECIDES 32u  /* [frame] as agents in a crowd */
#define LONGEST 120u /* [frame] of a stretch */
#define SHORT   30u
#define FAST    56.25 /* [m/s] a helicopter on patrol */

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; capacity = 64; hz = 60.0; cruise = true; };");
    f.stepper.mover.decides_every = DECIDES;
    return 0;
}

static double hills(double x, double z, const void *context)
{
    (void)z, (void)context;
    return 200.0 + 60.0 * maths_cos(x / 160.0);
}

#define WALL_X 25125.0

/* A wall across the way east, 34 m high: a post of the ground, with slopes of 125 m. */
static double wall(double x, double z, const void *context)
{
    (void)z, (void)context;
    return x == WALL_X ? 134.0 : 100.0;
}

/* Puts a helicopter in the middle of the world that flies east, or west, to a goal far away. */
static uint32_t put(const char *kind, double x, double z, double speed_mps)
{
    const double up_m = steps_kind(&f, kind)->cruise_altitude_m;
    const double east = speed_mps < 0.0 ? -1.0 : 1.0;
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                .at = {x, steps_ground_at(&f, x, z) + up_m, z},
                                                .velocity = {speed_mps, 0.0, 0.0},
                                                .heading_rad = east * HALF_PI,
                                                .behaviour = BEHAVIOUR_PATROL});
    struct entities e = steps_rows(&f);
    e.row[row].goal_x = 25000.0 + east * 20000.0;
    e.row[row].goal_z = z;
    e.row[row].throttle = 0.75f;
    return row;
}

/* What was seen of a helicopter. */
struct seen {
    uint32_t begun, lengthy; /* stretches, and frames of those longer than half a second */
    double least_m, most_m;  /* its height over the ground while it cruises */
};

static struct seen watch(uint32_t row, uint32_t frames)
{
    struct seen seen = {.least_m = INFINITY};
    uint32_t until = 0;
    for (uint32_t n = 0; n < frames; n++) {
        fixture_run(&f, 1);
        const struct state state = fixture_state(&f);
        const uint32_t tick = (uint32_t)state.head->tick,
                       ends = state.entities.row[row].cruise_tick;
        const struct vec3 at = steps_position(&f, row);
        if (!cruise_goes(&state.entities, row, tick))
            continue;
        seen.begun += ends != until;
        seen.lengthy += ends != until && ends + 1 - tick > SHORT ? ends + 1 - tick : 0;
        until = ends;
        seen.least_m = maths_min(seen.least_m, at.y - steps_ground_at(&f, at.x, at.z));
        seen.most_m = maths_max(seen.most_m, at.y - steps_ground_at(&f, at.x, at.z));
    }
    return seen;
}

static void test_a_helicopter_cruises_for_two_seconds(void **state)
{
    (void)state;
    steps_plane(&f, 0.0, 0.0);
    uint32_t row = put("helicopter", 25000.0, 25000.0, FAST);
    fixture_run(&f, 4 * LONGEST);
    const double fuel_l = steps_rows(&f).row[row].fuel_l;
    const struct seen seen = watch(row, 10 * LONGEST);
    const struct kind *kind = steps_kind(&f, "helicopter");
    assert_true(seen.begun <= 11 && seen.lengthy >= 9 * LONGEST);
    assert_true(fabs(seen.least_m - kind->cruise_altitude_m) < 0.5);
    assert_true(fabs(seen.most_m - kind->cruise_altitude_m) < 0.5);
    assert_true(fabs(steps_speed(&f, row) - FAST) < 0.01);
    const double burns_l = 0.75 * kind->fuel_lps * 10.0 * LONGEST / 60.0;
    assert_true(fabs(fuel_l - steps_rows(&f).row[row].fuel_l - burns_l) < 0.2 * burns_l);
}

/* The slopes are up to 0.375. */
static void test_it_keeps_its_height_over_hills(void **state)
{
    (void)state;
    steps_ground(&f, hills, NULL);
    uint32_t row = put("helicopter", 25000.0, 25000.0, 40.0);
    const struct seen seen = watch(row, 60 * 60);
    print_message("%u stretches, %u frames of long ones, %.1f to %.1f m over the ground\n",
                  seen.begun, seen.lengthy, seen.least_m, seen.most_m);
    const double usual_m = steps_kind(&f, "helicopter")->cruise_altitude_m;
    assert_true(seen.least_m > 0.4 * usual_m && seen.most_m < 3.5 * usual_m);
    assert_true(seen.lengthy > 60 * 60 / 2);
    assert_true(steps_position(&f, row).x > 26500.0);
}

/* Returns true if a jet that is so far before the wall, 38 m over the ground, may begin a stretch
 * of a second. It looks at the ground every 150 m. */
static bool begins_before_wall(double before_m)
{
    struct step_context step;
    struct serial_context serial;
    steps_empty(&f);
    uint32_t row = put("jet", WALL_X - before_m, 25000.0, 300.0);
    steps_rows(&f).row[row].y = 138.0;
    fixture_run(&f, 1);
    steps_serial_context(&f, &step, &serial);
    const struct desired_motion desired = {.speed_mps = step.m->row[row].vx, .altitude_m = 38.0};
    step.m->row[row].y = 138.0;
    step.m->row[row].vy = step.m->row[row].pitch = step.m->row[row].roll = 0.0;
    return even_flight_begin(&step, row, &desired, 60);
}

/* Two looks at the ground may miss a wall between them. */
static void test_it_does_not_cruise_low_over_a_wall(void **state)
{
    (void)state;
    steps_ground(&f, wall, NULL);
    assert_true(begins_before_wall(-500.0));
    for (double before_m = 5.0; before_m < 300.0; before_m += 20.0)
        assert_false(begins_before_wall(before_m));
}

/* Returns the frames of a stretch of a helicopter towards which another one flies, so far away and
 * so much higher. */
static uint32_t frames_before(double away_m, double up_m)
{
    struct step_context step;
    struct serial_context serial;
    steps_empty(&f);
    f.stepper.mover.decides_every = DECIDES;
    uint32_t row = put("helicopter", 25000.0, 25000.0, FAST);
    uint32_t other = put("helicopter", 25000.0 + away_m, 25000.0, -FAST);
    steps_rows(&f).row[other].y += up_m;
    fixture_run(&f, 1);
    steps_serial_context(&f, &step, &serial);
    return even_flight_frames(&step, row, LONGEST);
}

/* They are near each other from 25 m on, and 15 % of their way. */
static void test_a_stretch_ends_three_seconds_before_another_one_comes_near(void **state)
{
    (void)state;
    steps_plane(&f, 0.0, 0.0);
    assert_int_equal(frames_before(2000.0, 0.0), LONGEST);
    assert_int_equal(frames_before(570.0, 0.0), LONGEST / 2);
    assert_int_equal(frames_before(350.0, 0.0), DECIDES);
    assert_int_equal(frames_before(350.0, 200.0), LONGEST);
}

#define IN_WORLD(test)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(test, open_world, fixture_teardown, &f)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_WORLD(test_a_helicopter_cruises_for_two_seconds),
        IN_WORLD(test_it_keeps_its_height_over_hills),
        IN_WORLD(test_it_does_not_cruise_low_over_a_wall),
        IN_WORLD(test_a_stretch_ends_three_seconds_before_another_one_comes_near),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
