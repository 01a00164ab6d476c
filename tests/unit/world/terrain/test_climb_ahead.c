/* The climb and the speed that the ground ahead asks for: on the level, before a wall, at its foot,
 * over a crest, across a slope, and on a way that turns; and those that a tree asks for. */
#include "world/terrain/climb_ahead.h"

#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/terrain/fixed_index.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define SIDE      401
#define SPACING_M 10.0
#define MIDDLE_M  2000.0

static float posts[SIDE * SIDE];
static struct terrain ground = {
    .posts = posts, .side = SIDE, .spacing_m = SPACING_M, .squares = GRIDSQUARES_DEFAULT_INIT};

/* Level up to the middle, then rising to the east. */
static void raise(double slope, double most_m)
{
    for (uint32_t row = 0; row < SIDE; row++)
        for (uint32_t column = 0; column < SIDE; column++)
            posts[row * SIDE + column] =
                (float)maths_clamp(slope * (column * SPACING_M - MIDDLE_M), 0.0, most_m);
}

/* Flies east at 10 m, before_m before the middle. */
static struct climb_ahead fly(double before_m, double speed_mps)
{
    return (struct climb_ahead){.at = {MIDDLE_M - before_m, 10.0, 2000.0},
                                .speed_mps = speed_mps,
                                .half_length_m = 7.0,
                                .half_width_m = 6.0,
                                .climb_mps = 10.0,
                                .pull_mps2 = 4.0,
                                .brake_mps2 = 4.0,
                                .late_s = 1.0,
                                .heading_rad = HALF_PI,
                                .radius_m = 50.0,
                                .length_m = 600.0,
                                .clear_m = 5.0,
                                .least_m = 4.0};
}

static void test_level_ground_asks_for_nothing(void **state)
{
    (void)state;
    raise(0.0, 0.0);
    struct climb_ahead ahead = fly(0.0, 60.0);
    struct climb_need need = climb_ahead_need(&ground, &ahead);
    assert_true(need.climb_mps < 0.0 && isinf(need.speed_mps));
}

/* It does not end its descent by the pull that it has. */
static void test_a_descent_has_to_end_in_time(void **state)
{
    (void)state;
    raise(0.0, 0.0);
    struct climb_ahead ahead = fly(0.0, 60.0);
    ahead.up_mps = -3.0;
    struct climb_need slow = climb_ahead_need(&ground, &ahead);
    ahead.up_mps = -12.0;
    struct climb_need fast = climb_ahead_need(&ground, &ahead);
    assert_true(slow.climb_mps < 0.0 && isinf(slow.speed_mps));
    assert_true(fast.climb_mps > 0.0 && fast.speed_mps < 60.0);
}

/* The speed that it allows is one from which it climbs over the wall if it brakes all the way. */
static void test_a_wall_is_climbed_or_waited_for(void **state)
{
    (void)state;
    raise(5.0, 100.0);
    struct climb_ahead far = fly(500.0, 60.0), near = fly(100.0, 60.0), there = fly(8.0, 1.0);
    struct climb_need need = climb_ahead_need(&ground, &far);
    print_message("500 m before 100 m: %.1f m/s up, %.1f m/s\n", need.climb_mps, need.speed_mps);
    assert_true(need.climb_mps > 9.0 && need.speed_mps > 50.0);
    need = climb_ahead_need(&ground, &near);
    print_message("100 m before it: %.1f m/s\n", need.speed_mps);
    assert_true(need.climb_mps > 20.0);
    assert_true(need.speed_mps > 10.0 && need.speed_mps < sqrt(2.0 * 4.0 * 100.0));
    need = climb_ahead_need(&ground, &there);
    assert_true(need.speed_mps < 6.0);
    there.at.y = 110.0;
    assert_true(isinf(climb_ahead_need(&ground, &there).speed_mps));
}

/* Its tail has passed the crest last. */
static void test_what_is_under_its_tail_counts(void **state)
{
    (void)state;
    raise(5.0, 100.0);
    struct climb_ahead ahead = fly(3.0, 20.0);
    ahead.heading_rad = 1.5 * PI;
    assert_true(climb_ahead_need(&ground, &ahead).climb_mps > 5.0);
    ahead.at.x -= 20.0;
    assert_true(climb_ahead_need(&ground, &ahead).climb_mps < 0.0);
}

static void test_a_slope_rises_to_the_side(void **state)
{
    (void)state;
    raise(1.0, 1000.0);
    struct climb_ahead ahead = fly(-100.0, 20.0);
    ahead.heading_rad = 0.0;
    ahead.at.y = 100.0 + 10.5; /* 5 m over the ground 6 m to the right would be 111 m */
    assert_true(climb_ahead_need(&ground, &ahead).climb_mps > 0.0);
    ahead.at.y = 100.0 + 11.5;
    assert_true(climb_ahead_need(&ground, &ahead).climb_mps < 0.0);
}

/* A turn to the north does not reach the wall, a wider one does. */
static void test_the_way_may_turn_before_a_wall(void **state)
{
    (void)state;
    raise(5.0, 100.0);
    struct climb_ahead ahead = fly(150.0, 40.0);
    ahead.off_rad = -HALF_PI;
    assert_true(isinf(climb_ahead_need(&ground, &ahead).speed_mps));
    ahead.radius_m = 200.0;
    assert_true(climb_ahead_need(&ground, &ahead).speed_mps < 40.0);
    ahead.radius_m = 50.0;
    ahead.off_rad = 0.0;
    assert_true(climb_ahead_need(&ground, &ahead).speed_mps < 40.0);
}

static void test_the_change_of_climb_makes_up_for_its_delay(void **state)
{
    (void)state;
    double change = climb_ahead_change(-10.0, 5.0, 4.0, 20.0);
    /* The pull takes change / 4 seconds, and the rest of 20 s is flown with the new rate. */
    double pulling = change / 4.0;
    double height = -10.0 * pulling + 0.5 * change * pulling + (20.0 - pulling) * (change - 10.0);
    assert_true(fabs(height - 5.0 * 20.0) < 1e-9);
    assert_true(climb_ahead_change(10.0, 5.0, 4.0, 20.0) == -5.0);
    assert_true(climb_ahead_change(-10.0, 5.0, 4.0, 1.0) == 30.0); /* there is no time for it */
}

/* A tree of 15 m with a radius of 4 m, beside the middle. */
struct lone_tree {
    struct fixed_object tree;
    struct kind kind;
    uint8_t damage;
    uint32_t *start, *items;
    struct climb_objects objects;
};

static void plant(struct lone_tree *lone, double south_m)
{
    raise(0.0, 0.0);
    *lone = (struct lone_tree){
        .tree = {.x = MIDDLE_M, .z = 2000.0 + south_m, .radius_m = 4.0f, .height_m = 15.0f},
        .kind = {.radius_m = 4.0}};
    assert_int_equal(
        fixed_index_build(&ground.squares, &lone->tree, 1, &lone->kind, &lone->start, &lone->items),
        0);
    lone->objects =
        (struct climb_objects){&lone->tree, lone->start, lone->items, &lone->kind, &lone->damage};
}

static struct climb_need need_before(const struct lone_tree *lone, struct climb_ahead ahead)
{
    ahead.objects = &lone->objects;
    return climb_ahead_need(&ground, &ahead);
}

static void cut(struct lone_tree *lone)
{
    free(lone->start);
    free(lone->items);
}

static void test_a_tree_is_climbed_or_waited_for(void **state)
{
    struct lone_tree lone;
    (void)state;
    plant(&lone, 5.0);
    struct climb_need need = need_before(&lone, fly(500.0, 60.0));
    assert_true(need.climb_mps > 0.5 && need.climb_mps < 5.0 && need.speed_mps > 60.0);
    need = need_before(&lone, fly(60.0, 60.0));
    assert_true(need.climb_mps > 10.0 && need.speed_mps < 40.0);
    assert_true(need_before(&lone, fly(-100.0, 60.0)).climb_mps < 0.0); /* it is past the tree */
    struct climb_ahead high = fly(60.0, 60.0);
    high.at.y = 22.0;
    assert_true(need_before(&lone, high).climb_mps < 0.0);
    lone.damage = DAMAGE_HIGH; /* the tree lies on the ground */
    assert_true(need_before(&lone, fly(60.0, 60.0)).climb_mps < 0.0);
    cut(&lone);
}

/* It minds what its way comes near to, and what it touches when it turns where it is. */
static void test_a_tree_beside_the_way_is_passed(void **state)
{
    struct lone_tree lone;
    (void)state;
    plant(&lone, 16.5);
    assert_true(need_before(&lone, fly(60.0, 60.0)).climb_mps < 0.0);
    assert_true(need_before(&lone, fly(200.0, 60.0)).climb_mps > 0.0); /* ways are not held */
    struct climb_ahead turning = fly(100.0, 20.0);
    turning.off_rad = HALF_PI;
    turning.radius_m = 100.0;
    assert_true(need_before(&lone, turning).climb_mps < 0.0);
    cut(&lone);
    plant(&lone, 12.5);
    struct climb_ahead stands = fly(0.0, 0.0);
    stands.heading_rad = 0.0; /* the tree is behind its tail */
    stands.half_length_m = 6.0;
    assert_true(need_before(&lone, stands).climb_mps < 0.0);
    stands.half_length_m = 7.0;
    assert_true(need_before(&lone, stands).climb_mps > 0.0);
    assert_true(need_before(&lone, stands).speed_mps == 0.0);
    cut(&lone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_level_ground_asks_for_nothing),
        cmocka_unit_test(test_a_descent_has_to_end_in_time),
        cmocka_unit_test(test_a_wall_is_climbed_or_waited_for),
        cmocka_unit_test(test_what_is_under_its_tail_counts),
        cmocka_unit_test(test_a_slope_rises_to_the_side),
        cmocka_unit_test(test_the_way_may_turn_before_a_wall),
        cmocka_unit_test(test_a_tree_is_climbed_or_waited_for),
        cmocka_unit_test(test_a_tree_beside_the_way_is_passed),
        cmocka_unit_test(test_the_change_of_climb_makes_up_for_its_delay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
