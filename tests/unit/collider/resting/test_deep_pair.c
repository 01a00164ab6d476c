/* Which bodies count as deep in each other, by their inner shapes. SEED=n draws other crowds. */
#include "collider/resting/deep_pair.h"

#include "collider/resting/resting.h"
#include "tests/support/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct fixture f;

/* Measures the two vehicles of the context. Returns true if they are deep in each other. */
static bool measure(const struct response_context *context, struct resting_gap *found)
{
    const struct pair pair = {0, 1};
    struct begun_bodies begun;
    found->gap = found->few;
    assert_int_equal(begun_bodies_init(&begun, context->world), 0);
    begun_bodies_list(&begun, 0);
    begun_bodies_list(&begun, 1);
    begun_bodies_find(&begun, context, NULL);
    bool deep = deep_pair_measure(context, &pair, begun_bodies_row(&begun, 0),
                                  begun_bodies_row(&begun, 1), found);
    begun_bodies_free(&begun);
    return deep;
}

/* Returns the gap that is measured between two vehicles of a kind, the second so far to the south
 * and turned so far; 0 if they are not deep in each other. */
static double measured(const char *kind, double south_m, double turned_rad)
{
    struct response_context context;
    struct resting_gap found;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (int n = 0; n < 2; n++)
        fixture_put(
            &f, (struct fixture_entity){.kind = kind,
                                        .at = {25000.0, FIXTURE_GROUND_M, 25000.0 + n * south_m},
                                        .heading_rad = n * turned_rad});
    steps_respond(&f, &context);
    bool deep = measure(&context, &found);
    steps_respond_end(&context);
    fixture_close(&f);
    return deep ? found.gap[0].gap_m : 0.0;
}

/* The hamburger is as wide as it is long, so that its inner shape is a disc. */
static void test_round_bodies_far_apart_are_not_deep(void **state)
{
    static const double south_m[] = {3.2, 5.5, 30.0};
    (void)state;
    for (int n = 0; n < 3; n++)
        assert_true(measured("hamburger", south_m[n], 0.0) == 0.0);
    assert_true(measured("hamburger", 1.0, 0.0) < -2.0);
    assert_true(measured("hamburger", 1.0, HALF_PI) < -2.0);
}

static void test_long_bodies_are_deep_where_their_lines_cross(void **state)
{
    double width = 0.0;
    (void)state;
    fixture_open(&f, "");
    width = steps_kind(&f, "truck")->width_m;
    fixture_close(&f);
    assert_true(measured("truck", 20.0, 0.0) == 0.0);
    assert_true(measured("truck", 8.0, HALF_PI) == 0.0);
    assert_true(fabs(measured("truck", 1.0, HALF_PI) + width) < 1e-9); /* they cross */
    assert_true(fabs(measured("truck", 0.0, 0.0) + width) < 0.01);     /* at one place */
}

/* Puts two vehicles on the ground that begin a frame like this, and end it with turned as the
 * heading of the second. Returns true if they are deep in each other. */
static bool deep(const char *kind, const double x[2], const double z[2], const double heading[2],
                 double turned)
{
    struct response_context context;
    struct resting_gap found;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    for (int n = 0; n < 2; n++)
        fixture_put(&f, (struct fixture_entity){.kind = kind,
                                                .at = {x[n], FIXTURE_GROUND_M, z[n]},
                                                .heading_rad = heading[n]});
    steps_respond(&f, &context);
    context.next->entities.row[1].heading = turned;
    bool are = measure(&context, &found);
    steps_respond_end(&context);
    fixture_close(&f);
    return are;
}

/* A jeep across the way of another, which it does not touch, turns by a quarter within the frame.
 * At the end of the frame the two would be deep in each other, if they were where they began it. */
static void test_bodies_are_measured_as_they_begin_the_frame(void **state)
{
    static const double x[] = {25000.0, 25000.0}, z[] = {25000.0, 25002.6};
    static const double heading[] = {0.0, HALF_PI};
    (void)state;
    assert_false(deep("jeep", x, z, heading, 0.0));
}

/* The bonnet of a truck is narrower than its bed: where it meets another truck slantwise their
 * capsules overlap by a tenth, while the trucks are apart. */
static void test_bodies_that_are_apart_are_not_deep(void **state)
{
    static const double x[] = {25003.52765, 24999.55356}, z[] = {24997.35202, 24998.71763};
    static const double heading[] = {3.80719, 0.68683};
    (void)state;
    assert_false(deep("truck", x, z, heading, heading[1]));
}

/* The bow of a ship is narrow: two that pass bow to bow are measured by their hulls. */
static void test_ships_are_measured_by_their_hulls(void **state)
{
    (void)state;
    assert_true(measured("ship", 1.0, 0.0) == 0.0);
    assert_true(measured("ship", 36.0, HALF_PI) == 0.0);
}

/* On a slope of 22 degrees vehicles that lean with it, to the front, to a side or to both, part as
 * capsules as they do on the level. Each pair of a crowd was measured exactly instead, and one of
 * 50 tanks took 4 s a frame. */
static void test_bodies_on_a_slope_are_deep(void **state)
{
    static const double heading[] = {0.0, 0.8, HALF_PI, 2.5};
    (void)state;
    for (int n = 0; n < 4; n++) {
        struct response_context context;
        struct resting_gap found;
        double sine, cosine;
        maths_sincos(heading[n], &sine, &cosine);
        fixture_open(&f, "collision = { shape = \"model\"; };");
        steps_plane(&f, 0.4, 0.0);
        for (int i = 0; i < 2; i++)
            fixture_put(&f, (struct fixture_entity){.kind = "tank",
                                                    .at = {25000.0 + i, 100.0 + 0.4 * i, 25000.0},
                                                    .heading_rad = heading[n] + 0.5 * i});
        fixture_continue(&f, 1); /* the ground turns them */
        steps_respond(&f, &context);
        const struct entities e = steps_rows(&f);
        assert_true(cos(e.row[0].pitch) * cos(e.row[0].roll) < 0.94);
        assert_true(measure(&context, &found));
        assert_true(found.gap[0].gap_m < -1.5);
        steps_respond_end(&context);
        fixture_close(&f);
    }
}

#define CROWD 60

/* Draws a crowd of three kinds within 7 m. */
static void put_crowd(uint64_t *random, double slope)
{
    static const char *const kind[] = {"tank", "jeep", "truck"};
    for (uint32_t i = 0; i < CROWD; i++) {
        double x = fixture_uniform(random, 0.0, 7.0), z = fixture_uniform(random, 0.0, 7.0);
        fixture_put(&f,
                    (struct fixture_entity){.kind = kind[i % 3],
                                            .at = {25000.0 + x, 100.0 + slope * x, 25000.0 + z},
                                            .heading_rad = fixture_uniform(random, 0.0, TWO_PI)});
    }
}

/* Returns how many pairs of the crowd are deep. The search for the deepest overlap of their hulls
 * agrees with each of them. */
static uint32_t deep_in_crowd(const struct response_context *context)
{
    struct begun_bodies begun;
    uint32_t count = 0;
    assert_int_equal(begun_bodies_init(&begun, context->world), 0);
    for (uint32_t i = 0; i < CROWD; i++)
        begun_bodies_list(&begun, i);
    begun_bodies_find(&begun, context, NULL);
    for (uint32_t i = 0; i < CROWD * CROWD; i++) {
        const struct pair pair = {i / CROWD, i % CROWD};
        const struct begun_body *a = begun_bodies_row(&begun, pair.a);
        const struct begun_body *b = begun_bodies_row(&begun, pair.b);
        struct resting_gap found = {.gap = found.few};
        struct level_gap deepest;
        if (pair.a >= pair.b || !deep_pair_measure(context, &pair, a, b, &found))
            continue;
        const struct turned_body turned_a = {&a->body, a->began}, turned_b = {&b->body, b->began};
        double surely = found.gap[0].gap_m < -2.0 * DEEP_PAIR_M ? RESTING_PARTS_M : DEEP_PAIR_M;
        assert_true(level_gap_deepest(&turned_a, &turned_b, surely, surely, &deepest));
        count++;
    }
    begun_bodies_free(&begun);
    return count;
}

/* A point inside both bodies proves most pairs deep, without a search of their hulls. */
static void test_bodies_that_are_proved_deep_are_deep(void **state)
{
    static const double slope[] = {0.0, 0.4};
    uint64_t random = fixture_seed(7);
    (void)state;
    for (int n = 0; n < 2; n++) {
        struct response_context context;
        fixture_open(&f, "collision = { shape = \"model\"; };");
        steps_plane(&f, slope[n], 0.0);
        put_crowd(&random, slope[n]);
        fixture_continue(&f, 1); /* the ground turns them */
        steps_respond(&f, &context);
        assert_true(deep_in_crowd(&context) > CROWD);
        steps_respond_end(&context);
        fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_bodies_far_apart_are_not_deep),
        cmocka_unit_test(test_long_bodies_are_deep_where_their_lines_cross),
        cmocka_unit_test(test_bodies_are_measured_as_they_begin_the_frame),
        cmocka_unit_test(test_bodies_that_are_apart_are_not_deep),
        cmocka_unit_test(test_ships_are_measured_by_their_hulls),
        cmocka_unit_test(test_bodies_on_a_slope_are_deep),
        cmocka_unit_test(test_bodies_that_are_proved_deep_are_deep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
