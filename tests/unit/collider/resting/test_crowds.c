/* Bodies that are deep in each other are a crowd, and one that lacks room spreads. */
#include "collider/resting/crowds.h"

#include "tests/support/steps.h"
#include "world/params.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define TANKS 6u

static struct fixture f;
static struct response_context context;
static struct crowds crowds;

/* Tanks from west to east, so far apart. */
static void open_world(double apart_m)
{
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (uint32_t i = 0; i < TANKS; i++)
        fixture_put(
            &f, (struct fixture_entity){.kind = "tank",
                                        .at = {25000.0 + apart_m * i, FIXTURE_GROUND_M, 25000.0}});
    steps_respond(&f, &context);
    assert_int_equal(crowds_init(&crowds, &f.view.world), 0);
}

static int close_world(void **state)
{
    (void)state;
    crowds_free(&crowds);
    steps_respond_end(&context);
    fixture_close(&f);
    return 0;
}

static void join(uint32_t a, uint32_t b, double depth_m)
{
    const struct pair pair = {a, b};
    crowds_join(&crowds, &pair, depth_m);
}

static bool together(uint32_t a, uint32_t b)
{
    const struct pair pair = {a, b};
    return crowds_spread_together(&crowds, &pair);
}

static void test_a_dense_crowd_spreads(void **state)
{
    (void)state;
    open_world(1.0);
    join(2, 3, 1.0);
    join(0, 1, 2.0);
    join(1, 2, 1.5);
    crowds_measure(&crowds, &context);
    assert_true(crowds_spreads(&crowds, 0) && crowds_spreads(&crowds, 3));
    assert_true(together(0, 3));
    assert_false(crowds_spreads(&crowds, 4) || together(3, 4));
    crowds_forget(&crowds);
    assert_false(crowds_spreads(&crowds, 0));
}

/* Two bodies have a way of their own, and those that are far from each other have room. */
static void test_who_has_room_does_not_spread(void **state)
{
    (void)state;
    open_world(6.0);
    join(0, 1, 2.0);
    crowds_measure(&crowds, &context);
    assert_false(crowds_spreads(&crowds, 0));
    for (uint32_t i = 1; i + 1 < TANKS; i++)
        join(i, i + 1, 2.0);
    crowds_measure(&crowds, &context);
    assert_false(crowds_spreads(&crowds, 0));
}

/* The edge goes at 20 m/s, or as fast as parts the deepest pair in two frames. */
static void test_a_crowd_spreads_about_its_centre(void **state)
{
    double x[TANKS], z, dt_s;
    (void)state;
    open_world(1.0);
    dt_s = world_dt_s(&f.view.world);
    for (int deep = 0; deep < 2; deep++) {
        for (uint32_t i = 0; i + 1 < TANKS; i++)
            join(i, i + 1, deep ? 2.0 : 0.1);
        crowds_measure(&crowds, &context);
        for (uint32_t i = 0; i < TANKS; i++)
            crowds_spread(&crowds, &context, i, &x[i], &z);
        double edge_mps = deep ? 20.0 : 0.5 * 0.1 / dt_s;
        assert_true(fabs(maths_max(-x[0], x[TANKS - 1]) - edge_mps) < 1e-3 * edge_mps);
        assert_true(x[0] < x[1] && x[1] < 0.0 && x[TANKS - 2] > 0.0);
    }
}

static void test_a_fixed_object_is_in_no_crowd(void **state)
{
    (void)state;
    open_world(1.0);
    join(0, 3 | PAIR_FIXED, 1.0);
    crowds_measure(&crowds, &context);
    assert_false(crowds_spreads(&crowds, 0) || together(0, 3 | PAIR_FIXED));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_a_dense_crowd_spreads, close_world),
        cmocka_unit_test_teardown(test_who_has_room_does_not_spread, close_world),
        cmocka_unit_test_teardown(test_a_crowd_spreads_about_its_centre, close_world),
        cmocka_unit_test_teardown(test_a_fixed_object_is_in_no_crowd, close_world),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
