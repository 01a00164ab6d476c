/* Two trucks that lean on each other after a collision come apart when one of them drives, though
 * their springs turn each into the other. */
#include "tests/support/judged.h"
#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define FRAMES 100u

/* A pose of a truck on its springs. */
struct truck_pose {
    struct vec3 at;
    double heading_rad, pitch_rad, roll_rad;
};

/* How two trucks of a crowd stood after the one had run into the tail of the other. */
static const struct truck_pose begun[2] = {
    {{5093.8301974852629, 100.00014971980028, 5127.955764713678},
     3.9327864412297604,
     -0.0041075069012791697,
     0.027155766699979187},
    {{5098.2275229876068, 100.00000830477441, 5128.6195067597937},
     4.346667585501061,
     -0.011982592367300284,
     -0.0084798159108356846},
};

static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "world = { seed = 1; hz = 20.0; };\n"
                     "collision = { shape = \"model\"; };\n");
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t row = fixture_put(&f, (struct fixture_entity){
                                           .kind = "truck",
                                           .at = begun[i].at,
                                           .heading_rad = begun[i].heading_rad,
                                           .behaviour = BEHAVIOUR_DRIVEN,
                                       });
        struct entities e = steps_rows(&f);
        e.row[row].pitch = begun[i].pitch_rad;
        e.row[row].roll = begun[i].roll_rad;
        e.row[row].flags |= ENTITY_FLAG_CHASSIS;
        e.row[row].until_tick = UINT32_MAX;
    }
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

/* One of the two backs with full throttle for 5 s, the other stands. */
static void back(uint32_t row, double least_m)
{
    struct physics_check check;
    steps_rows(&f).row[row].throttle = -1.0F;
    fixture_forget_copies(&f);
    judged_continue(&f, &check, FRAMES);
    double way_m = vec3_length(vec3_sub(steps_position(&f, row), begun[row].at));
    if (!(way_m > least_m))
        fail_msg("the truck went %g m", way_m);
    judged_no_other_bad(&check, MEASURE_KINDS);
    physics_check_free(&check);
}

static void test_the_truck_behind_backs_away(void **state)
{
    (void)state;
    back(1, 2.0);
}

/* It shoves the other aside, and is slow. */
static void test_the_truck_in_front_backs_along_the_other(void **state)
{
    (void)state;
    back(0, 0.1);
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_the_truck_behind_backs_away),
        TEST(test_the_truck_in_front_backs_along_the_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
