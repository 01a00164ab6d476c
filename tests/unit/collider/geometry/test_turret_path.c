/* Where parts of a turret lie, how they move, and the bounds of their motion. */
#include "collider/geometry/turret_path.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define NEAR_M 1e-12

static const struct hull parts[HULL_PART_COUNT] = {
    {.part = HULL_PART_BODY}, {.part = HULL_PART_TURRET}, {.part = HULL_PART_GUN}};

static struct turret_path path_of(double turret, double gun, double turret_turn, double gun_turn)
{
    struct turret_path path = {.outer = parts,
                               .outers = 3,
                               .turret_pivot = {-0.2, 1.3, 0.1},
                               .gun_pivot = {1.3, 1.8, 0.0}};
    turret_path_set(&path, turret, gun, turret_turn, gun_turn);
    return path;
}

static struct vec3 placed(const struct part_pose *pose, struct vec3 point)
{
    return vec3_add(pose->at, rotation_apply(&pose->turn, point));
}

static void is_at(struct vec3 p, double x, double y, double z)
{
    if (vec3_length(vec3_sub(p, (struct vec3){x, y, z})) > NEAR_M)
        fail_msg("at %g %g %g, wanted %g %g %g", p.x, p.y, p.z, x, y, z);
}

static void test_a_turret_turns_to_the_right_about_its_pivot(void **state)
{
    struct turret_path path = path_of(HALF_PI, 0.0, 0.0, 0.0);
    struct part_pose turret = turret_path_pose(&path, HULL_PART_TURRET, 0.5);
    struct part_pose gun = turret_path_pose(&path, HULL_PART_GUN, 0.5);
    (void)state;
    is_at(placed(&turret, (struct vec3){-0.2, 7.0, 0.1}), -0.2, 7.0, 0.1);
    is_at(placed(&turret, (struct vec3){4.8, 1.8, 0.1}), -0.2, 1.8, 5.1);
    is_at(placed(&gun, (struct vec3){4.8, 1.8, 0.1}), -0.2, 1.8, 5.1);
}

static void test_a_gun_is_raised_about_its_own_pivot(void **state)
{
    struct turret_path path = path_of(HALF_PI, HALF_PI, 0.0, 0.0);
    struct part_pose turret = turret_path_pose(&path, HULL_PART_TURRET, 1.0);
    struct part_pose gun = turret_path_pose(&path, HULL_PART_GUN, 1.0);
    (void)state;
    is_at(placed(&turret, (struct vec3){1.3, 1.8, 0.1}), -0.2, 1.8, 1.6);
    is_at(placed(&gun, (struct vec3){1.3, 1.8, 0.1}), -0.2, 1.8, 1.6);
    is_at(placed(&gun, (struct vec3){5.3, 1.8, 0.1}), -0.2, 5.8, 1.6);
}

static struct turret_path any_path(uint64_t *random)
{
    return path_of(fixture_uniform(random, -PI, PI), fixture_uniform(random, -1.0, 1.0),
                   fixture_uniform(random, -PI, PI), fixture_uniform(random, -1.0, 1.0));
}

/* Velocities are the differences of places, and no point passes the bounds. */
static void test_points_move_as_it_says_and_within_the_bounds(void **state)
{
    uint64_t random = fixture_seed(731);
    const double h = 1e-4;
    (void)state;
    for (int n = 0; n < 20000; n++) {
        struct turret_path path = any_path(&random);
        struct hull hull = {.part = n % 2 ? HULL_PART_TURRET : HULL_PART_GUN,
                            .centre = vec3_scale(fixture_direction(&random), 4.0)};
        double radius = fixture_uniform(&random, 0.0, 3.0);
        double time = fixture_uniform(&random, h, 1.0 - h);
        struct vec3 p = vec3_add(hull.centre, vec3_scale(fixture_direction(&random), radius));
        struct part_motion motion = turret_path_at(&path, hull.part, time);
        struct part_bounds bounds = turret_path_bounds(&path, &hull, radius);
        struct vec3 at[3];
        for (int i = 0; i < 3; i++) {
            struct part_pose pose = turret_path_pose(&path, hull.part, time + (i - 1) * h);
            at[i] = placed(&pose, p);
        }
        struct vec3 moved = vec3_scale(vec3_sub(at[2], at[0]), 0.5 / h);
        struct vec3 bent =
            vec3_scale(vec3_add(vec3_sub(at[2], at[1]), vec3_sub(at[0], at[1])), 1.0 / (h * h));
        struct vec3 arm = rotation_apply(&motion.pose.turn, p);
        struct vec3 speed = vec3_add(motion.velocity, vec3_cross(motion.spin, arm));
        assert_true(vec3_length(vec3_sub(moved, speed)) < 1e-5);
        assert_true(vec3_length(at[1]) <= bounds.reach + 1e-9);
        assert_true(vec3_length(speed) <= bounds.speed + 1e-9);
        assert_true(vec3_length(bent) <= bounds.bend + 1e-4);
    }
}

static void test_a_path_at_rest_does_not_move(void **state)
{
    struct turret_path path = path_of(1.0, 0.2, 0.0, 0.0);
    struct part_motion motion = turret_path_at(&path, HULL_PART_GUN, 0.7);
    struct part_bounds bounds = turret_path_bounds(&path, &parts[HULL_PART_GUN], 1.0);
    (void)state;
    assert_false(turret_path_moves(&path));
    assert_true(vec3_length(motion.velocity) == 0.0 && vec3_length(motion.spin) == 0.0);
    assert_true(bounds.speed == 0.0 && bounds.bend == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_turret_turns_to_the_right_about_its_pivot),
        cmocka_unit_test(test_a_gun_is_raised_about_its_own_pivot),
        cmocka_unit_test(test_points_move_as_it_says_and_within_the_bounds),
        cmocka_unit_test(test_a_path_at_rest_does_not_move),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
