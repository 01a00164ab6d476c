/* An aircraft meets the ground with its hull, not with its middle. */
#include "collider/motion/ground_impact.h"
#include "tests/support/steps.h"
#include "world/body_points.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

static double clearance(uint32_t row)
{
    struct entities e = steps_rows(&f);
    struct body_points points;
    body_points_of(&f.view.world, e.row[row].kind, &points);
    return body_points_clearance(
        &f.view.world, NULL, &points, entities_position(&e, row),
        rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
}

static uint32_t put(double height, struct vec3 velocity, double pitch)
{
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = "jet",
                                                           .at = {25000.0, 100.0 + height, 25000.0},
                                                           .velocity = velocity});
    steps_rows(&f).row[row].pitch = pitch;
    return row;
}

static void dive(const char *scenario)
{
    fixture_open(&f, scenario);
    uint32_t row = put(60.0, (struct vec3){60.0, -90.0, 0.0}, -0.98);
    uint32_t frames = 0;
    for (; steps_rows(&f).row[row].state == ENTITY_ACTIVE && frames < 120; frames++) {
        assert_true(clearance(row) > 0.0);
        fixture_run(&f, 1);
    }
    struct entities e = steps_rows(&f);
    assert_int_equal(e.row[row].state, ENTITY_WRECK);
    assert_true(fabs(clearance(row)) < 1e-6 && e.row[row].y > 106.0);
    assert_true(e.row[row].pitch == -0.98 && e.row[row].vx == 60.0 && e.row[row].vy == -90.0);
    assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
    fixture_close(&f);
}

static void test_a_diving_aircraft_crashes_when_its_nose_touches(void **state)
{
    (void)state;
    dive("collision = { shape = \"model\"; };");
}

/* It collides with others as a sphere, and with the ground as a box. */
static void test_a_diving_sphere_crashes_when_its_box_touches(void **state)
{
    (void)state;
    dive("collision = { shape = \"sphere\"; };");
}

static void test_an_aircraft_low_over_the_ground_does_not(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    uint32_t row = put(0.0, (struct vec3){80.0, 0.0, 0.0}, 0.0);
    steps_rows(&f).row[row].y += 0.1 - clearance(row);
    fixture_run(&f, 30);
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_ACTIVE);
    steps_rows(&f).row[row].y -= 0.2;
    fixture_run(&f, 1);
    assert_int_equal(steps_rows(&f).row[row].state, ENTITY_WRECK);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_diving_aircraft_crashes_when_its_nose_touches),
        cmocka_unit_test(test_a_diving_sphere_crashes_when_its_box_touches),
        cmocka_unit_test(test_an_aircraft_low_over_the_ground_does_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
