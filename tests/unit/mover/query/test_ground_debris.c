/* Debris under land vehicles: along a trunk's fall, around what collapsed, and where it was pushed.
 */
#include "mover/query/ground_debris.h"

#include "mover/motion/ground_grip.h"
#include "mover/query/ground_marks.h"
#include "tests/support/steps.h"
#include "world/terrain/fallen.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* The pole stands 1 m east of the border of a gridsquare at 25000 m. */
#define POLE_X 25001.0
#define POLE_Z 25060.0

static struct fixture f;
static struct step_context context;
static struct serial_context serial;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "objects = ( { kind = \"pole\"; at = [25001.0, 25060.0]; } );");
    struct kind *pole = steps_kind(&f, "pole");
    pole->debris_keep = 0.0;
    pole->mass_kg = steps_kind(&f, "jeep")->mass_kg;
    pole->length_m = pole->width_m = 1.0;
    return 0;
}

static void fell(uint8_t stored)
{
    for (int buffer = 0; buffer < 2; buffer++)
        f.view.w[buffer].fixed_damage[0] = stored;
    steps_move(&f); /* brings the ground marks up to date */
    steps_serial_context(&f, &context, &serial);
}

/* The share of full speed of a jeep, so far along the pole to the west. */
static double share(double west_m)
{
    return ground_debris_share(&f.view.world, context.committed, steps_kind(&f, "jeep"),
                               POLE_X - west_m, POLE_Z);
}

static void test_a_pole_lies_along_its_fall_over_the_border_too(void **state)
{
    double high = (double)f.view.world.fixed[0].height_m;
    (void)state;
    fell(fallen_towards(steps_kind(&f, "pole"), -1.0, 0.0));
    assert_true(fabs(share(0.5) - 0.5) < 1e-9 && fabs(share(0.9 * high) - 0.5) < 1e-9);
    assert_true(share(high + 1.0) == 1.0 && share(-2.0) == 1.0);
    assert_true(ground_debris_lies(&f.view.world, context.committed, POLE_X - 0.9 * high, POLE_Z));
    assert_false(ground_debris_lies(&f.view.world, context.committed, POLE_X - 5.0, POLE_Z + 3.0));
    double dirt = ground_grip_of(COVER_GRASS).wheels;
    assert_true(ground_grip_at(&context, POLE_X - 0.9 * high, POLE_Z).wheels > dirt);
}

static void test_what_is_scattered_or_stands_is_no_obstacle(void **state)
{
    (void)state;
    fell(DAMAGE_MED);
    assert_true(share(0.0) == 1.0);
    fell(DAMAGE_DESTROYED);
    assert_true(share(0.0) == 1.0 &&
                !ground_debris_lies(&f.view.world, context.committed, POLE_X, POLE_Z));
}

static void test_pushed_debris_is_left_to_the_collider_but_gives_less_grip(void **state)
{
    (void)state;
    for (int buffer = 0; buffer < 2; buffer++) {
        f.view.w[buffer].head->debris_count = 1;
        f.view.w[buffer].head->debris[0] = (struct debris){
            .x = 25400.0, .z = 25400.0, .half_length_m = 4.0f, .radius_m = 1.0f, .mass_kg = 100.0f};
    }
    fell(fallen_towards(steps_kind(&f, "pole"), -1.0, 0.0));
    assert_true(share(1.0) == 1.0 &&
                !ground_debris_lies(&f.view.world, context.committed, POLE_X - 3.0, POLE_Z));
    assert_true(ground_debris_lies(&f.view.world, context.committed, 25400.0, 25403.0));
    assert_true(ground_marks_at(context.ground_marks, 25400.0, 25403.0) & GROUND_MARKS_DEBRIS);
    double dirt = ground_grip_of(COVER_GRASS).wheels;
    assert_true(ground_grip_at(&context, 25400.0, 25403.0).wheels > dirt);
}

#define TEST(name) cmocka_unit_test_prestate_setup_teardown(name, open_world, fixture_teardown, &f)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_pole_lies_along_its_fall_over_the_border_too),
        TEST(test_what_is_scattered_or_stands_is_no_obstacle),
        TEST(test_pushed_debris_is_left_to_the_collider_but_gives_less_grip),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
