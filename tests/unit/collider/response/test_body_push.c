/* A single impulse on a body: momentum, angular momentum, and what the ground holds. */
#include "collider/response/body_push.h"
#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;
static struct response_context context;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "");
    return 0;
}

static int close_world(void **state)
{
    (void)state;
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

static uint32_t put(const char *kind, double height_m, struct vec3 velocity)
{
    uint32_t row = fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                           .at = {25000.0, height_m, 25000.0},
                                                           .velocity = velocity,
                                                           .heading_rad = HALF_PI});
    steps_respond(&f, &context);
    return row;
}

static struct vec3 velocity_of(uint32_t row)
{
    return entities_velocity(&context.next->entities, row);
}

static struct vec3 spin_of(uint32_t row)
{
    const struct entities *e = &context.next->entities;
    return (struct vec3){e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z};
}

static bool near(double value, double right, double slack)
{
    return fabs(value - right) <= slack;
}

static void test_an_aircraft_takes_linear_and_angular_momentum(void **state)
{
    uint32_t row = put("helicopter", 900.0, (struct vec3){0.0, 0.0, 0.0});
    const struct mass_properties body = mass_properties_of(steps_kind(&f, "helicopter"));
    const struct vec3 impulse = {3000.0, 5000.0, -2000.0}, lever = {1.0, 0.5, -2.0};
    struct vec3 point = vec3_add(path_at(&context.path[row], 1.0), lever);
    (void)state;
    body_push(&context, row, 1.0, point, impulse); /* at the end: it does not rotate any more */
    struct vec3 v = velocity_of(row), w = spin_of(row), moment = vec3_cross(lever, impulse);
    assert_true(near(v.x, 3000.0 / body.mass_kg, 1e-12) &&
                near(v.y, 5000.0 / body.mass_kg, 1e-12) &&
                near(v.z, -2000.0 / body.mass_kg, 1e-12));
    /* It flies east: forward is x, up is y, right is z. */
    assert_true(near(w.x * body.moment.x, moment.x, 1e-6) &&
                near(w.y * body.moment.y, moment.y, 1e-6) &&
                near(w.z * body.moment.z, moment.z, 1e-6));
}

static void test_the_mobility_is_the_change_of_speed_at_the_point(void **state)
{
    static const char *const kinds[] = {"helicopter", "truck"};
    (void)state;
    for (size_t n = 0; n < 2; n++) {
        if (n > 0)
            steps_respond_end(&context);
        steps_empty(&f);
        uint32_t row = put(kinds[n], n == 0 ? 900.0 : 100.0, (struct vec3){0.0, 0.0, 0.0});
        const struct vec3 direction = {0.6, 0.0, 0.8}, lever = {2.0, 1.0, -0.5};
        struct vec3 point = vec3_add(path_at(&context.path[row], 1.0), lever);
        double mobility = body_push_mobility(&context, row, 1.0, point, direction);
        body_push(&context, row, 1.0, point, vec3_scale(direction, 1000.0));
        struct vec3 there = vec3_add(velocity_of(row), vec3_cross(spin_of(row), lever));
        assert_true(near(vec3_dot(there, direction), 1000.0 * mobility, 1e-9));
        assert_true(mobility > 1.0 / steps_kind(&f, kinds[n])->mass_kg);
    }
}

static void test_the_ground_holds_a_truck_level(void **state)
{
    uint32_t row = put("truck", 100.0, (struct vec3){0.0, 0.0, 0.0});
    double mass = steps_kind(&f, "truck")->mass_kg;
    (void)state;
    struct vec3 point = vec3_add(path_at(&context.path[row], 0.5), (struct vec3){2.0, 1.0, 1.0});
    body_push(&context, row, 0.5, point, (struct vec3){0.0, 9000.0, -4000.0});
    struct vec3 v = velocity_of(row), w = spin_of(row);
    assert_true(v.x == 0.0 && v.y == 0.0 && near(v.z, -4000.0 / mass, 1e-12));
    assert_true(w.x == 0.0 && w.z == 0.0 && w.y > 0.0); /* its front goes north: left */
    assert_true(context.next->entities.row[row].y == 100.0);
    /* Half a frame is left, at its new speed. */
    assert_true(
        near(context.next->entities.row[row].z, 25000.0 - 0.5 * 4000.0 / mass / 60.0, 1e-9));
}

static void test_a_slowed_vehicle_keeps_to_its_slope(void **state)
{
    uint32_t row = put("truck", 100.0, (struct vec3){10.0, 2.0, 0.0});
    double mass = steps_kind(&f, "truck")->mass_kg;
    (void)state;
    struct vec3 centre = path_at(&context.path[row], 0.0);
    body_push(&context, row, 0.0, centre, (struct vec3){-5.0 * mass, 0.0, 0.0});
    assert_true(near(velocity_of(row).x, 5.0, 1e-9) && near(velocity_of(row).y, 1.0, 1e-9));
}

/* One that stands and goes down on its springs was thrown up by 1e16 m/s. */
static void test_a_push_throws_nothing_up_that_is_on_its_springs(void **state)
{
    uint32_t row = put("truck", 100.0, (struct vec3){1e-17, -0.16, 0.0});
    double mass = steps_kind(&f, "truck")->mass_kg;
    (void)state;
    struct vec3 centre = path_at(&context.path[row], 0.0);
    body_push(&context, row, 0.0, centre, (struct vec3){-0.3 * mass, 0.0, 0.0});
    assert_true(near(velocity_of(row).x, -0.3, 1e-9) && near(velocity_of(row).y, -0.16, 1e-9));
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup_teardown(function, open_world, close_world)
    const struct CMUnitTest tests[] = {
        TEST(test_an_aircraft_takes_linear_and_angular_momentum),
        TEST(test_the_mobility_is_the_change_of_speed_at_the_point),
        TEST(test_the_ground_holds_a_truck_level),
        TEST(test_a_slowed_vehicle_keeps_to_its_slope),
        TEST(test_a_push_throws_nothing_up_that_is_on_its_springs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
