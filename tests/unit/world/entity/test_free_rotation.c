/* Free rotation: what it conserves in a minute, and Euler's equations. */
#include "world/entity/free_rotation.h"

#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>

#include <cmocka.h>

/* A tank: 50 t, 6.9 x 2.4 x 3.6 m. */
static const struct kind tank = {
    .domain = DOMAIN_LAND, .mass_kg = 50000.0, .length_m = 6.9, .height_m = 2.4, .width_m = 3.6};

static struct vec3 moment;

static int begin(void **state)
{
    (void)state;
    moment = mass_properties_of(&tank).moment;
    return 0;
}

static double energy_of(struct quat turned, struct vec3 spin)
{
    return 0.5 * vec3_dot(free_rotation_momentum(moment, turned, spin), spin);
}

static double difference(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

/* Returns the angle between two rotations [rad]. */
static double between(struct quat a, struct quat b)
{
    struct quat apart = rotation_product(a, rotation_inverse(b));
    return 2.0 * sqrt(apart.x * apart.x + apart.y * apart.y + apart.z * apart.z);
}

/* At 5, 60 and 240 Hz for 60 s, about an axis that is none of the body's. */
static void test_a_tumbling_tank_keeps_momentum_and_energy_for_a_minute(void **state)
{
    static const double rates_hz[] = {5.0, 60.0, 240.0}, spins_rps[] = {3.0, 10.0, 40.0};
    (void)state;
    for (int n = 0; n < 9; n++) {
        double rate_hz = rates_hz[n % 3], scale = spins_rps[n / 3] / 3.0;
        struct quat turned = rotation_of(1.0, 0.2, 0.3);
        struct vec3 spin = {0.3 * scale, 0.3 * scale, 3.0 * scale};
        struct vec3 momentum = free_rotation_momentum(moment, turned, spin);
        double energy = energy_of(turned, spin);
        for (int frame = 0; frame < 60.0 * rate_hz; frame++) {
            free_rotation_turn(moment, &turned, &spin, 1.0 / rate_hz);
            struct vec3 now = free_rotation_momentum(moment, turned, spin);
            assert_true(difference(now, momentum) <= 1e-10 * vec3_length(momentum));
            assert_true(fabs(energy_of(turned, spin) - energy) <= 1e-10 * energy);
        }
    }
}

/* Against a thousand times shorter steps. */
static void test_the_orientation_is_that_of_eulers_equations(void **state)
{
    static const double turns_rad[] = {0.01, 0.05, 0.2, 0.7, 3.0, 12.0};
    (void)state;
    for (int n = 0; n < 6; n++) {
        struct vec3 spin = {0.5 * turns_rad[n], 0.6 * turns_rad[n], 0.62 * turns_rad[n]};
        struct quat turned = rotation_of(1.0, -0.4, 2.0), finely = turned;
        struct vec3 fine_spin = spin;
        free_rotation_turn(moment, &turned, &spin, 1.0);
        for (int i = 0; i < 1000; i++)
            free_rotation_turn(moment, &finely, &fine_spin, 1e-3);
        assert_true(between(turned, finely) <= 2e-7 * turns_rad[n] + 1e-12);
        assert_true(difference(spin, fine_spin) <= 2e-7 * turns_rad[n] * turns_rad[n] + 1e-12);
    }
}

/* Between its ends it is smooth, its rate of change is the spin, and the bounds hold. */
static void test_each_share_is_a_place_on_one_path(void **state)
{
    const double step = 1e-4;
    struct vec3 spin = {1.0, -0.8, 1.3};
    struct free_rotation rotation =
        free_rotation_of(moment, rotation_of(0.3, 0.1, -1.0), spin, 2.0);
    double bend, most = free_rotation_rate(&rotation, &bend);
    (void)state;
    for (double share = 0.01; share < 0.99; share += 0.01) {
        struct quat there = free_rotation_at(&rotation, share);
        struct quat before = free_rotation_at(&rotation, share - step);
        struct quat after = free_rotation_at(&rotation, share + step);
        struct vec3 rate = free_rotation_spin(moment, there, rotation.momentum);
        struct vec3 seen = vec3_scale(rotation_speed(before, after, 0.5), 1.0 / (4.0 * step));
        assert_true(difference(rate, seen) < 1e-6);
        assert_true(vec3_length(rate) <= most);
        assert_true(fabs(energy_of(there, rate) / energy_of(rotation.from, spin) - 1.0) < 1e-13);
        struct vec3 faster = vec3_sub(free_rotation_spin(moment, after, rotation.momentum),
                                      free_rotation_spin(moment, before, rotation.momentum));
        double centripetal = vec3_dot(rate, rate);
        assert_true(vec3_length(faster) / (4.0 * step) + centripetal <= bend);
        /* The rest of the way from here leads to the same end. */
        struct free_rotation rest =
            free_rotation_of(moment, there, rate, (1.0 - share) * rotation.duration_s);
        assert_true(between(free_rotation_at(&rest, 1.0), free_rotation_at(&rotation, 1.0)) < 1e-6);
    }
}

static void test_about_a_principal_axis_and_with_equal_moments_the_spin_is_constant(void **state)
{
    const struct vec3 equal = {1.0, 1.0, 1.0}, slanted = {2.0, -1.0, 0.5};
    struct quat from = rotation_of(0.0, 0.0, 0.0), turned = from;
    struct vec3 spin = {0.0, 7.0, 0.0};
    (void)state;
    free_rotation_turn(moment, &turned, &spin, 0.5);
    assert_true(difference(spin, (struct vec3){0.0, 7.0, 0.0}) < 1e-12);
    assert_true(between(turned, rotation_spun(from, spin, 0.5)) < 1e-7);
    turned = from;
    spin = slanted;
    free_rotation_turn(equal, &turned, &spin, 0.5);
    assert_true(difference(spin, slanted) < 1e-12);
    assert_true(between(turned, rotation_spun(from, slanted, 0.5)) < 1e-14);
}

static void test_a_body_at_rest_keeps_every_bit(void **state)
{
    struct quat from = rotation_of(1.0, 0.2, 0.3), turned = from;
    struct vec3 spin = {0.0, 0.0, 0.0};
    (void)state;
    free_rotation_turn(moment, &turned, &spin, 0.2);
    assert_memory_equal(&turned, &from, sizeof from);
    assert_true(vec3_length(spin) == 0.0);
    spin = (struct vec3){1.0, 2.0, 3.0};
    free_rotation_turn(moment, &turned, &spin, 0.0);
    assert_memory_equal(&turned, &from, sizeof from);
}

/* However fast the spin is, time is bounded and nothing grows. */
static void test_absurd_spins_stay_finite_and_conserve(void **state)
{
    struct quat turned = rotation_of(1.0, 0.2, 0.3);
    struct vec3 spin = {3e5, 4e5, -5e5}, momentum = free_rotation_momentum(moment, turned, spin);
    (void)state;
    struct free_rotation rotation = free_rotation_of(moment, turned, spin, 1.0);
    assert_true(rotation.steps <= 1280 && rotation.duration_s < 1e-3);
    free_rotation_turn(moment, &turned, &spin, 1.0);
    assert_true(difference(free_rotation_momentum(moment, turned, spin), momentum) <=
                1e-9 * vec3_length(momentum));
}

int main(void)
{
#define TEST(function) cmocka_unit_test_setup(function, begin)
    const struct CMUnitTest tests[] = {
        TEST(test_a_tumbling_tank_keeps_momentum_and_energy_for_a_minute),
        TEST(test_the_orientation_is_that_of_eulers_equations),
        TEST(test_each_share_is_a_place_on_one_path),
        TEST(test_about_a_principal_axis_and_with_equal_moments_the_spin_is_constant),
        TEST(test_a_body_at_rest_keeps_every_bit),
        TEST(test_absurd_spins_stay_finite_and_conserve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
