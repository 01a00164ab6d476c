/* Simultaneous impulses on cases that can be worked out by hand. Conservation over random islands
 * is in tests/property/collider/test_contact_solver.c. */
#include "collider/solver/contact_solver.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define NEAR(a, b) assert_true(fabs((a) - (b)) < 1e-9)

static struct mat3 diagonal(double x, double y, double z)
{
    return (struct mat3){{{x, 0.0, 0.0}, {0.0, y, 0.0}, {0.0, 0.0, z}}};
}

/* A ball of radius 1: its moment is two fifths of its mass. */
static struct solver_body ball(double mass_kg, struct vec3 centre, struct vec3 velocity)
{
    double spin = 2.5 / mass_kg;
    return (struct solver_body){.inverse_mass = {1.0 / mass_kg, 1.0 / mass_kg, 1.0 / mass_kg},
                                .inverse_inertia = diagonal(spin, spin, spin),
                                .centre = centre,
                                .velocity = velocity};
}

static struct solver_body wall(void)
{
    return (struct solver_body){.centre = {0.0, 0.0, 0.0}};
}

/* Where two balls of radius 1 touch. */
static struct solver_contact impact(const struct solver_body *bodies, uint32_t a, uint32_t b,
                                    double restitution, double friction)
{
    struct vec3 between = vec3_sub(bodies[b].centre, bodies[a].centre);
    struct vec3 normal = vec3_scale(between, 1.0 / vec3_length(between));
    return (struct solver_contact){.a = a,
                                   .b = b,
                                   .point = vec3_add(bodies[a].centre, normal),
                                   .normal = normal,
                                   .restitution = restitution,
                                   .friction = friction};
}

/* --- one contact -------------------------------------------------------------------------------*/

static void test_a_head_on_impact_follows_newton(void **state)
{
    (void)state;
    for (double e = 0.0; e <= 1.0; e += 0.25) {
        struct solver_body b[2] = {ball(3000.0, (struct vec3){0, 0, 0}, (struct vec3){8, 0, 0}),
                                   ball(1000.0, (struct vec3){2, 0, 0}, (struct vec3){0, 0, 0})};
        struct solver_contact c = impact(b, 0, 1, e, 0.7);
        contact_solver_island(b, 2, &c, 1);
        NEAR(b[0].velocity.x, 6.0 - 2.0 * e);
        NEAR(b[1].velocity.x, 6.0 + 6.0 * e);
        NEAR(c.impulse.x, 6000.0 * (1.0 + e));
        NEAR(c.closing_mps, 8.0);
        NEAR(c.lost_j, 0.5 * 750.0 * 64.0 * (1.0 - e * e));
        assert_true(vec3_length(b[0].spin) == 0.0 && vec3_length(b[1].spin) == 0.0);
    }
}

static void test_bodies_that_part_get_nothing(void **state)
{
    static const double leaving[] = {0.0, 5.0};
    (void)state;
    for (int n = 0; n < 2; n++) {
        struct solver_body b[2] = {
            ball(1.0, (struct vec3){0, 0, 0}, (struct vec3){0, 3, 0}),
            ball(1.0, (struct vec3){2, 0, 0}, (struct vec3){leaving[n], 0, 0})};
        struct solver_contact c = impact(b, 0, 1, 0.5, 1.0);
        contact_solver_island(b, 2, &c, 1);
        assert_true(vec3_length(c.impulse) == 0.0 && c.lost_j == 0.0);
        assert_true(c.closing_mps == -leaving[n]);
        assert_true(b[0].velocity.y == 3.0 && b[1].velocity.x == leaving[n]);
    }
}

/* A ball thrown onto the ground at a slant: v across, v down. */
static struct solver_body thrown(double across, double down, double e, double friction,
                                 struct solver_contact *c)
{
    struct solver_body b[2] = {wall(),
                               ball(2.0, (struct vec3){0, 1, 0}, (struct vec3){across, -down, 0})};
    *c = (struct solver_contact){.a = 0,
                                 .b = 1,
                                 .point = {0, 0, 0},
                                 .normal = {0, 1, 0},
                                 .restitution = e,
                                 .friction = friction};
    contact_solver_island(b, 2, c, 1);
    assert_true(vec3_length(b[0].velocity) == 0.0 && vec3_length(b[0].spin) == 0.0);
    return b[1];
}

static void test_friction_that_grips_makes_a_ball_roll(void **state)
{
    struct solver_contact c;
    (void)state;
    struct solver_body b = thrown(7.0, 10.0, 0.5, 2.0, &c);
    NEAR(b.velocity.x, 5.0); /* five sevenths */
    NEAR(b.velocity.y, 5.0);
    NEAR(b.spin.z, -5.0); /* forward: clockwise seen from its right */
    NEAR(b.velocity.x + b.spin.z, 0.0);
    NEAR(c.impulse.x, -4.0);
    NEAR(c.impulse.y, 30.0);
}

static void test_friction_that_slides_ends_at_the_cone(void **state)
{
    struct solver_contact c;
    (void)state;
    struct solver_body b = thrown(7.0, 1.0, 0.5, 0.4, &c);
    NEAR(c.impulse.y, 3.0);
    NEAR(c.impulse.x, -0.4 * 3.0);
    NEAR(b.velocity.x, 7.0 - 0.6);
    NEAR(b.spin.z, -1.2 * 2.5 / 2.0);
    assert_true(b.velocity.x + b.spin.z > 0.0); /* it still slides */
}

static void test_without_friction_nothing_spins(void **state)
{
    struct solver_contact c;
    (void)state;
    struct solver_body b = thrown(7.0, 1.0, 1.0, 0.0, &c);
    assert_true(b.velocity.x == 7.0 && vec3_length(b.spin) == 0.0 && c.impulse.x == 0.0);
    NEAR(b.velocity.y, 1.0);
    NEAR(c.lost_j, 0.0);
}

/* A jeep's right front corner is clipped by a tank from ahead: seen from above, east is forward and
 * south is right, so that its nose is thrown round to the right. */
static void test_a_glancing_hit_spins_a_body_the_right_way(void **state)
{
    (void)state;
    for (int left = 0; left < 2; left++) {
        double side = left ? -0.8 : 0.8;
        struct solver_body b[2] = {
            ball(1000.0, (struct vec3){0, 0, 0}, (struct vec3){10, 0, 0}),
            ball(50000.0, (struct vec3){4, 0, 2.0 * side}, (struct vec3){-10, 0, 0})};
        b[0].inverse_inertia = diagonal(0.001, 0.001, 0.001);
        b[1].inverse_inertia = diagonal(0.0, 1e-6, 0.0);
        struct solver_contact c = {
            .a = 0, .b = 1, .point = {1.7, 0, side}, .normal = {1, 0, 0}, .restitution = 0.2};
        contact_solver_island(b, 2, &c, 1);
        /* Positive about y is from east towards north: to the left. */
        assert_true(left ? b[0].spin.y > 0.1 : b[0].spin.y < -0.1);
        assert_true(left ? b[1].spin.y > 0.0 : b[1].spin.y < 0.0);
        assert_true(b[0].velocity.x < 0.0);
    }
}

static void test_what_is_held_stays(void **state)
{
    (void)state;
    /* Two land vehicles: they neither rise nor roll, in whichever direction the normal points. */
    struct solver_body b[2];
    for (int n = 0; n < 2; n++) {
        b[n] = ball(1000.0, (struct vec3){4.0 * n, 0, 0}, (struct vec3){n ? -5.0 : 5.0, 0, 1.0});
        b[n].inverse_mass.y = 0.0;
        b[n].inverse_inertia = diagonal(0.0, 0.0015, 0.0);
    }
    struct solver_contact c = {
        .a = 0, .b = 1, .point = {2, 1, 0.5}, .normal = {0.8, 0.6, 0}, .friction = 0.5};
    contact_solver_island(b, 2, &c, 1);
    for (int n = 0; n < 2; n++) {
        assert_true(b[n].velocity.y == 0.0 && b[n].spin.x == 0.0 && b[n].spin.z == 0.0);
        assert_true(b[n].spin.y != 0.0);
    }
    struct vec3 off = vec3_sub(b[1].velocity, b[0].velocity); /* at the point, along the normal */
    NEAR((off.x + 0.5 * (b[1].spin.y - b[0].spin.y)) * 0.8, 0.0);
}

static void test_what_nothing_can_part_is_left_alone(void **state)
{
    (void)state;
    struct solver_body b[2] = {wall(), wall()};
    b[1].velocity = (struct vec3){-5.0, 0.0, 0.0};
    struct solver_contact c = {
        .a = 0, .b = 1, .normal = {1, 0, 0}, .restitution = 1, .friction = 1};
    contact_solver_island(b, 2, &c, 1);
    assert_true(b[1].velocity.x == -5.0 && vec3_length(c.impulse) == 0.0 && c.lost_j == 0.0);
    assert_true(c.closing_mps == 5.0);
    /* One vehicle on top of another, both held upright: no push along the normal helps. */
    for (int n = 0; n < 2; n++) {
        b[n] =
            ball(1000.0, (struct vec3){0, 2.0 * n, 0}, (struct vec3){0, n ? -1.0 : 0.0, 3.0 * n});
        b[n].inverse_mass.y = 0.0;
        b[n].inverse_inertia = diagonal(0.0, 0.0015, 0.0);
    }
    c = (struct solver_contact){
        .a = 0, .b = 1, .point = {0, 1, 0}, .normal = {1e-7, 1, 0}, .friction = 1.0};
    contact_solver_island(b, 2, &c, 1);
    assert_true(b[1].velocity.z == 3.0 && b[1].velocity.x == 0.0 && vec3_length(c.impulse) == 0.0);
}

/* --- several
 * ------------------------------------------------------------------------------------*/

static void test_a_cradle_between_its_limits(void **state)
{
    (void)state;
    for (uint32_t n = 2; n <= 8; n++) {
        for (int elastic = 0; elastic < 2; elastic++) {
            struct solver_body b[8];
            struct solver_contact c[7];
            for (uint32_t i = 0; i < n; i++)
                b[i] =
                    ball(1.0, (struct vec3){2.0 * i, 0, 0}, (struct vec3){i == 0 ? 1.0 : 0, 0, 0});
            for (uint32_t i = 0; i + 1 < n; i++)
                c[i] = impact(b, i, i + 1, elastic, 0.3);
            contact_solver_island(b, n, c, n - 1);
            /* Solved at one moment the others are as one body of their whole mass. */
            double others = elastic ? 2.0 / n : 1.0 / n, energy = 0.0, lost = 0.0;
            for (uint32_t i = 0; i < n; i++) {
                NEAR(b[i].velocity.x, i > 0 ? others : others - elastic);
                energy += 0.5 * b[i].velocity.x * b[i].velocity.x;
                lost += i > 0 ? c[i - 1].lost_j : 0.0;
            }
            NEAR(energy, elastic ? 0.5 : 0.5 / n);
            NEAR(energy + lost, 0.5);
        }
    }
}

static void test_a_cradle_struck_one_by_one_hands_all_of_it_on(void **state)
{
    struct solver_body b[5];
    (void)state;
    for (uint32_t i = 0; i < 5; i++)
        b[i] = ball(1.0, (struct vec3){2.0 * i, 0, 0}, (struct vec3){i == 0 ? 1.0 : 0, 0, 0});
    for (uint32_t i = 0; i < 4; i++) {
        struct solver_contact c = impact(b, i, i + 1, 1.0, 0.0);
        contact_solver_island(b, 5, &c, 1);
    }
    for (uint32_t i = 0; i < 5; i++)
        NEAR(b[i].velocity.x, i == 4 ? 1.0 : 0.0);
}

/* Row 36: one ball into the middle of two, all three at once. */
static void test_row_36_a_symmetric_hit_has_a_symmetric_answer(void **state)
{
    static const double frictions[] = {0.0, 0.3, 2.0};
    (void)state;
    for (int n = 0; n < 9; n++) {
        double e = 0.5 * (n / 3), half = sqrt(3.0);
        struct solver_body b[3] = {ball(5.0, (struct vec3){0, 0, 0}, (struct vec3){6, 0, 0}),
                                   ball(2.0, (struct vec3){half, 0, -1}, (struct vec3){0, 0, 0}),
                                   ball(2.0, (struct vec3){half, 0, 1}, (struct vec3){0, 0, 0})};
        struct solver_contact c[3] = {impact(b, 0, 1, e, frictions[n % 3]),
                                      impact(b, 0, 2, e, frictions[n % 3]),
                                      impact(b, 1, 2, e, frictions[n % 3])};
        contact_solver_island(b, 3, c, 3);
        NEAR(b[0].velocity.z, 0.0);
        NEAR(b[0].spin.y, 0.0);
        NEAR(b[1].velocity.x, b[2].velocity.x);
        NEAR(b[1].velocity.z, -b[2].velocity.z);
        NEAR(b[1].spin.y, -b[2].spin.y);
        NEAR(c[0].lost_j, c[1].lost_j);
        assert_true(b[1].velocity.x > 1.0);
        NEAR(5.0 * b[0].velocity.x + 4.0 * b[1].velocity.x, 30.0);
    }
}

/* What is already parting is pressed when the rest of the island presses it. */
static void test_a_parting_contact_is_pressed_by_the_island(void **state)
{
    (void)state;
    struct solver_body b[3] = {ball(10.0, (struct vec3){0, 0, 0}, (struct vec3){9, 0, 0}),
                               ball(1.0, (struct vec3){2, 0, 0}, (struct vec3){0, 0, 0}),
                               ball(1.0, (struct vec3){4, 0, 0}, (struct vec3){1, 0, 0})};
    struct solver_contact c[2] = {impact(b, 0, 1, 0.0, 0.0), impact(b, 1, 2, 1.0, 0.0)};
    contact_solver_island(b, 3, c, 2);
    assert_true(c[1].closing_mps < 0.0 && c[1].impulse.x > 0.0);
    for (int i = 0; i < 3; i++)
        NEAR(b[i].velocity.x, 91.0 / 12.0);
}

/* Between two walls that it touches a body cannot bounce off both: it stops, and friction slows
 * it. */
static void test_a_body_without_room_to_bounce_stops(void **state)
{
    (void)state;
    for (int rough = 0; rough < 2; rough++) {
        struct solver_body b[3] = {
            wall(), ball(2.0, (struct vec3){0, 0, 0}, (struct vec3){4, 0.7, 0}), wall()};
        struct solver_contact c[2] = {
            {.a = 0, .b = 1, .point = {-1, 0, 0}, .normal = {1, 0, 0}, .restitution = 0.8},
            {.a = 1, .b = 2, .point = {1, 0, 0}, .normal = {1, 0, 0}, .restitution = 0.8}};
        c[0].friction = c[1].friction = rough;
        contact_solver_island(b, 3, c, 2);
        NEAR(b[1].velocity.x, 0.0);
        NEAR(b[1].velocity.y, rough ? 0.5 : 0.7);
        NEAR(c[0].lost_j + c[1].lost_j, rough ? 16.49 - 0.35 : 16.0);
    }
}

/* A hundred tanks and jeeps that press on each other from all sides. */
static void test_a_great_pile_ends_without_anybody_nearing(void **state)
{
    enum { SIDE = 10, CONTACTS = 2 * SIDE * (SIDE - 1) };
    static struct solver_body b[SIDE * SIDE];
    static struct solver_contact c[CONTACTS];
    uint64_t random = 5;
    uint32_t count = 0;
    double before = 0.0, after = 0.0, lost = 0.0, closing = 0.0;
    (void)state;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double mass = i % 3 ? 1100.0 : 57000.0;
        b[i] = ball(
            mass, (struct vec3){2.0 * (i / SIDE), 0, 2.0 * (i % SIDE)},
            (struct vec3){fixture_uniform(&random, -5, 5), 0, fixture_uniform(&random, -5, 5)});
        before += 0.5 * mass * vec3_dot(b[i].velocity, b[i].velocity);
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        if (i / SIDE + 1 < SIDE)
            c[count++] = impact(b, i, i + SIDE, 0.2, 0.5);
        if (i % SIDE + 1 < SIDE)
            c[count++] = impact(b, i, i + 1, 0.2, 0.5);
    }
    assert_int_equal(count, CONTACTS);
    contact_solver_island(b, SIDE * SIDE, c, count);
    for (uint32_t n = 0; n < count; n++) {
        closing = maths_max(closing, c[n].closing_mps);
        lost += c[n].lost_j;
    }
    for (uint32_t n = 0; n < count; n++) {
        const struct solver_body *a = &b[c[n].a], *other = &b[c[n].b];
        /* Balls: spin does not change the speed along the normal. */
        struct vec3 off = vec3_sub(other->velocity, a->velocity);
        assert_true(vec3_dot(off, c[n].normal) > -1e-9 * closing);
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        after += 0.5 / b[i].inverse_mass.x * vec3_dot(b[i].velocity, b[i].velocity) +
                 0.2 / b[i].inverse_mass.x * vec3_dot(b[i].spin, b[i].spin);
    assert_true(after < before && fabs(before - after - lost) < 1e-9 * before);
}

/* --- bodies on the ground ----------------------------------------------------------------------*/

#define ROW 6u

static struct solver_body grounded(double mass_kg, struct vec3 centre, struct vec3 velocity)
{
    return (struct solver_body){.inverse_mass = {1.0 / mass_kg, 0.0, 1.0 / mass_kg},
                                .inverse_inertia = diagonal(0.0, 0.3 / mass_kg, 0.0),
                                .centre = centre,
                                .velocity = velocity};
}

static double drawn(uint64_t *seed, double most)
{
    return fixture_uniform(seed, -most, most);
}

/* Bodies in a row against a wall, with level normals that are not quite along the row. */
static void lay_row(struct solver_body *b, struct solver_contact *c, uint64_t *seed)
{
    b[0] = wall();
    for (uint32_t i = 1; i < ROW; i++)
        b[i] = grounded(1000.0 * i, (struct vec3){4.0 * i, drawn(seed, 0.5), drawn(seed, 1.0)},
                        (struct vec3){drawn(seed, 9.0), 0.0, drawn(seed, 3.0)});
    for (uint32_t i = 0; i + 1 < ROW; i++) {
        double sine, cosine;
        maths_sincos(drawn(seed, 0.5), &sine, &cosine);
        c[i] = (struct solver_contact){
            .a = i,
            .b = i + 1,
            .point = {4.0 * i + 2.0, drawn(seed, 1.0), drawn(seed, 1.5)},
            .normal = {cosine, 0.0, sine},
            .restitution = i % 2 ? 0.3 : 0.0,
            .friction = 0.5,
        };
    }
}

/* Bodies that cannot leave the ground are solved by less arithmetic. A body in the air, which
 * nothing touches, makes the solver use all of it. */
static void test_bodies_on_the_ground_have_the_same_bits(void **state)
{
    (void)state;
    uint64_t seed = fixture_seed(12);
    for (uint32_t n = 0; n < 200; n++) {
        struct solver_body level[ROW], whole[ROW + 1];
        struct solver_contact c[2][ROW - 1];
        lay_row(level, c[0], &seed);
        for (uint32_t i = 0; i < ROW; i++)
            whole[i] = level[i];
        for (uint32_t i = 0; i + 1 < ROW; i++)
            c[1][i] = c[0][i];
        whole[ROW] = ball(1.0, (struct vec3){0.0, 50.0, 0.0}, (struct vec3){0.0, 0.0, 0.0});
        contact_solver_island(level, ROW, c[0], ROW - 1);
        contact_solver_island(whole, ROW + 1, c[1], ROW - 1);
        for (uint32_t i = 0; i < ROW; i++) {
            assert_true(level[i].velocity.x == whole[i].velocity.x);
            assert_true(level[i].velocity.y == 0.0 && whole[i].velocity.y == 0.0);
            assert_true(level[i].velocity.z == whole[i].velocity.z);
            assert_true(level[i].spin.y == whole[i].spin.y);
        }
        for (uint32_t i = 0; i + 1 < ROW; i++)
            assert_true(c[0][i].lost_j == c[1][i].lost_j &&
                        vec3_length(vec3_sub(c[0][i].impulse, c[1][i].impulse)) == 0.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_head_on_impact_follows_newton),
        cmocka_unit_test(test_bodies_that_part_get_nothing),
        cmocka_unit_test(test_friction_that_grips_makes_a_ball_roll),
        cmocka_unit_test(test_friction_that_slides_ends_at_the_cone),
        cmocka_unit_test(test_without_friction_nothing_spins),
        cmocka_unit_test(test_a_glancing_hit_spins_a_body_the_right_way),
        cmocka_unit_test(test_what_is_held_stays),
        cmocka_unit_test(test_what_nothing_can_part_is_left_alone),
        cmocka_unit_test(test_a_cradle_between_its_limits),
        cmocka_unit_test(test_a_cradle_struck_one_by_one_hands_all_of_it_on),
        cmocka_unit_test(test_row_36_a_symmetric_hit_has_a_symmetric_answer),
        cmocka_unit_test(test_a_parting_contact_is_pressed_by_the_island),
        cmocka_unit_test(test_a_body_without_room_to_bounce_stops),
        cmocka_unit_test(test_a_great_pile_ends_without_anybody_nearing),
        cmocka_unit_test(test_bodies_on_the_ground_have_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
