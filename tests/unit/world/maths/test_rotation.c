/* Rotations: the conventions by hand, then what must hold of any turn. SEED=n draws others. */
#include "world/maths/rotation.h"

#include "renderer/scene/frame/body_axes.h"
#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define TURNS 20000

static double off(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

static struct vec3 forward(struct quat q)
{
    struct mat3 turn = rotation_matrix(q);
    return rotation_apply(&turn, (struct vec3){1.0, 0.0, 0.0});
}

/* How far two turns are apart [rad, for small ones]. */
static double between(struct quat a, struct quat b)
{
    double same = 0.0, opposite = 0.0;
    const double p[4] = {a.w, a.x, a.y, a.z}, q[4] = {b.w, b.x, b.y, b.z};
    for (int i = 0; i < 4; i++) {
        same += (p[i] - q[i]) * (p[i] - q[i]);
        opposite += (p[i] + q[i]) * (p[i] + q[i]);
    }
    return 2.0 * sqrt(maths_min(same, opposite));
}

static struct quat draw(uint64_t *random)
{
    return rotation_of(fixture_uniform(random, 0.0, TWO_PI),
                       fixture_uniform(random, -HALF_PI, HALF_PI),
                       fixture_uniform(random, -PI, PI));
}

/* Any turn, one near to the other, half a turn from it, or the very same. */
static struct quat draw_after(struct quat from, int sort, uint64_t *random)
{
    struct vec3 spin = {fixture_uniform(random, -1.0, 1.0), fixture_uniform(random, -1.0, 1.0),
                        fixture_uniform(random, -1.0, 1.0)};
    double turn = sort == 0   ? fixture_uniform(random, 0.0, PI)
                  : sort == 1 ? fixture_uniform(random, 0.0, 1e-6)
                  : sort == 2 ? PI
                              : 0.0;
    return rotation_spun(from, vec3_scale(spin, turn / vec3_length(spin)), 1.0);
}

/* --- conventions -------------------------------------------------------------------------------*/

static void test_heading_is_clockwise_from_north(void **state)
{
    (void)state;
    assert_true(off(forward(rotation_of(0.0, 0.0, 0.0)), (struct vec3){0, 0, -1}) < 1e-15);
    assert_true(off(forward(rotation_of(HALF_PI, 0.0, 0.0)), (struct vec3){1, 0, 0}) < 1e-15);
    assert_true(off(forward(rotation_of(PI, 0.0, 0.0)), (struct vec3){0, 0, 1}) < 1e-15);
    assert_true(off(forward(rotation_of(1.0, HALF_PI, 0.0)), (struct vec3){0, 1, 0}) < 1e-15);
    struct mat3 rolled = rotation_matrix(rotation_of(0.0, 0.0, HALF_PI));
    assert_true(off(rotation_apply(&rolled, (struct vec3){0, 0, 1}), (struct vec3){0, -1, 0}) <
                1e-15); /* the right side is down */
}

static void test_it_rotates_as_the_drawn_model(void **state)
{
    uint64_t random = fixture_seed(301);
    (void)state;
    for (int n = 0; n < TURNS; n++) {
        double heading = fixture_uniform(&random, -10.0, 10.0);
        double pitch = fixture_uniform(&random, -4.0, 4.0);
        double roll = fixture_uniform(&random, -4.0, 4.0);
        struct body_axes pose = body_axes_of(heading, pitch, roll);
        struct mat3 turn = rotation_matrix(rotation_of(heading, pitch, roll));
        struct vec3 body = {fixture_uniform(&random, -9, 9), fixture_uniform(&random, -9, 9),
                            fixture_uniform(&random, -9, 9)};
        struct vec3 drawn =
            vec3_add(vec3_scale(pose.forward, body.x),
                     vec3_add(vec3_scale(pose.up, body.y), vec3_scale(pose.right, body.z)));
        struct vec3 world = rotation_apply(&turn, body);
        assert_true(off(world, drawn) < 1e-13);
        assert_true(off(rotation_back(&turn, world), body) < 1e-13);
    }
}

static void test_spin_is_right_handed_about_the_worlds_axes(void **state)
{
    double heading, pitch, roll;
    (void)state;
    struct quat q = rotation_spun(rotation_of(1.0, 0.0, 0.0), (struct vec3){0, 0.5, 0}, 0.2);
    rotation_angles(q, &heading, &pitch, &roll);
    assert_true(fabs(heading - 0.9) < 1e-15); /* up is y: the heading falls */
    q = rotation_spun(rotation_of(HALF_PI, 0.0, 0.0), (struct vec3){0, 0, 0.5}, 0.2);
    rotation_angles(q, &heading, &pitch, &roll);
    assert_true(fabs(pitch - 0.1) < 1e-15); /* it looks east; the axis points south */
    q = rotation_spun(rotation_of(HALF_PI, 0.0, 0.0), (struct vec3){0.5, 0, 0}, 0.2);
    rotation_angles(q, &heading, &pitch, &roll);
    assert_true(fabs(roll - 0.1) < 1e-15);
    q = rotation_of(2.0, 0.3, -0.4);
    assert_true(between(rotation_spun(q, (struct vec3){0, 0, 0}, 1.0), q) == 0.0);
}

/* --- angles ------------------------------------------------------------------------------------*/

static void test_angles_come_back(void **state)
{
    uint64_t random = fixture_seed(302);
    double heading, pitch, roll;
    (void)state;
    for (int n = 0; n < TURNS; n++) {
        double h = fixture_uniform(&random, 0.0, TWO_PI), r = fixture_uniform(&random, -PI, PI);
        double p = fixture_uniform(&random, -1.5, 1.5);
        rotation_angles(rotation_of(h, p, r), &heading, &pitch, &roll);
        assert_true(fabs(maths_wrap_half(heading - h)) < 1e-13);
        assert_true(fabs(pitch - p) < 1e-13);
        assert_true(fabs(maths_wrap_half(roll - r)) < 1e-13);
    }
}

static void test_the_turn_comes_back_even_straight_up(void **state)
{
    uint64_t random = fixture_seed(303);
    double heading, pitch, roll;
    (void)state;
    for (int n = 0; n < TURNS; n++) {
        double short_of[] = {0.0, 1e-17, 1e-15, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3};
        double p = HALF_PI - short_of[n % 8];
        struct quat q = rotation_of(fixture_uniform(&random, 0.0, TWO_PI), n & 8 ? p : -p,
                                    fixture_uniform(&random, -PI, PI));
        rotation_angles(q, &heading, &pitch, &roll);
        assert_true(heading >= 0.0 && heading < TWO_PI);
        assert_true(fabs(pitch) <= HALF_PI && fabs(roll) <= PI);
        assert_true(between(rotation_of(heading, pitch, roll), q) < 1e-14);
        if (n % 8 == 0)
            assert_true(roll == 0.0);
    }
}

/* --- the way from one to another ---------------------------------------------------------------*/

static void test_it_takes_the_shorter_path_between_two_rotations(void **state)
{
    uint64_t random = fixture_seed(304);
    (void)state;
    for (int n = 0; n < TURNS; n++) {
        struct quat a = draw(&random), b = draw_after(a, n % 4, &random);
        double angle = between(a, b), t = fixture_uniform(&random, 0.0, 1.0);
        struct quat q = rotation_between(a, b, t);
        assert_true(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 1e-15);
        assert_true(between(rotation_between(a, b, 0.0), a) < 1e-15);
        assert_true(between(rotation_between(a, b, 1.0), b) < 1e-15);
        assert_true(between(a, q) <= angle + 1e-14 && between(q, b) <= angle + 1e-14);
    }
}

/* The rate by differences: by how much the turn changes over a ten-thousandth of the way. */
static void test_no_part_of_the_path_is_faster_than_its_rate(void **state)
{
    uint64_t random = fixture_seed(305);
    double nearest = 0.0;
    (void)state;
    for (int n = 0; n < TURNS; n++) {
        struct quat a = draw(&random), b = draw_after(a, n % 4, &random);
        double rate = rotation_rate(a, b), t = n % 8 < 4 ? 0.5 : fixture_uniform(&random, 0, 1);
        const double step = 1e-4;
        double low = maths_min(t, 1.0 - step);
        double turned =
            between(rotation_between(a, b, low), rotation_between(a, b, low + step)) / step;
        assert_true(rate <= 4.0 + 1e-14);
        assert_true(turned <= rate * (1.0 + 1e-9) + 1e-11);
        if (n % 4 == 0)
            nearest = maths_max(nearest, turned / rate);
    }
    assert_true(nearest > 0.999999); /* in the middle it is that fast */
}

static void test_the_speed_is_that_of_the_differences(void **state)
{
    uint64_t random = fixture_seed(306);
    const double step = 1e-5;
    (void)state;
    for (int n = 0; n < TURNS; n++) {
        struct quat a = draw(&random), b = draw_after(a, n % 4, &random);
        double t = fixture_uniform(&random, step, 1.0 - step);
        struct vec3 speed = rotation_speed(a, b, t);
        struct vec3 body = {fixture_uniform(&random, -1, 1), fixture_uniform(&random, -1, 1),
                            fixture_uniform(&random, -1, 1)};
        struct mat3 turn = rotation_matrix(rotation_between(a, b, t));
        struct mat3 before = rotation_matrix(rotation_between(a, b, t - step));
        struct mat3 after = rotation_matrix(rotation_between(a, b, t + step));
        struct vec3 moved = vec3_scale(
            vec3_sub(rotation_apply(&after, body), rotation_apply(&before, body)), 0.5 / step);
        struct vec3 r = rotation_apply(&turn, body);
        struct vec3 turned = {speed.y * r.z - speed.z * r.y, speed.z * r.x - speed.x * r.z,
                              speed.x * r.y - speed.y * r.x};
        assert_true(off(moved, turned) < 1e-7);
        assert_true(vec3_length(speed) <= rotation_rate(a, b) * (1.0 + 1e-14) + 1e-15);
    }
}

static void test_standing_still_is_no_rate(void **state)
{
    uint64_t random = fixture_seed(307);
    (void)state;
    for (int n = 0; n < 100; n++) {
        struct quat q = draw(&random), other = {-q.w, -q.x, -q.y, -q.z};
        assert_true(rotation_rate(q, q) == 0.0 && rotation_rate(q, other) == 0.0);
        assert_true(vec3_length(rotation_speed(q, other, 0.3)) == 0.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_heading_is_clockwise_from_north),
        cmocka_unit_test(test_it_rotates_as_the_drawn_model),
        cmocka_unit_test(test_spin_is_right_handed_about_the_worlds_axes),
        cmocka_unit_test(test_angles_come_back),
        cmocka_unit_test(test_the_turn_comes_back_even_straight_up),
        cmocka_unit_test(test_it_takes_the_shorter_path_between_two_rotations),
        cmocka_unit_test(test_no_part_of_the_path_is_faster_than_its_rate),
        cmocka_unit_test(test_the_speed_is_that_of_the_differences),
        cmocka_unit_test(test_standing_still_is_no_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
