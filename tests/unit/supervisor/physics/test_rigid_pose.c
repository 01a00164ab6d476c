/* The physics check's own rotations. */
#include "supervisor/physics/rigid_pose.h"

#include "tests/support/fixture.h"
#include "world/maths/rotation.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const struct vec3 here = {25000.0, 100.0, 25000.0};

static void is_near(struct vec3 a, double x, double y, double z)
{
    assert_true(vec3_length(vec3_sub(a, (struct vec3){x, y, z})) < 1e-15);
}

static void test_axes_of_single_turns(void **state)
{
    (void)state;
    struct rigid_pose east = rigid_pose_of(here, HALF_PI, 0.0, 0.0);
    is_near(east.forward, 1.0, 0.0, 0.0);
    is_near(east.right, 0.0, 0.0, 1.0);
    is_near(rigid_pose_of(here, 0.0, HALF_PI, 0.0).forward, 0.0, 1.0, 0.0);
    is_near(rigid_pose_of(here, 0.0, 0.0, HALF_PI).right, 0.0, -1.0, 0.0);
}

static void test_the_axes_are_those_of_the_documents_rotation(void **state)
{
    uint64_t random = fixture_seed(5);
    (void)state;
    for (int i = 0; i < 1000; i++) {
        double heading = fixture_uniform(&random, 0.0, TWO_PI);
        double pitch = fixture_uniform(&random, -HALF_PI, HALF_PI);
        double roll = fixture_uniform(&random, -PI, PI);
        struct rigid_pose pose = rigid_pose_of(here, heading, pitch, roll);
        struct mat3 turn = rotation_matrix(rotation_of(heading, pitch, roll));
        is_near(pose.forward, turn.m[0][0], turn.m[1][0], turn.m[2][0]);
        is_near(pose.up, turn.m[0][1], turn.m[1][1], turn.m[2][1]);
        is_near(pose.right, turn.m[0][2], turn.m[1][2], turn.m[2][2]);
        struct vec3 v = {1.0, -2.0, 3.0};
        is_near(vec3_scale(rigid_pose_in(&pose, rigid_pose_out(&pose, v)), 0.1), 0.1, -0.2, 0.3);
    }
}

static void test_the_angle_between_two_poses(void **state)
{
    struct rigid_pose a = rigid_pose_of(here, 1.0, 0.4, -2.0);
    struct rigid_pose rolled = rigid_pose_of(here, 1.0, 0.4, -2.0 + 0.3);
    struct rigid_pose north = rigid_pose_of(here, 0.0, 0.0, 0.0);
    struct rigid_pose over = rigid_pose_of(here, 0.0, 0.0, PI);
    (void)state;
    assert_true(fabs(rigid_pose_angle(&a, &rolled) - 0.3) < 1e-14);
    assert_true(rigid_pose_angle(&a, &a) < 1e-15);
    assert_true(fabs(rigid_pose_angle(&north, &over) - PI) < 1e-14);
}

/* A tank heads north, its turret points to the right, and its gun is raised by 30 degrees. */
static void test_a_gun_lies_where_its_turret_points(void **state)
{
    const struct vec3 at = {100.0, 50.0, 200.0}, pivot = {-1.0, 1.0, 0.0}, trunnion = {1.0, 2.0, 0};
    const struct rigid_pose body = rigid_pose_of(at, 0.0, 0.0, 0.0);
    const struct rigid_pose turret = rigid_pose_turned(&body, pivot, 0.5 * PI);
    const struct rigid_pose gun = rigid_pose_raised(&turret, trunnion, PI / 6.0);
    struct vec3 muzzle = vec3_add(gun.at, rigid_pose_out(&gun, (struct vec3){5.0, 2.0, 0.0}));
    (void)state;
    /* The trunnion is 2 m to the east of the pivot, which is 1 m south of the position. */
    assert_true(fabs(muzzle.x - (100.0 + 2.0 + 4.0 * sqrt(0.75))) < 1e-9);
    assert_true(fabs(muzzle.y - (50.0 + 2.0 + 2.0)) < 1e-9);
    assert_true(fabs(muzzle.z - 201.0) < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_axes_of_single_turns),
        cmocka_unit_test(test_the_axes_are_those_of_the_documents_rotation),
        cmocka_unit_test(test_the_angle_between_two_poses),
        cmocka_unit_test(test_a_gun_lies_where_its_turret_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
