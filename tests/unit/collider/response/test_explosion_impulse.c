/* The push of an explosion against the published fit, and overturning against a rotation in small
 * steps (thesis p. 8). */
#include "collider/response/explosion_impulse.h"

#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

static const struct kind jeep = {.domain = DOMAIN_LAND,
                                 .mass_kg = 1100.0,
                                 .length_m = 3.4,
                                 .width_m = 1.6,
                                 .height_m = 1.7,
                                 .track_m = 1.35,
                                 .centre_height_m = 0.66};
static const struct mat3 straight = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

/* Swisdak 1994, hemispherical charges: reflected impulse [Pa s]. */
static double published(double explosive_kg, double distance_m)
{
    double root = cbrt(explosive_kg), l = log(distance_m / root);
    return root * exp(6.7853 - 1.3466 * l + 0.101 * l * l - 0.01123 * l * l * l);
}

static void test_the_impulse_is_the_published_one(void **state)
{
    static const double charges[] = {0.15, 1.5, 7.0, 89.0, 1000.0};
    (void)state;
    for (size_t n = 0; n < sizeof charges / sizeof charges[0]; n++) {
        for (double z = EXPLOSION_IMPULSE_LEAST_Z; z < 8.0; z *= 1.05) {
            double right = published(charges[n], z * cbrt(charges[n]));
            double found = explosion_impulse_pas(charges[n], z * cbrt(charges[n]));
            assert_true(fabs(found - right) < 0.012 * right);
        }
        double z = 40.0 * cbrt(charges[n]);
        assert_true(fabs(explosion_impulse_pas(charges[n], z) / published(charges[n], z) - 1.0) <
                    0.043);
    }
}

static void test_near_the_charge_it_is_bounded(void **state)
{
    double edge = explosion_impulse_pas(8.0, EXPLOSION_IMPULSE_LEAST_Z * 2.0);
    (void)state;
    assert_true(explosion_impulse_pas(8.0, 0.0) == edge && explosion_impulse_pas(8.0, 0.5) == edge);
    assert_true(fabs(edge - 2.0 * (570.0 / 0.5 + 305.0 / 0.25)) < 1e-9);
    assert_true(explosion_impulse_pas(0.0, 0.0) == 0.0 && explosion_impulse_pas(0.0, 1.0) == 0.0);
}

static struct explosion_impulse on(const struct kind *kind, const struct mat3 *turn, double x,
                                   double y, double z)
{
    const struct explosion_impulse_target target = {
        .kind = kind, .centre = {0.0, 0.0, 0.0}, .turn = *turn};
    return explosion_impulse_on(&target, (struct vec3){x, y, z}, 1.0);
}

static void test_it_acts_along_the_line_on_the_side_that_faces_the_charge(void **state)
{
    const double far = 1000.0; /* all points are equally far */
    double pas = explosion_impulse_pas(EXPLOSION_IMPULSE_CASED, far);
    (void)state;
    struct explosion_impulse front = on(&jeep, &straight, far, 0.0, 0.0);
    struct explosion_impulse side = on(&jeep, &straight, 0.0, 0.0, -far);
    struct explosion_impulse below = on(&jeep, &straight, 0.0, -far, 0.0);
    assert_true(fabs(front.impulse_ns.x + pas * 1.6 * 1.7) < 1e-4 * pas);
    assert_true(front.impulse_ns.y == 0.0 && front.impulse_ns.z == 0.0);
    assert_true(fabs(side.impulse_ns.z - pas * 3.4 * 1.7) < 1e-4 * pas);
    assert_true(fabs(below.impulse_ns.y - pas * 3.4 * 1.6) < 1e-4 * pas);
    struct explosion_impulse slant = on(&jeep, &straight, -0.6 * far, 0.0, 0.8 * far);
    double shadow = 0.6 * 1.6 * 1.7 + 0.8 * 3.4 * 1.7;
    assert_true(fabs(slant.impulse_ns.x - 0.6 * pas * shadow) < 1e-3 * pas);
    assert_true(fabs(slant.impulse_ns.z + 0.8 * pas * shadow) < 1e-3 * pas);
    /* The same body turned to the north: its side now shows to the east. */
    const struct mat3 north = rotation_matrix(rotation_of(0.0, 0.0, 0.0));
    struct explosion_impulse turned = on(&jeep, &north, far, 0.0, 0.0);
    assert_true(fabs(turned.impulse_ns.x + pas * 3.4 * 1.7) < 1e-4 * pas);
}

static void test_the_nearer_end_is_pushed_harder(void **state)
{
    (void)state;
    struct explosion_impulse middle = on(&jeep, &straight, 0.0, 0.0, 3.0);
    struct explosion_impulse front = on(&jeep, &straight, 1.7, 0.0, 3.0);
    assert_true(fabs(middle.point.x) < 1e-12);
    assert_true(front.point.x > 0.01 && front.point.x < 1.7);
    struct explosion_impulse far = on(&jeep, &straight, 170.0, 0.0, 300.0);
    assert_true(fabs(far.point.x) < 0.1 * front.point.x);
}

static void test_a_charge_at_the_centre_pushes_nothing(void **state)
{
    (void)state;
    struct explosion_impulse none = on(&jeep, &straight, 0.0, 0.0, 0.0);
    assert_true(vec3_length(none.impulse_ns) == 0.0);
    struct explosion_impulse near = on(&jeep, &straight, 1e-9, 0.0, 0.0);
    assert_true(isfinite(vec3_length(near.impulse_ns)) && isfinite(near.point.x));
}

/* Rotates a box about its edge on the ground from the speed that the push gives it, in small steps.
 * Returns true if the centre of mass passes over the edge. */
static bool stepped_over(const struct kind *kind, double edge_m, double moment, double push_ns)
{
    double height = kind->centre_height_m, arm = sqrt(height * height + edge_m * edge_m);
    double about = moment + kind->mass_kg * arm * arm, dt = 1e-4;
    double angle = atan2(height, edge_m), spin = push_ns * 0.5 * kind->height_m / about;
    while (spin > 0.0 && angle < HALF_PI) {
        spin -= dt * kind->mass_kg * 9.80665 * arm * cos(angle) / about;
        angle += dt * spin;
    }
    return angle >= HALF_PI;
}

static void test_it_overturns_what_a_rotation_in_steps_lifts_over_its_edge(void **state)
{
    int over = 0, under = 0;
    (void)state;
    const struct mass_properties body = mass_properties_of(&jeep);
    for (double speed = 0.5; speed < 20.0; speed *= 1.07) {
        double push = speed * jeep.mass_kg;
        bool side = explosion_impulse_overturns(&jeep, 0.0, push),
             end = explosion_impulse_overturns(&jeep, -push, 0.0);
        if (explosion_impulse_overturns(&jeep, 0.0, 0.99 * push) ==
            explosion_impulse_overturns(&jeep, 0.0, 1.01 * push))
            assert_int_equal(side, stepped_over(&jeep, 0.675, body.moment.x, push));
        if (explosion_impulse_overturns(&jeep, 0.99 * push, 0.0) ==
            explosion_impulse_overturns(&jeep, 1.01 * push, 0.0))
            assert_int_equal(end, stepped_over(&jeep, 1.7, body.moment.z, push));
        assert_true(side || !end); /* it is longer than wide */
        over += side;
        under += !side;
    }
    assert_true(over > 5 && under > 5);
}

static void test_only_land_vehicles_overturn(void **state)
{
    struct kind other = jeep;
    (void)state;
    assert_true(explosion_impulse_overturns(&jeep, 0.0, 1e9));
    assert_false(explosion_impulse_overturns(&jeep, 0.0, 0.0));
    other.domain = DOMAIN_SEA;
    assert_false(explosion_impulse_overturns(&other, 0.0, 1e9));
    other.domain = DOMAIN_AIR;
    assert_false(explosion_impulse_overturns(&other, 1e9, 1e9));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_impulse_is_the_published_one),
        cmocka_unit_test(test_near_the_charge_it_is_bounded),
        cmocka_unit_test(test_it_acts_along_the_line_on_the_side_that_faces_the_charge),
        cmocka_unit_test(test_the_nearer_end_is_pushed_harder),
        cmocka_unit_test(test_a_charge_at_the_centre_pushes_nothing),
        cmocka_unit_test(test_it_overturns_what_a_rotation_in_steps_lifts_over_its_edge),
        cmocka_unit_test(test_only_land_vehicles_overturn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
