/* Sweeps over four points at a time have the bits of sweeps over one after the other. */
#include "collider/solver/level_lanes.h"

#include "collider/solver/level_solver.h"
#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define BODIES   23 /* not whole fours */
#define CONTACTS 61
#define ROUNDS   300
#define SWEEPS   6

static struct level_lanes lanes;
static struct level_body body[BODIES];
static struct level_contact contact[CONTACTS];
/* What the plain sweeps have found. */
static double motion[BODIES][3], held[BODIES][3];

/* Some bodies are fixed, and some points bear nothing. */
static void draw(uint64_t *random)
{
    for (uint32_t i = 0; i < BODIES; i++) {
        bool fixed = i % 7 == 3;
        body[i] = (struct level_body){.inverse_mass = 1.0 / fixture_uniform(random, 5e2, 4e4),
                                      .inverse_moment = 1.0 / fixture_uniform(random, 1e3, 8e4),
                                      .grip_along = fixture_uniform(random, 0.0, 9e2),
                                      .grip_across = fixture_uniform(random, 0.0, 9e2),
                                      .grip_turn = fixture_uniform(random, 0.0, 9e2),
                                      .wanted = {fixture_uniform(random, -9.0, 9.0), 1.0, 0.1}};
        maths_sincos(fixture_uniform(random, 0.0, TWO_PI), &body[i].forward_x, &body[i].forward_z);
        if (fixed)
            body[i].inverse_mass = body[i].inverse_moment = 0.0;
        motion[i][0] = fixed ? 0.0 : body[i].wanted.x;
        motion[i][1] = fixed ? -0.0 : body[i].wanted.z;
        motion[i][2] = fixed ? 0.0 : body[i].wanted.spin;
        memset(held[i], 0, sizeof held[i]);
    }
    for (uint32_t i = 0; i < CONTACTS; i++) {
        uint32_t a = (uint32_t)(fixture_random(random) % BODIES);
        uint32_t b = (a + 1 + (uint32_t)(fixture_random(random) % (BODIES - 1))) % BODIES;
        double bears = i % 3 == 0 ? 0.0 : 2e4;
        contact[i] = (struct level_contact){.a = a,
                                            .b = b,
                                            .least_mps = fixture_uniform(random, -1.0, 0.0),
                                            .friction = fixture_uniform(random, 0.0, 1.0),
                                            .normal_ns = fixture_uniform(random, 0.0, bears),
                                            .friction_ns = fixture_uniform(random, -bears, bears),
                                            .normal_kg = fixture_uniform(random, 2e2, 9e3),
                                            .across_kg = fixture_uniform(random, 2e2, 9e3),
                                            .normal_lever_a = fixture_uniform(random, -3.0, 3.0),
                                            .normal_lever_b = fixture_uniform(random, -3.0, 3.0),
                                            .across_lever_a = fixture_uniform(random, -3.0, 3.0),
                                            .across_lever_b = fixture_uniform(random, -3.0, 3.0)};
        maths_sincos(fixture_uniform(random, 0.0, TWO_PI), &contact[i].normal_x,
                     &contact[i].normal_z);
    }
}

static void set_lanes(void)
{
    level_lanes_arrange(&lanes, BODIES, contact, CONTACTS);
    for (uint32_t i = 0; i < BODIES + 4; i++)
        lanes.motion[i] =
            i < BODIES ? (f64x4){motion[i][0], motion[i][1], motion[i][2], body[i].inverse_mass}
                       : SIMD_EVERY(0.0);
    memset(lanes.held, 0, (BODIES / 4 + 1) * sizeof *lanes.held);
    for (uint32_t i = 0; i < BODIES; i++) {
        struct level_held *of = &lanes.held[i / 4];
        of->forward_x[i % 4] = body[i].forward_x, of->forward_z[i % 4] = body[i].forward_z;
        of->inverse_mass[i % 4] = body[i].inverse_mass;
        of->inverse_moment[i % 4] = body[i].inverse_moment;
        of->grip_along[i % 4] = body[i].grip_along, of->grip_across[i % 4] = body[i].grip_across;
        of->grip_turn[i % 4] = body[i].grip_turn;
        of->wanted_x[i % 4] = body[i].wanted.x, of->wanted_z[i % 4] = body[i].wanted.z;
        of->wanted_spin[i % 4] = body[i].wanted.spin;
    }
    for (uint32_t i = 0; i < CONTACTS; i++) {
        const struct level_contact *c = &contact[i];
        struct level_four *four = &lanes.four[lanes.place[i] / 4];
        uint32_t lane = lanes.place[i] % 4;
        four->a[lane] = c->a, four->b[lane] = c->b;
        four->normal_x[lane] = c->normal_x, four->normal_z[lane] = c->normal_z;
        four->normal_lever_a[lane] = c->normal_lever_a;
        four->normal_lever_b[lane] = c->normal_lever_b;
        four->across_lever_a[lane] = c->across_lever_a;
        four->across_lever_b[lane] = c->across_lever_b;
        four->normal_kg[lane] = c->normal_kg, four->across_kg[lane] = c->across_kg;
        four->inverse_moment_a[lane] = body[c->a].inverse_moment;
        four->inverse_moment_b[lane] = body[c->b].inverse_moment;
        four->least_mps[lane] = c->least_mps, four->friction[lane] = c->friction;
        four->normal_ns[lane] = c->normal_ns, four->friction_ns[lane] = c->friction_ns;
    }
}

/* --- one after the other -----------------------------------------------------------------------*/

static void push(const struct level_contact *c, double x, double z, double turn_a, double turn_b)
{
    double *a = motion[c->a], *b = motion[c->b];
    a[0] -= x * body[c->a].inverse_mass, a[1] -= z * body[c->a].inverse_mass;
    a[2] -= turn_a * body[c->a].inverse_moment;
    b[0] += x * body[c->b].inverse_mass, b[1] += z * body[c->b].inverse_mass;
    b[2] += turn_b * body[c->b].inverse_moment;
}

static void push_normal(const struct level_contact *c, double ns)
{
    push(c, ns * c->normal_x, ns * c->normal_z, ns * c->normal_lever_a, ns * c->normal_lever_b);
}

static void push_across(const struct level_contact *c, double ns)
{
    push(c, -ns * c->normal_z, ns * c->normal_x, ns * c->across_lever_a, ns * c->across_lever_b);
}

static void begin_plainly(void)
{
    for (uint32_t i = 0; i < CONTACTS; i++) {
        struct level_contact *c = &contact[i];
        double limit = c->friction * c->normal_ns;
        c->friction_ns = maths_clamp(c->friction_ns, -limit, limit);
        if (c->normal_ns == 0.0)
            continue;
        push_normal(c, c->normal_ns);
        push_across(c, c->friction_ns);
    }
}

static double solve_plainly(struct level_contact *c, bool rough)
{
    const double *a = motion[c->a], *b = motion[c->b];
    if (rough && (c->normal_ns > 0.0 || c->friction_ns != 0.0)) {
        double limit = c->friction * c->normal_ns, before = c->friction_ns;
        double off = (b[1] - a[1]) * c->normal_x - (b[0] - a[0]) * c->normal_z +
                     b[2] * c->across_lever_b - a[2] * c->across_lever_a;
        c->friction_ns = maths_clamp(before + -off * c->across_kg, -limit, limit);
        push_across(c, c->friction_ns - before);
    }
    double before = c->normal_ns;
    double off = c->least_mps - ((b[0] - a[0]) * c->normal_x + (b[1] - a[1]) * c->normal_z +
                                 b[2] * c->normal_lever_b - a[2] * c->normal_lever_a);
    c->normal_ns = maths_clamp(before + off * c->normal_kg, 0.0, INFINITY);
    if (c->normal_ns == before)
        return 0.0;
    push_normal(c, c->normal_ns - before);
    return fabs(c->normal_ns - before) / c->normal_kg;
}

static double sweep_plainly(bool backwards, bool rough)
{
    double change = 0.0;
    for (uint32_t n = 0; n < CONTACTS; n++)
        change =
            maths_max(change, solve_plainly(&contact[backwards ? CONTACTS - 1 - n : n], rough));
    return change;
}

static double within(double *sum, double step, double limit)
{
    double before = *sum;
    *sum = maths_clamp(before + step, -limit, limit);
    return *sum - before;
}

static void hold_plainly(void)
{
    for (uint32_t i = 0; i < BODIES; i++) {
        const struct level_body *of = &body[i];
        double *now = motion[i], fx = of->forward_x, fz = of->forward_z;
        double x = now[0] - of->wanted.x, z = now[1] - of->wanted.z;
        if (of->inverse_mass == 0.0)
            continue;
        double along = within(&held[i][0], -(x * fx + z * fz) / of->inverse_mass, of->grip_along);
        double across = within(&held[i][1], -(z * fx - x * fz) / of->inverse_mass, of->grip_across);
        now[0] += (along * fx - across * fz) * of->inverse_mass;
        now[1] += (along * fz + across * fx) * of->inverse_mass;
        now[2] +=
            within(&held[i][2], -(now[2] - of->wanted.spin) / of->inverse_moment, of->grip_turn) *
            of->inverse_moment;
    }
}

/* --- tests -------------------------------------------------------------------------------------*/

static bool same_bits(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static void assert_same(void)
{
    for (uint32_t i = 0; i < BODIES; i++) {
        for (uint32_t k = 0; k < 3; k++)
            assert_true(same_bits(lanes.motion[i][k], motion[i][k]));
    }
    for (uint32_t i = 0; i < CONTACTS; i++) {
        const struct level_four *four = &lanes.four[lanes.place[i] / 4];
        assert_true(same_bits(four->normal_ns[lanes.place[i] % 4], contact[i].normal_ns));
        assert_true(same_bits(four->friction_ns[lanes.place[i] % 4], contact[i].friction_ns));
    }
}

static void test_lanes_have_the_bits_of_single_points(void **state)
{
    uint64_t random = fixture_seed(133);
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        bool rough = round % 3 != 0;
        draw(&random);
        set_lanes();
        assert_true(level_lanes_begin(&lanes));
        begin_plainly();
        assert_same();
        for (int sweep = 0; sweep < SWEEPS; sweep++) {
            bool backwards = sweep % 2 != 0;
            level_lanes_hold(&lanes);
            hold_plainly();
            double change = rough ? level_lanes_sweep(&lanes, backwards)
                                  : level_lanes_sweep_smooth(&lanes, backwards);
            assert_true(same_bits(change, sweep_plainly(backwards, rough)));
            assert_same();
        }
    }
}

/* Else a four would give a body the impulse of one of its points only. */
static void test_no_four_has_a_body_twice(void **state)
{
    uint64_t random = fixture_seed(134);
    uint32_t lane_count = 0;
    (void)state;
    draw(&random);
    set_lanes();
    for (uint32_t n = 0; n < lanes.fours; n++) {
        uint32_t seen[BODIES + 1] = {0};
        for (uint32_t lane = 0; lane < 4; lane++) {
            seen[lanes.four[n].a[lane]]++;
            seen[lanes.four[n].b[lane]]++;
        }
        for (uint32_t i = 0; i < BODIES; i++) {
            assert_true(seen[i] <= 1);
            lane_count += seen[i];
        }
    }
    assert_int_equal(lane_count, 2 * CONTACTS);
}

static void test_nothing_begins_without_an_impulse(void **state)
{
    uint64_t random = fixture_seed(135);
    (void)state;
    draw(&random);
    for (uint32_t i = 0; i < CONTACTS; i++)
        contact[i].normal_ns = 0.0;
    set_lanes();
    assert_false(level_lanes_begin(&lanes));
}

static int open_lanes(void **state)
{
    (void)state;
    return level_lanes_init(&lanes, BODIES, CONTACTS / 2); /* so that they grow */
}

static int close_lanes(void **state)
{
    (void)state;
    level_lanes_free(&lanes);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lanes_have_the_bits_of_single_points),
        cmocka_unit_test(test_no_four_has_a_body_twice),
        cmocka_unit_test(test_nothing_begins_without_an_impulse),
    };
    return cmocka_run_group_tests(tests, open_lanes, close_lanes);
}
