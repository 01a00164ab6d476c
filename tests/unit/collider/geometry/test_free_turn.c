/* Free rotation and steering on one path. */
#include "collider/geometry/free_turn.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>

#include <cmocka.h>

static const struct vec3 moment = {2.0, 5.0, 4.0};
static const struct quat from = {1.0, 0.0, 0.0, 0.0};

static double difference(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

/* Returns the angle between two rotations [rad]. */
static double between(struct quat a, struct quat b)
{
    struct quat apart = rotation_product(a, rotation_inverse(b));
    return 2.0 * sqrt(apart.x * apart.x + apart.y * apart.y + apart.z * apart.z);
}

/* Three turns of which the body was steered by 0.4 rad. */
static struct free_turn steered(void)
{
    struct free_rotation rotation =
        free_rotation_of(moment, from, (struct vec3){60.0, 70.0, -50.0}, 0.2);
    struct quat by = rotation_spun(from, (struct vec3){0.0, 0.4, 0.0}, 1.0);
    return free_turn_to(&rotation, rotation_product(by, free_rotation_at(&rotation, 1.0)));
}

static void test_a_free_turn_has_no_steering(void **state)
{
    struct free_rotation rotation =
        free_rotation_of(moment, from, (struct vec3){6.0, 7.0, -5.0}, 0.2);
    struct quat end = free_rotation_at(&rotation, 1.0), opposite = {-end.w, -end.x, -end.y, -end.z};
    (void)state;
    assert_false(free_turn_to(&rotation, end).steers);
    assert_false(free_turn_to(&rotation, opposite).steers); /* the same rotation */
    assert_true(steered().steers);
}

static void test_it_goes_from_its_beginning_to_its_end_at_the_speed_it_says(void **state)
{
    const double step = 1e-5;
    struct free_turn turn = steered();
    struct quat at, before, after;
    struct vec3 spin, other, last = {0.0, 0.0, 0.0};
    double bend, most = free_turn_rate(&turn, &bend);
    (void)state;
    free_turn_at(&turn, 0.0, &at, &spin);
    assert_true(between(at, from) < 1e-15);
    free_turn_at(&turn, 1.0, &at, &spin);
    struct quat end = rotation_product(turn.steered, free_rotation_at(&turn.rotation, 1.0));
    assert_true(between(at, end) < 1e-12);
    for (double share = 0.01; share < 0.995; share += 0.01) {
        free_turn_at(&turn, share - step, &before, &last);
        free_turn_at(&turn, share + step, &after, &other);
        free_turn_at(&turn, share, &at, &spin);
        struct vec3 seen = vec3_scale(rotation_speed(before, after, 0.5), 0.5 / step);
        assert_true(difference(spin, seen) < 1e-5 * vec3_length(spin));
        assert_true(vec3_length(spin) <= most);
        double faster = difference(other, last) / (2.0 * step);
        assert_true(faster + vec3_dot(spin, spin) <= bend * (1.0 + 1e-6));
    }
}

static void test_turns_have_an_order(void **state)
{
    struct free_turn turn = steered(), other = turn;
    (void)state;
    assert_int_equal(free_turn_order(&turn, &other), 0);
    other.rotation.momentum.z += 1.0;
    assert_int_equal(free_turn_order(&turn, &other), -1);
    assert_int_equal(free_turn_order(&other, &turn), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_free_turn_has_no_steering),
        cmocka_unit_test(test_it_goes_from_its_beginning_to_its_end_at_the_speed_it_says),
        cmocka_unit_test(test_turns_have_an_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
