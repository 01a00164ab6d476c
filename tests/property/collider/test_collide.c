/* Whole frames with impulses: momentum is conserved, energy never grows, bodies end apart, and
 * their order does not matter (thesis rows 39, 43, 46). SEED=n runs another set. */
#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

/* --- impulses ----------------------------------------------------------------------------------*/

#define IMPACTS 500

/* Two kinds of random mass and restitution that no impact destroys. */
static void draw_kinds(const struct fixture *f, uint64_t *random)
{
    static const char *const names[] = {"helicopter", "jet"};
    for (int i = 0; i < 2; i++) {
        struct kind *kind = steps_kind(f, names[i]);
        double power = fixture_uniform(random, -1.0, 6.0);
        kind->mass_kg = 1.0;
        for (; power > 0.0; power -= 1.0)
            kind->mass_kg *= power > 1.0 ? 10.0 : 1.0 + 9.0 * power;
        kind->restitution = fixture_random(random) % 4 == 0 ? 1.0 : fixture_uniform(random, 0, 1);
        kind->resistance_j = 1e300;
        kind->explosive_kg = 0.0;
    }
}

static struct vec3 draw_vector(uint64_t *random, double most)
{
    return (struct vec3){fixture_uniform(random, -most, most), fixture_uniform(random, -most, most),
                         fixture_uniform(random, -most, most)};
}

struct impact_pair {
    struct fixture_entity first, second;
};

/* Two aircraft that meet within the first frame. */
static struct impact_pair draw_impact(double dt_s, double reach, uint64_t *random)
{
    struct vec3 va = draw_vector(random, 400.0), vb = draw_vector(random, 400.0);
    double time = dt_s * fixture_uniform(random, 0.1, 0.9);
    struct vec3 apart = draw_vector(random, 1.0);
    struct vec3 meet = {25000.0 + fixture_uniform(random, -20000, 20000), 3000.0,
                        25000.0 + fixture_uniform(random, -20000, 20000)};
    apart = vec3_scale(apart, reach / maths_max(vec3_length(apart), 1e-3));
    double parting = vec3_dot(apart, vec3_sub(vb, va));
    if (fabs(parting) < 0.02 * reach * vec3_length(vec3_sub(vb, va)))
        return draw_impact(dt_s, reach, random); /* a graze may be one or not */
    if (parting > 0.0)                           /* they approach when they touch */
        apart = vec3_scale(apart, -1.0);
    return (struct impact_pair){
        {.kind = "helicopter", .at = vec3_sub(meet, vec3_scale(va, time)), .velocity = va},
        {.kind = "jet",
         .at = vec3_sub(vec3_add(meet, apart), vec3_scale(vb, time)),
         .velocity = vb}};
}

struct sums {
    struct vec3 momentum, angular; /* [N s]; [N m s] about middle */
    double energy, scale;          /* [J]; [N s] sum of sizes */
};

static const struct vec3 middle = {25000.0, 3000.0, 25000.0};

/* Angular momentum of a row's own rotation, and its energy. */
static struct vec3 rotation_path_of(const struct fixture *f, uint32_t row, double *energy)
{
    struct entities e = steps_rows(f);
    const struct mass_properties inertia =
        mass_properties_of(&f->view.world.kinds[e.row[row].kind]);
    struct mat3 turn =
        rotation_matrix(rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
    struct vec3 spin = rotation_back(
        &turn, (struct vec3){e.row[row].spin_x, e.row[row].spin_y, e.row[row].spin_z});
    const struct vec3 body = {inertia.moment.x * spin.x, inertia.moment.y * spin.y,
                              inertia.moment.z * spin.z};
    *energy += 0.5 * vec3_dot(body, spin);
    return rotation_apply(&turn, body);
}

static struct sums motion_of(const struct fixture *f)
{
    struct entities e = steps_rows(f);
    struct sums motion = {.scale = 0.0};
    for (uint32_t i = 0; i < 2; i++) {
        double mass = f->view.world.kinds[e.row[i].kind].mass_kg;
        struct vec3 v = entities_velocity(&e, i);
        motion.momentum = vec3_add(motion.momentum, vec3_scale(v, mass));
        motion.energy += 0.5 * mass * vec3_dot(v, v);
        motion.scale += mass * vec3_length(v);
        struct vec3 arm = vec3_sub(entities_position(&e, i), middle);
        motion.angular = vec3_add(motion.angular, vec3_cross(arm, vec3_scale(v, mass)));
        motion.angular = vec3_add(motion.angular, rotation_path_of(f, i, &motion.energy));
    }
    return motion;
}

static void put_pair(struct fixture *f, const struct impact_pair *pair, bool swapped)
{
    steps_empty(f);
    fixture_put(f, swapped ? pair->second : pair->first);
    fixture_put(f, swapped ? pair->first : pair->second);
}

static double difference(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

static void test_rows_39_43_46_impulses_keep_momentum_and_never_add_energy(void **state)
{
    int turned = 0;
    uint64_t random = fixture_seed(43);
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    for (int n = 0; n < IMPACTS; n++) {
        draw_kinds(&f, &random);
        double reach = 13.0; /* helicopter 6 and jet 7 */
        struct impact_pair pair = draw_impact(1.0 / 60.0, reach, &random);
        put_pair(&f, &pair, false);
        struct sums before = motion_of(&f);
        fixture_run(&f, 1);
        struct sums after = motion_of(&f);
        struct entities e = steps_rows(&f);
        assert_int_equal(fixture_event_count(&f, EVENT_COLLISION), 1);
        assert_true(difference(before.momentum, after.momentum) <= 1e-12 * before.scale);
        /* Rows 39, 43: about a point some 20 km from the collision. */
        assert_true(difference(before.angular, after.angular) <= 1e-9 * 20000.0 * before.scale);
        turned += fabs(e.row[0].spin_x) + fabs(e.row[0].spin_y) + fabs(e.row[0].spin_z) > 0.01;
        assert_true(after.energy <= before.energy * (1.0 + 1e-12));
        /* Row 46: they are apart, to the nanometre, when the frame ends. */
        assert_true(difference(entities_position(&e, 0), entities_position(&e, 1)) >= reach - 1e-9);
    }
    assert_true(turned > IMPACTS / 2);
    fixture_close(&f);
}

static void test_impulses_do_not_depend_on_the_order_of_bodies(void **state)
{
    uint64_t random = fixture_seed(44);
    struct fixture f;
    (void)state;
    fixture_open(&f, "");
    for (int n = 0; n < IMPACTS; n++) {
        struct vec3 velocity[2][2], position[2][2];
        double harm[2][2], brought = 0.0;
        draw_kinds(&f, &random);
        struct impact_pair pair = draw_impact(1.0 / 60.0, 13.0, &random);
        for (int swapped = 0; swapped < 2; swapped++) {
            put_pair(&f, &pair, swapped);
            brought = motion_of(&f).energy;
            fixture_run(&f, 1);
            struct entities e = steps_rows(&f);
            for (uint32_t i = 0; i < 2; i++) {
                velocity[swapped][i] = entities_velocity(&e, i ^ (uint32_t)swapped);
                position[swapped][i] = entities_position(&e, i ^ (uint32_t)swapped);
                harm[swapped][i] = e.row[i ^ (uint32_t)swapped].harm_j;
            }
        }
        for (int i = 0; i < 2; i++) {
            assert_true(difference(velocity[0][i], velocity[1][i]) < 1e-6);
            assert_true(difference(position[0][i], position[1][i]) < 1e-9);
            /* What is lost is a difference of what they bring and keep. */
            assert_true(fabs(harm[0][i] - harm[1][i]) <= 1e-9 * harm[0][i] + 1e-12 * brought);
        }
    }
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_39_43_46_impulses_keep_momentum_and_never_add_energy),
        cmocka_unit_test(test_impulses_do_not_depend_on_the_order_of_bodies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
