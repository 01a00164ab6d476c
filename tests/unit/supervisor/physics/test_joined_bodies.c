/* Bodies that touch: what happens to one of them explains a way of the others (row 46). */
#include "supervisor/physics/joined_bodies.h"

#include "supervisor/physics/body_measures.h"
#include "supervisor/physics/surface.h"
#include "world/entity/kind.h"
#include "world/terrain/terrain.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define BODIES 4
#define DT_S   (1.0 / 60.0)

static struct kind kind;
static struct motion_look was;
static struct body_look body[BODIES];
static struct measures measures;

/* Wrecks in the air that have not moved. */
static int bodies_at_rest(void **state)
{
    const struct rigid_pose pose = rigid_pose_of((struct vec3){0.0, 100.0, 0.0}, 0.0, 0.0, 0.0);
    (void)state;
    kind = (struct kind){.domain = DOMAIN_AIR, .max_speed_mps = 50.0, .bound_m = 3.0};
    was = (struct motion_look){.pose = pose, .wreck = true};
    measures = (struct measures){.frame = 1};
    for (uint32_t i = 0; i < BODIES; i++)
        body[i] = (struct body_look){.row = i,
                                     .named = {i + 1, false, 0, pose.at},
                                     .kind = &kind,
                                     .now = was,
                                     .was = &was,
                                     .known = true,
                                     .finite = true};
    return 0;
}

static void find(struct neighbour_pair *pair, uint32_t count)
{
    struct body_looks looks = {.body = body, .count = BODIES};
    const struct neighbour_pairs touching = {.pair = pair, .count = count};
    joined_bodies_find(&looks, &touching);
}

static void measure_motion(double dt_s, struct body_look *one)
{
    const struct terrain terrain = {.squares = {.world_m = 1000.0}};
    const struct surface surface = {.terrain = &terrain};
    const struct ground_look ground = {.surface = &surface, .dt_s = dt_s};
    body_measures_motion(&measures, &ground, one);
}

static double jump_of(uint32_t index, double way_m)
{
    measures = (struct measures){.frame = 1};
    body[index].named.at.x = body[index].now.pose.at.x = way_m;
    measure_motion(DT_S, &body[index]);
    return measures.of[MEASURE_OF_JUMP].worst;
}

/* Gravity and the ground change a speed more within a longer frame. */
static void test_a_way_beyond_the_speed_counts_for_a_sixtieth_of_a_second(void **state)
{
    (void)state;
    find(NULL, 0);
    measures = (struct measures){.frame = 1};
    body[0].named.at.x = body[0].now.pose.at.x = 0.03;
    measure_motion(0.1, &body[0]);
    assert_true(fabs(measures.of[MEASURE_OF_JUMP].worst - 0.005) < 1e-12);
    measures = (struct measures){.frame = 1};
    measure_motion(1.0 / 60.0, &body[0]);
    assert_true(fabs(measures.of[MEASURE_OF_JUMP].worst - 0.03) < 1e-12);
}

static void test_groups_are_joined_and_summed(void **state)
{
    struct neighbour_pair pair[] = {{3, 2}, {0, 2}};
    (void)state;
    body[0].struck = 1, body[0].hits = 2, body[2].hits = 1, body[3].struck = 4;
    body[1].parted = 1;
    body[3].now.velocity.z = -7.0;
    find(pair, 2);
    for (uint32_t i = 0; i < BODIES; i++) {
        assert_int_equal(body[i].together.first, i == 1 ? 1 : 0);
        assert_int_equal(body[i].together.impacts, i == 1 ? 0 : 7);
        assert_true(body[i].together.fastest_mps == (i == 1 ? 0.0 : 7.0));
        assert_int_equal(body[i].together.parts, i == 1);
    }
}

static void test_a_body_beside_others_that_part_is_pushed_aside(void **state)
{
    struct neighbour_pair pair[] = {{0, 1}, {1, 2}};
    (void)state;
    body[2].parts = 1;
    find(pair, 2);
    assert_true(jump_of(0, 0.3) == 0.0);
    assert_true(jump_of(0, 0.4) > 0.05);
    find(pair, 1);
    assert_true(fabs(jump_of(0, 0.3) - 0.3) < 1e-12);
}

static void test_impacts_are_passed_on(void **state)
{
    struct neighbour_pair pair[] = {{0, 1}};
    (void)state;
    body[1].now.velocity.x = 6.0;
    body[0].hits = 1, body[1].hits = 2;
    find(pair, 1);
    assert_true(jump_of(0, 0.19) == 0.0);
    assert_true(jump_of(0, 0.25) > 0.04);
    body[1].hits = 1; /* one impact of the two */
    find(pair, 1);
    assert_true(fabs(jump_of(0, 0.19) - 0.19) < 1e-12);
}

/* A body is struck, and strikes the next one, against which it leans: slowly, so no impact. */
static void test_an_impact_is_passed_on_to_what_the_body_leans_on(void **state)
{
    struct neighbour_pair pair[] = {{0, 1}, {1, 2}};
    (void)state;
    body[1].now.velocity.x = 6.0;
    body[0].hits = body[1].hits = 1;
    body[0].presses = body[1].presses = 1;
    find(pair, 2);
    assert_true(fabs(jump_of(0, 0.19) - 0.19) < 1e-12);
    body[1].presses = 2, body[2].presses = 1;
    find(pair, 2);
    assert_true(jump_of(0, 0.19) == 0.0);
    body[0].hits = body[1].hits = 0;
    find(pair, 2);
    assert_true(fabs(jump_of(0, 0.19) - 0.19) < 1e-12);
}

/* Returns the worst spin that was taken, or 0. */
static double spin_of(double spin_rps)
{
    measures = (struct measures){.frame = 1};
    body[0].now.spin.y = spin_rps;
    measure_motion(DT_S, &body[0]);
    return measures.of[MEASURE_OF_SPIN].worst;
}

static void test_a_body_that_an_explosion_spins_is_left_out_until_it_is_slow(void **state)
{
    (void)state;
    find(NULL, 0);
    assert_true(spin_of(30.0) == 30.0);
    body[0].blasts = 1;
    assert_true(spin_of(30.0) == 0.0);
    body[0].blasts = 0;
    assert_true(spin_of(29.0) == 0.0);
    assert_true(spin_of(19.0) == 0.0);
    assert_true(spin_of(9.0) == 9.0);
    assert_true(spin_of(21.0) == 21.0);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup(name, bodies_at_rest)
    const struct CMUnitTest tests[] = {
        TEST(test_a_way_beyond_the_speed_counts_for_a_sixtieth_of_a_second),
        TEST(test_groups_are_joined_and_summed),
        TEST(test_a_body_beside_others_that_part_is_pushed_aside),
        TEST(test_impacts_are_passed_on),
        TEST(test_an_impact_is_passed_on_to_what_the_body_leans_on),
        TEST(test_a_body_that_an_explosion_spins_is_left_out_until_it_is_slow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
