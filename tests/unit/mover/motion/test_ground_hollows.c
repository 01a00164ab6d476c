/* Land vehicles that come to rough ground: hollows, walls and the rims of craters. */
#include "mover/motion/chassis_shell.h"
#include "tests/support/steps.h"
#include "world/cruise_pose.h"
#include "world/entity/cruise.h"
#include "world/state.h"
#include "world/terrain/rest_pose.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define HZ 60.0

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static uint32_t put(const char *kind, double x, double z, double heading_deg, double speed_mps)
{
    return steps_put_driving(&f, kind, x, z, heading_deg, speed_mps);
}

static uint32_t put_tank(double x, double z, double heading_deg, double speed_mps)
{
    return put("tank", x, z, heading_deg, speed_mps);
}

#define VALLEY 0.3 /* tangent of both sides: less than 25 degrees */

static double valley(double x, double z, const void *context)
{
    (void)z, (void)context;
    return 100.0 + VALLEY * fabs(x - 25000.0);
}

/* Returns how deep the shell of a row is in the ground [m]. */
static double shell_depth(uint32_t row)
{
    struct entities e = steps_rows(&f);
    const struct cruise_pose pose =
        cruise_pose_of(&f.view.world, NULL, &e, row, fixture_state(&f).head->tick);
    struct mat3 turn =
        rotation_matrix(rotation_of(pose.heading_rad, pose.pitch_rad, pose.roll_rad));
    return vehicle_shell_depth(&f.view.world.terrain, NULL, &f.view.world.kinds[e.row[row].kind],
                               VEHICLE_SHELL_SIDES, pose.at, &turn);
}

struct shells_seen {
    double deepest_m;          /* in the ground */
    uint32_t sprung, cruising; /* looks at a row */
};

/* Lets twelve vehicles cross a valley in all directions. */
static struct shells_seen cross_valley(const char *kind)
{
    struct shells_seen seen = {.deepest_m = -1.0};
    steps_ground(&f, valley, NULL);
    for (int n = 0; n < 12; n++) {
        double heading = 90.0 + 7.5 * n;
        uint32_t row = put(kind, 24960.0 + 2.0 * n, 25000.0 + 60.0 * n, heading, 6.0);
        struct entities e = steps_rows(&f);
        e.row[row].behaviour = BEHAVIOUR_PATROL;
        e.row[row].goal_x = 25060.0 - 4.0 * n;
        e.row[row].goal_z = e.row[row].z + (e.row[row].goal_x - e.row[row].x) * 0.13 * n;
        const struct rest_pose pose =
            rest_pose_of(&f.view.world.terrain, NULL, steps_kind(&f, kind), e.row[row].x,
                         e.row[row].z, e.row[row].heading);
        e.row[row].pitch = pose.pitch_rad;
        e.row[row].roll = pose.roll_rad;
    }
    for (int frame = 0; frame < 12 * (int)HZ; frame++) {
        fixture_run(&f, 1);
        for (uint32_t row = 0; row < 12; row++) {
            struct entities e = steps_rows(&f);
            seen.deepest_m = maths_max(seen.deepest_m, shell_depth(row));
            seen.sprung += (e.row[row].flags & ENTITY_FLAG_CHASSIS) != 0;
            seen.cruising += cruise_goes(&e, row, fixture_state(&f).head->tick);
        }
    }
    print_message(
        "# figures: %s: a shell %.1f mm in the sides of a valley, %u looks on springs, %u "
        "while it cruised\n",
        kind, 1e3 * seen.deepest_m, seen.sprung, seen.cruising);
    return seen;
}

/* The plane through five heights of a valley's floor lies in its sides. A tank whose shell would
 * get into them takes to its springs before. It was up to 0.37 m deep in them. */
static void test_no_shell_gets_into_the_ground_of_a_hollow(void **state)
{
    (void)state;
    static const char *const kinds[] = {"tank", "jeep", "carrier"};
    for (size_t k = 0; k < 3; k++) {
        steps_empty(&f);
        struct shells_seen seen = cross_valley(kinds[k]);
        assert_true(seen.sprung > 100 && seen.cruising == 0);
        assert_true(seen.deepest_m < 0.02);
    }
}

/* A stretch looks at its whole way: it does not lead where a shell gets into the ground. */
static void test_no_stretch_leads_through_a_hollow(void **state)
{
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "world = { seed = 1; capacity = 64; cruise = true; }; "
                     "terrain = { source = \"flat\"; height_m = 100.0; spacing_m = 31.25; };");
    struct shells_seen seen = cross_valley("tank");
    assert_true(seen.sprung > 100 && seen.cruising > 100);
    assert_true(seen.deepest_m < 0.02);
}

/* Tanks that follow the ground lean over to a wall, from 11 to 55 cm beside them, and turn away
 * from it. Their corners do not get into it: they take to their springs before. They got 19 cm
 * deep. */
static void test_no_shell_turns_into_a_wall(void **state)
{
    double deepest = -1.0;
    uint32_t sprung = 0;
    (void)state;
    fixture_close(&f);
    fixture_open(&f, "earthworks = ( { shape = \"table\"; at = [25000.0, 25000.0]; width_m = 10.0; "
                     "length_m = 300.0; height_m = 2.0; edge_m = 0.25; } );");
    steps_plane(&f, 0.15, 0.0);
    for (int n = 0; n < 12; n++) {
        uint32_t row = put_tank(25006.96 + 0.04 * n, 25130.0 - 20.0 * n, 0.0, 0.0);
        struct entities e = steps_rows(&f);
        e.row[row].behaviour = BEHAVIOUR_PATROL;
        e.row[row].goal_x = 25040.0;
        e.row[row].goal_z = e.row[row].z;
        e.row[row].roll = -maths_atan2(0.15, 1.0);
    }
    for (int frame = 0; frame < 6 * (int)HZ; frame++) {
        fixture_run(&f, 1);
        for (uint32_t row = 0; row < 12; row++) {
            deepest = maths_max(deepest, shell_depth(row));
            sprung += (steps_rows(&f).row[row].flags & ENTITY_FLAG_CHASSIS) != 0;
        }
    }
    print_message("# figures: a shell %.1f mm in a wall, %u looks on springs\n", 1e3 * deepest,
                  sprung);
    assert_true(sprung > 10);
    assert_true(deepest < 0.02);
}

/* Agents come to the rim of a crater that is too near to go around. What lifts their corners must
 * not throw them up within a frame: they take to their springs at once. They were lifted by 2 cm,
 * with 1.1 m/s. */
static void test_no_rim_lifts_it_with_a_jerk(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "jeep", "truck"};
    (void)state;
    for (int n = 0; n < 4; n++) {
        const double x = 25000.0 + 60.0 * n;
        double jerk = 0.0;
        uint32_t sprung = 0, row = put(kinds[n], x, 25000.0, 0.0, 10.0);
        struct state now = fixture_state(&f);
        for (int buffer = 0; buffer < 2; buffer++)
            f.view.w[buffer].head->crater_count = (uint32_t)n + 1;
        now.craters[n] = (struct crater){x + 1.5, 24991.0, 2.5f, 0.8f, 1};
        steps_rows(&f).row[row].behaviour = BEHAVIOUR_PATROL;
        steps_rows(&f).row[row].goal_x = x;
        steps_rows(&f).row[row].goal_z = 24800.0;
        for (int frame = 0; frame < 2 * (int)HZ && sprung == 0; frame++) {
            double vy = steps_rows(&f).row[row].vy;
            fixture_run(&f, 1);
            jerk = maths_max(jerk, fabs(steps_rows(&f).row[row].vy - vy));
            sprung += (steps_rows(&f).row[row].flags & ENTITY_FLAG_CHASSIS) != 0;
        }
        print_message("# figures: %s: %.2f m/s in a frame\n", kinds[n], jerk);
        assert_int_equal(sprung, 1);
        assert_true(jerk < 0.4);
    }
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_no_shell_gets_into_the_ground_of_a_hollow),
        TEST(test_no_stretch_leads_through_a_hollow),
        TEST(test_no_shell_turns_into_a_wall),
        TEST(test_no_rim_lifts_it_with_a_jerk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
