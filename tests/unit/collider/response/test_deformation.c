/* Energy into harm and dents, and what each physical characteristic changes: rows 26, 33, 47. */
#include "collider/response/deformation.h"
#include "collider/solver/contact_solver.h"
#include "collider/solver/contact_spring.h"
#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>

#include <cmocka.h>

static const struct kind skin = {.mass_kg = 1000.0,
                                 .length_m = 4.0,
                                 .width_m = 1.6,
                                 .height_m = 2.0,
                                 .rigidity = 0.5,
                                 .moldability = 0.75,
                                 .restitution = 0.2,
                                 .friction = 0.5,
                                 .resistance_j = 1e5,
                                 .stiffness_npm = 1e6};

static bool near(double value, double right)
{
    return fabs(value - right) <= 1e-12 * (1.0 + fabs(right));
}

/* --- one blow ----------------------------------------------------------------------------------*/

static void test_row_33_an_impact_damages_and_dents(void **state)
{
    struct deformation crush = deformation_of(&skin, 5e4);
    (void)state;
    assert_true(near(crush.harm_j, 5e4 * (0.5 + 0.5 * 0.75)));
    /* Half of a quarter of the smallest dimension, half of that for half the resistance. */
    assert_true(near(crush.plastic_m, 0.75 * 0.1) && near(crush.elastic_m, 0.25 * 0.1));
}

static void test_dents_do_not_get_deeper_than_the_skin(void **state)
{
    (void)state;
    assert_true(near(deformation_of(&skin, 1e5).plastic_m, 0.75 * 0.2));
    assert_true(near(deformation_of(&skin, 1e9).plastic_m, 0.75 * 0.2));
    assert_true(near(deformation_of(&skin, 1e9).elastic_m, 0.25 * 0.2));
    assert_true(near(deformation_of(&skin, 1e9).harm_j, 1e9 * 0.875)); /* but damage still grows */
}

static void test_grazes_leave_no_dents(void **state)
{
    double edge = 1e5 * DEFORMATION_DENT_LEAST_M / 0.2;
    (void)state;
    struct deformation crush = deformation_of(&skin, edge * 0.999);
    assert_true(crush.plastic_m == 0.0 && crush.elastic_m == 0.0 && crush.harm_j > 0.0);
    crush = deformation_of(&skin, edge * 1.001);
    assert_true(crush.plastic_m + crush.elastic_m >= DEFORMATION_DENT_LEAST_M);
    static const double nothing[] = {0.0, -5.0, (double)NAN};
    for (int n = 0; n < 3; n++) {
        crush = deformation_of(&skin, nothing[n]);
        assert_true(crush.harm_j == 0.0 && crush.plastic_m == 0.0 && crush.elastic_m == 0.0);
    }
}

static void test_row_47_an_elastic_skin_recovers(void **state)
{
    struct kind kind = skin;
    (void)state;
    kind.moldability = 0.0;
    assert_true(deformation_of(&kind, 1e5).plastic_m == 0.0 &&
                deformation_of(&kind, 1e5).elastic_m > 0.0);
    kind.moldability = 1.0;
    assert_true(deformation_of(&kind, 1e5).plastic_m > 0.0 &&
                deformation_of(&kind, 1e5).elastic_m == 0.0);
    assert_true(near(deformation_of(&kind, 1e5).harm_j, 1e5));
    kind.rigidity = 1.0; /* no give, no dent */
    kind.moldability = 0.0;
    assert_true(deformation_of(&kind, 1e5).elastic_m == 0.0);
    assert_true(near(deformation_of(&kind, 1e5).harm_j, 1e5));
}

/* --- row 26: each characteristic changes an outcome --------------------------------------------
 */

struct blow {
    double speed_mps;
    double angle_rad; /* of its path to the other's normal */
    struct kind kind, other;
};

struct aftermath {
    struct vec3 velocity;
    double turning_rps, share, harm_j, plastic_m, elastic_m, squeeze_m, duration_s;
};

static struct solver_body body_of(const struct kind *kind, struct vec3 at)
{
    static const struct mat3 straight = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    struct mass_properties inertia = mass_properties_of(kind);
    double inverse = 1.0 / inertia.mass_kg;
    return (struct solver_body){.inverse_mass = {inverse, inverse, inverse},
                                .inverse_inertia =
                                    mass_properties_inverse_world(&inertia, &straight),
                                .centre = at};
}

/* The kind runs into the other, which stands; the damage of the other, level by the energy that it
 * absorbed. */
static struct aftermath strike(const struct blow *blow)
{
    struct solver_body b[2] = {body_of(&blow->kind, (struct vec3){0, 0, 0}),
                               body_of(&blow->other, (struct vec3){4, 0, 1})};
    double sine, cosine;
    maths_sincos(blow->angle_rad, &sine, &cosine);
    b[0].velocity = (struct vec3){blow->speed_mps * cosine, 0.0, blow->speed_mps * sine};
    double friction = maths_min(blow->kind.friction, blow->other.friction);
    struct solver_contact contact = {.a = 0,
                                     .b = 1,
                                     .point = {2, 0, 0.5},
                                     .normal = {1, 0, 0},
                                     .restitution =
                                         maths_min(blow->kind.restitution, blow->other.restitution),
                                     .friction = friction};
    contact_solver_island(b, 2, &contact, 1);
    double whole = blow->kind.mass_kg + blow->other.mass_kg;
    struct deformation crush =
        deformation_of(&blow->other, contact.lost_j * blow->kind.mass_kg / whole);
    const struct contact_spring spring = {
        .reduced_kg = blow->kind.mass_kg * blow->other.mass_kg / whole,
        .closing_mps = contact.closing_mps,
        .stiffness_npm =
            contact_spring_in_series(blow->kind.stiffness_npm, blow->other.stiffness_npm),
        .restitution = contact.restitution};
    struct contact_spring_impact squeeze = contact_spring_impact(&spring);
    return (struct aftermath){.velocity = b[1].velocity,
                              .turning_rps = b[1].spin.y,
                              .share = crush.harm_j / blow->other.resistance_j,
                              .harm_j = crush.harm_j,
                              .plastic_m = crush.plastic_m,
                              .elastic_m = crush.elastic_m,
                              .squeeze_m = squeeze.depth_m,
                              .duration_s = squeeze.duration_s};
}

static struct blow usual(void)
{
    return (struct blow){.speed_mps = 12.0, .angle_rad = 0.5, .kind = skin, .other = skin};
}

static void test_row_26_speed(void **state)
{
    struct blow blow = usual();
    (void)state;
    struct aftermath before = strike(&blow);
    blow.speed_mps *= 1.5;
    struct aftermath after = strike(&blow);
    assert_true(near(after.velocity.x, 1.5 * before.velocity.x));
    assert_true(near(after.harm_j / before.harm_j, 2.25));
    assert_true(after.plastic_m > before.plastic_m && after.squeeze_m > before.squeeze_m);
}

static void test_row_26_angle(void **state)
{
    struct blow blow = usual();
    (void)state;
    blow.angle_rad = 1.3;
    struct aftermath slant = strike(&blow);
    blow.angle_rad = 0.0;
    struct aftermath straight = strike(&blow);
    assert_true(straight.velocity.x > slant.velocity.x && straight.harm_j > slant.harm_j);
    assert_true(straight.velocity.z != slant.velocity.z);
    assert_true(straight.turning_rps != slant.turning_rps);
}

/* Row 30: the heavier the one, the more the other suffers; the heavier the other, the less. */
static void test_row_26_masses(void **state)
{
    struct blow blow = usual();
    (void)state;
    struct aftermath before = strike(&blow);
    blow.kind.mass_kg *= 10.0;
    struct aftermath heavy = strike(&blow);
    assert_true(heavy.velocity.x > before.velocity.x && heavy.harm_j > before.harm_j);
    blow = usual();
    blow.other.mass_kg *= 10.0;
    struct aftermath firm = strike(&blow);
    assert_true(firm.velocity.x < before.velocity.x && firm.harm_j < before.harm_j);
}

static void test_row_26_resistance(void **state)
{
    struct blow blow = usual();
    (void)state;
    struct aftermath before = strike(&blow);
    blow.other.resistance_j *= 2.0;
    struct aftermath after = strike(&blow);
    assert_true(near(after.harm_j, before.harm_j) && near(after.share, 0.5 * before.share));
    assert_true(near(after.plastic_m, 0.5 * before.plastic_m));
}

static void test_row_26_moldability(void **state)
{
    struct blow blow = usual();
    (void)state;
    struct aftermath before = strike(&blow);
    blow.other.moldability = 0.25;
    struct aftermath after = strike(&blow);
    assert_true(after.harm_j < before.harm_j);
    assert_true(after.plastic_m < before.plastic_m && after.elastic_m > before.elastic_m);
    assert_true(near(after.plastic_m + after.elastic_m, before.plastic_m + before.elastic_m));
}

static void test_row_26_rigidity(void **state)
{
    struct blow blow = usual();
    (void)state;
    struct aftermath before = strike(&blow);
    blow.other.rigidity = 0.2;
    struct aftermath after = strike(&blow);
    assert_true(after.harm_j < before.harm_j);
    assert_true(after.plastic_m > before.plastic_m && after.elastic_m > before.elastic_m);
}

static void test_row_26_restitution_and_friction(void **state)
{
    struct blow blow = usual();
    (void)state;
    struct aftermath before = strike(&blow);
    blow.other.restitution = 0.0; /* the softer skin decides */
    struct aftermath dead = strike(&blow);
    assert_true(dead.velocity.x < before.velocity.x && dead.harm_j > before.harm_j);
    blow = usual();
    blow.other.friction = 0.0;
    struct aftermath slick = strike(&blow);
    assert_true(slick.velocity.z == 0.0 && before.velocity.z > 0.1);
    assert_true(slick.turning_rps != before.turning_rps);
}

static void test_row_26_spring_stiffness(void **state)
{
    struct blow blow = usual();
    (void)state;
    struct aftermath before = strike(&blow);
    blow.other.stiffness_npm *= 4.0;
    struct aftermath after = strike(&blow);
    assert_true(after.squeeze_m < before.squeeze_m && after.duration_s < before.duration_s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_33_an_impact_damages_and_dents),
        cmocka_unit_test(test_dents_do_not_get_deeper_than_the_skin),
        cmocka_unit_test(test_grazes_leave_no_dents),
        cmocka_unit_test(test_row_47_an_elastic_skin_recovers),
        cmocka_unit_test(test_row_26_speed),
        cmocka_unit_test(test_row_26_angle),
        cmocka_unit_test(test_row_26_masses),
        cmocka_unit_test(test_row_26_resistance),
        cmocka_unit_test(test_row_26_moldability),
        cmocka_unit_test(test_row_26_rigidity),
        cmocka_unit_test(test_row_26_restitution_and_friction),
        cmocka_unit_test(test_row_26_spring_stiffness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
