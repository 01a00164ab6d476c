/* The shortest way out of upright boxes, against places that are outside all of them, and from
 * every place on that way. SEED=n places the boxes. */
#include "collider/geometry/level_exit.h"

#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define ROUNDS     200
#define BOXES_MOST 6
#define CLEAR_M    0.01 /* how far a way leads from the boxes that it leaves */
#define DIRECTIONS 180
#define STEP_M     0.05
#define STEPS      8 /* on the way, from each of which the rest has to be the way */
#define LENGTH_M   2.0
#define WIDTH_M    1.0
#define FARTHER    1.7 /* so many times as far are boxes that bar the way */

/* A box with half sides 1, 1 and 2 (across, up and along). */
static const struct vec3 vertices[] = {{-2, -1, -1}, {2, -1, -1}, {-2, 1, -1}, {2, 1, -1},
                                       {-2, -1, 1},  {2, -1, 1},  {-2, 1, 1},  {2, 1, 1}};
static const struct hull_plane planes[] = {{{1, 0, 0}, LENGTH_M}, {{-1, 0, 0}, LENGTH_M},
                                           {{0, 1, 0}, 1},        {{0, -1, 0}, 1},
                                           {{0, 0, 1}, WIDTH_M},  {{0, 0, -1}, WIDTH_M}};
static const struct hull box = {.vertex_count = 8,
                                .plane_count = 6,
                                .half = {LENGTH_M, 1, WIDTH_M},
                                .radius_m = 2.4494897427831781};

static const struct exit_slope level = {0.0, 0.0};

static struct level_exit search;

static int open_search(void **state)
{
    (void)state;
    return level_exit_init(&search);
}

static int close_search(void **state)
{
    (void)state;
    level_exit_free(&search);
    return 0;
}

static struct swept_body put(double x, double z, double heading_rad)
{
    struct quat turn = rotation_of(heading_rad, 0.0, 0.0);
    return (struct swept_body){.hull = &box,
                               .hull_count = 1,
                               .outer = &box,
                               .vertices = vertices,
                               .planes = planes,
                               .scale = 1.0,
                               .bound_m = 2.5,
                               .path = {.at = {x, 0.0, z}},
                               .from = turn,
                               .to = turn};
}

/* --- the oracle --------------------------------------------------------------------------------*/

/* Returns how far a box reaches from its middle along a unit vector. */
static double reach(const struct mat3 *turn, struct vec3 along)
{
    struct vec3 own = rotation_back(turn, along);
    return LENGTH_M * fabs(own.x) + WIDTH_M * fabs(own.z);
}

/* Returns the separation of two boxes along the best normal of their sides. */
static double separation(const struct swept_body *a, const struct swept_body *b)
{
    static const struct vec3 side[2] = {{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
    struct mat3 turn[2] = {rotation_matrix(a->from), rotation_matrix(b->from)};
    struct vec3 between = vec3_sub(b->path.at, a->path.at);
    double most = -INFINITY;
    for (int i = 0; i < 4; i++) {
        struct vec3 normal = rotation_apply(&turn[i / 2], side[i % 2]);
        most = maths_max(most, fabs(vec3_dot(between, normal)) - reach(&turn[0], normal) -
                                   reach(&turn[1], normal));
    }
    return most;
}

struct boxes {
    struct swept_body body, other[BOXES_MOST];
    uint32_t count;
};

static struct boxes random_boxes(uint64_t *random)
{
    struct boxes boxes = {.body = put(0.0, 0.0, fixture_uniform(random, 0.0, TWO_PI))};
    boxes.count = 1 + (uint32_t)fixture_uniform(random, 0.0, BOXES_MOST);
    for (uint32_t i = 0; i < boxes.count; i++)
        boxes.other[i] = put(fixture_uniform(random, -3.0, 3.0), fixture_uniform(random, -3.0, 3.0),
                             fixture_uniform(random, 0.0, TWO_PI));
    return boxes;
}

/* Returns the least separation of the body, moved against the normal, from all others. */
static double separation_after(const struct boxes *boxes, struct vec3 normal, double way_m)
{
    struct swept_body moved = boxes->body;
    double least = INFINITY;
    moved.path.at = vec3_sub(moved.path.at, vec3_scale(normal, way_m));
    for (uint32_t i = 0; i < boxes->count; i++)
        least = maths_min(least, separation(&moved, &boxes->other[i]));
    return least;
}

static double way_out(const struct boxes *boxes, struct vec3 *normal)
{
    level_exit_begin(&search, level);
    for (uint32_t i = 0; i < boxes->count; i++)
        level_exit_add(&search, &boxes->body, &boxes->other[i], false);
    return level_exit_find(&search, false, normal);
}

/* --- tests -------------------------------------------------------------------------------------*/

static void test_the_way_is_the_shortest_and_leads_out(void **state)
{
    uint64_t random = fixture_seed(5);
    uint32_t within = 0;
    (void)state;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        const struct boxes boxes = random_boxes(&random);
        struct vec3 normal = {0.0, 0.0, 0.0};
        double way = way_out(&boxes, &normal);
        if (separation_after(&boxes, normal, 0.0) >= 0.0) {
            assert_true(way == INFINITY);
            continue;
        }
        within++;
        assert_true(fabs(vec3_dot(normal, normal) - 1.0) < 1e-12 && normal.y == 0.0);
        assert_true(separation_after(&boxes, normal, way) >= CLEAR_M - 1e-6);
        for (uint32_t i = 0; i < DIRECTIONS; i++) {
            struct vec3 along = {0.0, 0.0, 0.0};
            maths_sincos(i * TWO_PI / DIRECTIONS, &along.x, &along.z);
            for (double far = STEP_M; far < way - 1e-6; far += STEP_M)
                assert_true(separation_after(&boxes, along, far) < CLEAR_M);
        }
    }
    print_message("%u of %d bodies began within boxes\n", within, ROUNDS);
    assert_true(within > ROUNDS / 2);
}

/* The way out of one box led into the next, and was found to be another one there. */
static void test_the_rest_of_the_way_is_the_way_from_there(void **state)
{
    uint64_t random = fixture_seed(6);
    (void)state;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        struct boxes boxes = random_boxes(&random);
        struct vec3 normal = {0.0, 0.0, 0.0}, again = normal;
        double way = way_out(&boxes, &normal), rest = way;
        if (way == INFINITY)
            continue;
        for (uint32_t i = 1; i < STEPS; i++) {
            struct swept_body start = boxes.body;
            double gone = way * i / STEPS;
            boxes.body.path.at = vec3_sub(start.path.at, vec3_scale(normal, gone));
            if (separation_after(&boxes, normal, 0.0) >= -1e-6)
                break;
            rest = way_out(&boxes, &again);
            boxes.body = start;
            assert_true(fabs(rest + gone - way) < 1e-6);
            assert_true(vec3_dot(again, normal) > 1.0 - 1e-6);
        }
    }
}

static void test_a_body_leaves_two_boxes_where_they_meet(void **state)
{
    struct boxes boxes = {.body = put(0.0, 0.0, 0.0), .count = 2};
    struct vec3 normal = {0.0, 0.0, 0.0};
    (void)state;
    /* Both are 1 m across the body's x, 2 m along its z, as the body is. To leave one of them it
     * goes 0.5 m to the west, to leave the other 0.25 m to the north. */
    boxes.other[0] = put(1.5, -1.5, 0.0);
    boxes.other[1] = put(-1.5, 3.75, 0.0);
    double way = way_out(&boxes, &normal);
    assert_true(fabs(way - sqrt(0.51 * 0.51 + 0.26 * 0.26)) < 1e-9);
    assert_true(fabs(normal.x * way - 0.51) < 1e-9 && fabs(normal.z * way - 0.26) < 1e-9);
}

static void test_a_gap_that_is_too_narrow_is_no_way_out(void **state)
{
    struct boxes boxes = {.body = put(0.0, 0.0, 0.0), .count = 2};
    struct vec3 normal = {0.0, 0.0, 0.0};
    (void)state;
    boxes.other[0] = put(1.9, 0.0, 0.0);
    boxes.other[1] = put(-2.115, 0.0, 0.0);
    assert_true(way_out(&boxes, &normal) > 3.0);
    boxes.other[1] = put(-2.125, 0.0, 0.0);
    assert_true(fabs(way_out(&boxes, &normal) - 0.11) < 1e-9);
}

/* Returns a box on ground that rises to the north by an angle, so far up it. */
static struct swept_body put_on_slope(double up_m, double angle_rad)
{
    struct swept_body body = put(0.0, 0.0, 0.0);
    double sine, cosine;
    maths_sincos(angle_rad, &sine, &cosine);
    body.from = body.to = rotation_of(0.0, angle_rad, 0.0);
    body.path.at = (struct vec3){0.0, up_m * sine, -up_m * cosine};
    return body;
}

/* Two boxes that lean with the ground are 1.5 m in each other along it. Level ways are longer, and
 * who tried to go them on the ground came deeper into the other body. */
static void test_a_way_along_a_slope_rises_with_it(void **state)
{
    const double angle = 0.4;
    const struct swept_body body = put_on_slope(0.0, angle), other = put_on_slope(2.5, angle);
    double sine, cosine;
    struct vec3 normal = {0.0, 0.0, 0.0};
    (void)state;
    maths_sincos(angle, &sine, &cosine);
    double way =
        level_exit_of(&search, (struct exit_slope){0.0, -sine / cosine}, &body, &other, &normal);
    assert_true(fabs(way - 1.5 * cosine - CLEAR_M) < 1e-9);
    assert_true(fabs(normal.z + 1.0) < 1e-9);
    assert_true(fabs(level_exit_of(&search, level, &body, &other, &normal) - 1.5 / cosine -
                     CLEAR_M) < 1e-9);
}

static void test_no_way_leads_through_what_bars_it(void **state)
{
    const struct swept_body body = put(0.0, 0.0, 0.0);
    const struct swept_body left = put(1.5, 0.0, 0.0), bar = put(-2.2, 0.0, 0.0);
    struct vec3 normal = {0.0, 0.0, 0.0};
    (void)state;
    level_exit_begin(&search, level);
    level_exit_add(&search, &body, &left, false);
    level_exit_add(&search, &body, &bar, true);
    assert_true(fabs(level_exit_find(&search, true, &normal) - 3.51) < 1e-9);
    assert_true(fabs(normal.x + 1.0) < 1e-9);
}

/* Returns the least separation of the body, moved against the normal, from others first .. end - 1.
 */
static double separation_from(const struct boxes *boxes, uint32_t first, uint32_t end,
                              struct vec3 normal, double way_m)
{
    struct boxes some = {.body = boxes->body, .count = end - first};
    for (uint32_t i = first; i < end; i++)
        some.other[i - first] = boxes->other[i];
    return separation_after(&some, normal, way_m);
}

/* Returns true if a body that goes so far against the normal meets none of the others from first
 * on. */
static bool passes(const struct boxes *boxes, uint32_t first, struct vec3 normal, double way_m)
{
    for (double far = 0.0; far < way_m; far += 0.2 * STEP_M) {
        if (separation_from(boxes, first, boxes->count, normal, far) < -1e-6)
            return false;
    }
    return true;
}

/* The last boxes bar the way: none leads through them, not even where a turn behind them is near,
 * and along no direction that is free of them one is out sooner. */
static void test_ways_around_what_bars_them_are_the_shortest(void **state)
{
    uint64_t random = fixture_seed(7);
    uint32_t ways = 0;
    (void)state;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        struct boxes boxes = random_boxes(&random);
        const uint32_t bars = boxes.count / 2;
        struct vec3 normal = {0.0, 0.0, 0.0};
        for (uint32_t i = bars; i < boxes.count; i++)
            boxes.other[i].path.at = vec3_scale(boxes.other[i].path.at, FARTHER);
        if (bars == 0 || separation_from(&boxes, bars, boxes.count, normal, 0.0) < 0.0)
            continue;
        level_exit_begin(&search, level);
        for (uint32_t i = 0; i < boxes.count; i++)
            level_exit_add(&search, &boxes.body, &boxes.other[i], i >= bars);
        double way = level_exit_find(&search, true, &normal);
        if (way == INFINITY)
            continue;
        ways++;
        assert_true(separation_from(&boxes, 0, bars, normal, way) >= CLEAR_M - 1e-6);
        assert_true(passes(&boxes, bars, normal, way));
        for (uint32_t i = 0; i < DIRECTIONS; i++) {
            struct vec3 along = {0.0, 0.0, 0.0};
            maths_sincos(i * TWO_PI / DIRECTIONS, &along.x, &along.z);
            for (double far = STEP_M; far < way - 1e-6; far += STEP_M)
                assert_true(separation_from(&boxes, 0, bars, along, far) < CLEAR_M ||
                            !passes(&boxes, bars, along, far));
        }
    }
    print_message("%u ways\n", ways);
    assert_true(ways > ROUNDS / 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_way_is_the_shortest_and_leads_out),
        cmocka_unit_test(test_the_rest_of_the_way_is_the_way_from_there),
        cmocka_unit_test(test_a_body_leaves_two_boxes_where_they_meet),
        cmocka_unit_test(test_a_gap_that_is_too_narrow_is_no_way_out),
        cmocka_unit_test(test_a_way_along_a_slope_rises_with_it),
        cmocka_unit_test(test_no_way_leads_through_what_bars_it),
        cmocka_unit_test(test_ways_around_what_bars_them_are_the_shortest),
    };
    return cmocka_run_group_tests(tests, open_search, close_search);
}
