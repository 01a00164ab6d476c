/* Mass properties of kinds. */
#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>

#include <cmocka.h>

static const struct kind box = {
    .domain = DOMAIN_LAND, .mass_kg = 1200.0, .length_m = 4.0, .height_m = 2.0, .width_m = 3.0};

static bool near(double value, double right)
{
    return fabs(value - right) <= 1e-12 * (1.0 + fabs(right));
}

static void test_a_box_has_a_boxs_moments(void **state)
{
    struct mass_properties inertia = mass_properties_of(&box);
    (void)state;
    assert_true(inertia.mass_kg == 1200.0);
    assert_true(near(inertia.moment.x, 100.0 * (4.0 + 9.0)));  /* rolls: height and width */
    assert_true(near(inertia.moment.y, 100.0 * (16.0 + 9.0))); /* turns: length and width */
    assert_true(near(inertia.moment.z, 100.0 * (16.0 + 4.0))); /* pitches: length and height */
}

static void test_the_centre_is_half_up_on_the_ground_and_at_the_position_elsewhere(void **state)
{
    static const double centres[DOMAIN_COUNT] = {[DOMAIN_LAND] = 1.0, [DOMAIN_FIXED] = 1.0};
    (void)state;
    for (int domain = 0; domain < DOMAIN_COUNT; domain++) {
        struct kind kind = box;
        kind.domain = (uint8_t)domain;
        assert_true(mass_properties_of(&kind).centre_m == centres[domain]);
    }
}

/* A quarter turn to the left about the vertical: forward is north, right is east. */
static void test_a_turned_box_has_its_axes_turned(void **state)
{
    static const struct mat3 turn = {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}};
    struct mass_properties inertia = mass_properties_of(&box);
    struct mat3 world = mass_properties_inverse_world(&inertia, &turn);
    (void)state;
    assert_true(near(world.m[0][0] * inertia.moment.z, 1.0)); /* about east: it pitches */
    assert_true(near(world.m[1][1] * inertia.moment.y, 1.0));
    assert_true(near(world.m[2][2] * inertia.moment.x, 1.0));
    assert_true(world.m[0][1] == 0.0 && world.m[0][2] == 0.0 && world.m[1][2] == 0.0);
}

/* Slanted: inverse on world axes times the moment on world axes is one, and nothing is lopsided. */
static void test_slanted_it_is_the_inverse_and_symmetric(void **state)
{
    double s = 0.6, c = 0.8, t = 5.0 / 13.0, d = 12.0 / 13.0;
    const struct mat3 turn = {{{c, -s * d, s * t}, {s, c * d, -c * t}, {0.0, t, d}}};
    struct mass_properties inertia = mass_properties_of(&box);
    struct mat3 world = mass_properties_inverse_world(&inertia, &turn);
    const double moment[3] = {inertia.moment.x, inertia.moment.y, inertia.moment.z};
    (void)state;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++) {
                double whole = 0.0;
                for (int axis = 0; axis < 3; axis++)
                    whole += turn.m[k][axis] * moment[axis] * turn.m[j][axis];
                sum += world.m[i][k] * whole;
            }
            assert_true(near(sum, i == j ? 1.0 : 0.0));
            assert_true(world.m[i][j] == world.m[j][i]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_box_has_a_boxs_moments),
        cmocka_unit_test(test_the_centre_is_half_up_on_the_ground_and_at_the_position_elsewhere),
        cmocka_unit_test(test_a_turned_box_has_its_axes_turned),
        cmocka_unit_test(test_slanted_it_is_the_inverse_and_symmetric),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
