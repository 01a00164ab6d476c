/* Bodies that are shifted out of each other keep their momentum and gain no energy. */
#include "collider/solver/overlap_shift.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define BODIES 3

static const double moments[BODIES][3] = {{2e4, 5e4, 4e4}, {9e4, 2e5, 1.5e5}, {1e3, 3e3, 2.5e3}};
static const double masses_kg[BODIES] = {6500.0, 14000.0, 900.0};

struct sums {
    struct vec3 momentum, angular;
    double energy;
};

static struct sums sums_of(const struct solver_body *bodies)
{
    struct sums sums = {.energy = 0.0};
    for (int i = 0; i < BODIES; i++) {
        const struct solver_body *b = &bodies[i];
        struct vec3 momentum = vec3_scale(b->velocity, masses_kg[i]), spin = b->spin;
        struct vec3 own = {moments[i][0] * spin.x, moments[i][1] * spin.y, moments[i][2] * spin.z};
        sums.momentum = vec3_add(sums.momentum, momentum);
        sums.angular = vec3_add(sums.angular, vec3_add(vec3_cross(b->centre, momentum), own));
        sums.energy += 0.5 * (vec3_dot(momentum, b->velocity) + vec3_dot(own, spin));
    }
    return sums;
}

static struct vec3 draw(uint64_t *random, double most)
{
    return (struct vec3){fixture_uniform(random, -most, most), fixture_uniform(random, -most, most),
                         fixture_uniform(random, -most, most)};
}

/* The last body's shift leaves the common centre where it is. */
static void draw_bodies(struct solver_body *bodies, struct vec3 *shift, uint64_t *random)
{
    struct vec3 moved = {0.0, 0.0, 0.0};
    for (int i = 0; i < BODIES; i++) {
        double light = 1.0 / masses_kg[i];
        bodies[i] = (struct solver_body){.inverse_mass = {light, light, light},
                                         .centre = draw(random, 20.0),
                                         .velocity = draw(random, 60.0),
                                         .spin = draw(random, 10.0)};
        for (int axis = 0; axis < 3; axis++)
            bodies[i].inverse_inertia.m[axis][axis] = 1.0 / moments[i][axis];
        shift[i] = i < BODIES - 1 ? draw(random, 0.01) : vec3_scale(moved, -light);
        moved = vec3_add(moved, vec3_scale(shift[i], masses_kg[i]));
    }
}

static void test_a_shift_conserves_momentum_and_adds_no_energy(void **state)
{
    uint64_t random = fixture_seed(3946);
    (void)state;
    for (int n = 0; n < 1000; n++) {
        struct solver_body bodies[BODIES];
        struct vec3 shift[BODIES], at[BODIES];
        draw_bodies(bodies, shift, &random);
        for (int i = 0; i < BODIES; i++)
            at[i] = vec3_add(bodies[i].centre, shift[i]);
        struct sums before = sums_of(bodies);
        assert_true(overlap_shift_free(bodies, shift, BODIES));
        struct sums after = sums_of(bodies);
        for (int i = 0; i < BODIES; i++)
            assert_memory_equal(&bodies[i].centre, &at[i], sizeof at[i]);
        assert_true(vec3_length(vec3_sub(after.momentum, before.momentum)) < 1e-12 * 2e6);
        assert_true(vec3_length(vec3_sub(after.angular, before.angular)) < 1e-12 * 2e7);
        assert_true(after.energy <= before.energy * (1.0 + 1e-12));
        assert_true(after.energy >= before.energy * (1.0 - 0.05));
    }
}

/* One rigid body that turns: pulling it in would make it faster. */
static void test_what_would_need_energy_stays_as_it_is(void **state)
{
    uint64_t random = fixture_seed(3947);
    struct solver_body bodies[BODIES];
    struct vec3 shift[BODIES], at[BODIES];
    const struct vec3 spin = {0.0, 2.0, 0.0};
    (void)state;
    draw_bodies(bodies, shift, &random);
    for (int i = 0; i < BODIES; i++) {
        bodies[i].centre = (struct vec3){5.0 * (i == 0) - 5.0 * 6.5 / 14.0 * (i == 1), 0.0, 0.0};
        bodies[i].spin = spin;
        bodies[i].velocity = vec3_cross(spin, bodies[i].centre);
        at[i] = bodies[i].centre;
        shift[i] = vec3_scale(bodies[i].centre, -0.01);
    }
    struct sums before = sums_of(bodies);
    assert_false(overlap_shift_free(bodies, shift, BODIES));
    for (int i = 0; i < BODIES; i++)
        assert_true(vec3_length(vec3_sub(bodies[i].centre, at[i])) < 1e-12);
    assert_true(fabs(sums_of(bodies).energy - before.energy) <= 1e-12 * before.energy);
    for (int i = 0; i < BODIES; i++)
        shift[i] = vec3_scale(shift[i], -1.0); /* the other way it becomes slower */
    assert_true(overlap_shift_free(bodies, shift, BODIES));
    assert_true(bodies[0].spin.y < 2.0 && sums_of(bodies).energy < before.energy);
}

static void test_bodies_at_rest_are_shifted_only(void **state)
{
    uint64_t random = fixture_seed(3948);
    struct solver_body bodies[BODIES];
    struct vec3 shift[BODIES];
    (void)state;
    draw_bodies(bodies, shift, &random);
    for (int i = 0; i < BODIES; i++)
        bodies[i].velocity = bodies[i].spin = (struct vec3){0.0, 0.0, 0.0};
    assert_true(overlap_shift_free(bodies, shift, BODIES));
    assert_true(sums_of(bodies).energy == 0.0);
}

/* Returns the angular momentum about the common centre of mass. */
static struct vec3 about_centre(const struct solver_body *bodies)
{
    struct sums sums = sums_of(bodies);
    struct vec3 centre = {0.0, 0.0, 0.0};
    double kg = 0.0;
    for (int i = 0; i < BODIES; i++) {
        kg += masses_kg[i];
        centre = vec3_add(centre, vec3_scale(bodies[i].centre, masses_kg[i]));
    }
    return vec3_sub(sums.angular, vec3_cross(vec3_scale(centre, 1.0 / kg), sums.momentum));
}

/* Bodies that were put back elsewhere, and lost some of their motion on the way. */
static void test_momenta_are_restored_elsewhere(void **state)
{
    uint64_t random = fixture_seed(3949);
    double least = 1.0;
    (void)state;
    for (int n = 0; n < 1000; n++) {
        struct solver_body before[BODIES], bodies[BODIES];
        struct vec3 shift[BODIES], at[BODIES];
        draw_bodies(before, shift, &random);
        for (int i = 0; i < BODIES; i++) {
            bodies[i] = before[i];
            at[i] = bodies[i].centre = vec3_add(bodies[i].centre, draw(&random, 0.1));
            bodies[i].velocity = vec3_add(bodies[i].velocity, draw(&random, 1.0));
            bodies[i].spin = vec3_scale(bodies[i].spin, 0.9);
        }
        struct sums was = sums_of(before);
        assert_true(overlap_shift_restore(before, bodies, BODIES));
        struct sums now = sums_of(bodies);
        for (int i = 0; i < BODIES; i++)
            assert_memory_equal(&bodies[i].centre, &at[i], sizeof at[i]);
        assert_true(vec3_length(vec3_sub(now.momentum, was.momentum)) < 1e-12 * 2e6);
        assert_true(vec3_length(vec3_sub(about_centre(bodies), about_centre(before))) <
                    1e-12 * 2e7);
        assert_true(now.energy <= was.energy * (1.0 + 1e-12));
        least = maths_min(least, now.energy / was.energy);
    }
    assert_true(least > 0.8); /* what moves relative to the others goes on */
}

static void test_what_would_need_energy_elsewhere_is_not_restored(void **state)
{
    uint64_t random = fixture_seed(3950);
    struct solver_body before[BODIES], bodies[BODIES], kept[BODIES];
    struct vec3 shift[BODIES];
    const struct vec3 spin = {0.0, 2.0, 0.0};
    (void)state;
    draw_bodies(before, shift, &random);
    for (int i = 0; i < BODIES; i++) { /* one rigid body that turns, and is pulled in */
        before[i].centre = (struct vec3){5.0 * (i == 0) - 5.0 * 6.5 / 14.0 * (i == 1), 0.0, 0.0};
        before[i].spin = spin;
        before[i].velocity = vec3_cross(spin, before[i].centre);
        bodies[i] = before[i];
        bodies[i].centre = vec3_scale(before[i].centre, 0.99);
        kept[i] = bodies[i];
    }
    assert_false(overlap_shift_restore(before, bodies, BODIES));
    assert_memory_equal(bodies, kept, sizeof kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_shift_conserves_momentum_and_adds_no_energy),
        cmocka_unit_test(test_what_would_need_energy_stays_as_it_is),
        cmocka_unit_test(test_bodies_at_rest_are_shifted_only),
        cmocka_unit_test(test_momenta_are_restored_elsewhere),
        cmocka_unit_test(test_what_would_need_energy_elsewhere_is_not_restored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
