/* Outlines of buildings split into convex parts. */
#include "supervisor/ground/convex_parts.h"

#include "tests/support/fixture.h"
#include "world/maths/maths.h"
#include "world/maths/random.h"
#include "world/terrain/ground_file.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct convex_parts parts;

static enum convex_parts_result split(int32_t (*corner)[2], uint32_t count)
{
    struct convex_parts_ring ring = {corner, count};
    convex_parts_free(&parts);
    return convex_parts_split(&parts, &ring, 1);
}

/* Twice the area of a part; positive: clockwise. */
static int64_t twice_area(const struct convex_parts_ring *ring)
{
    int64_t area = 0;
    for (uint32_t i = 0; i < ring->count; i++) {
        const int32_t *a = ring->corner[i], *b = ring->corner[(i + 1) % ring->count];
        area += (int64_t)a[0] * b[1] - (int64_t)a[1] * b[0];
    }
    return area;
}

static void parts_are_convex(int64_t area)
{
    int64_t sum = 0;
    for (uint32_t i = 0; i < parts.count; i++) {
        struct ground_corner corner[GROUND_PART_CORNERS_MAX];
        const struct convex_parts_ring *part = &parts.part[i];
        assert_in_range(part->count, 3, GROUND_PART_CORNERS_MAX);
        for (uint32_t k = 0; k < part->count; k++)
            corner[k] = (struct ground_corner){part->corner[k][0] - part->corner[0][0],
                                               part->corner[k][1] - part->corner[0][1], 0};
        sum += twice_area(part);
        /* Only a part that is too narrow may fail. */
        if (twice_area(part) > 100000000)
            assert_true(ground_file_part_fits(corner, part->count));
    }
    assert_true(sum == area);
}

static void test_shapes_have_few_parts(void **state)
{
    int32_t box[][2] = {{0, 0}, {0, 8000}, {10000, 8000}, {10000, 0}, {0, 0}};
    int32_t angled[][2] = {{0, 0}, {9000, 0}, {9000, 4000}, {4000, 4000}, {4000, 9000}, {0, 9000}};
    int32_t horseshoe[][2] = {{0, 0},       {9000, 0},    {9000, 9000}, {6000, 9000},
                              {6000, 3000}, {3000, 3000}, {3000, 9000}, {0, 9000}};
    (void)state;
    assert_int_equal(split(box, 5), CONVEX_PARTS_GOOD);
    assert_int_equal(parts.count, 1);
    assert_int_equal(parts.part[0].count, 4);
    assert_true(parts.area_m2 == 80.0);
    assert_int_equal(split(angled, 6), CONVEX_PARTS_GOOD);
    assert_int_equal(parts.count, 2);
    parts_are_convex(2 * (9000 * 4000 + 4000 * 5000));
    assert_int_equal(split(horseshoe, 8), CONVEX_PARTS_GOOD);
    assert_in_range(parts.count, 3, 4);
    parts_are_convex(2 * (9000 * 3000 + 2 * 3000 * 6000));
}

static void test_repeated_and_straight_corners_do_not_matter(void **state)
{
    int32_t box[][2] = {{0, 0},    {0, 0},       {5000, 0},    {9000, 0}, {9000, 9000},
                        {9000, 0}, {9000, 9000}, {4000, 9000}, {0, 9000}};
    (void)state;
    assert_int_equal(split(box, 9), CONVEX_PARTS_GOOD);
    assert_int_equal(parts.count, 1);
    assert_int_equal(parts.part[0].count, 4);
    parts_are_convex(2 * (int64_t)9000 * 9000);
}

static void test_courtyards_stay_open(void **state)
{
    int32_t outer[][2] = {{0, 0}, {30000, 0}, {30000, 20000}, {0, 20000}};
    int32_t first[][2] = {{5000, 5000}, {10000, 5000}, {10000, 15000}, {5000, 15000}};
    int32_t second[][2] = {{20000, 5000}, {20000, 15000}, {25000, 15000}, {25000, 5000}};
    struct convex_parts_ring rings[] = {{outer, 4}, {first, 4}, {second, 4}};
    (void)state;
    convex_parts_free(&parts);
    assert_int_equal(convex_parts_split(&parts, rings, 3), CONVEX_PARTS_GOOD);
    parts_are_convex(2 * (int64_t)(30000 * 20000 - 2 * 5000 * 10000));
    for (uint32_t i = 0; i < parts.count; i++) {
        double x = 0.0, z = 0.0;
        for (uint32_t k = 0; k < parts.part[i].count; k++) {
            x += (double)parts.part[i].corner[k][0] / parts.part[i].count;
            z += (double)parts.part[i].corner[k][1] / parts.part[i].count;
        }
        bool inside =
            z > 5000 && z < 15000 && ((x > 5000 && x < 10000) || (x > 20000 && x < 25000));
        assert_false(inside);
    }
}

static void test_outlines_that_cross_themselves_are_told(void **state)
{
    int32_t bow[][2] = {{0, 0}, {9000, 9000}, {9000, 0}, {0, 9000}};
    int32_t nothing[][2] = {{0, 0}, {9000, 9000}, {0, 0}, {9000, 9000}};
    int32_t point[][2] = {{5, 5}};
    (void)state;
    assert_int_equal(split(bow, 4), CONVEX_PARTS_TANGLED);
    assert_int_equal(split(nothing, 4), CONVEX_PARTS_EMPTY);
    assert_int_equal(split(point, 1), CONVEX_PARTS_EMPTY);
    assert_int_equal(split(point, 0), CONVEX_PARTS_EMPTY);
}

/* Stars of random rays: some of them deeply hollow, none across itself. */
static void test_random_outlines_are_split_exactly(void **state)
{
    uint64_t seed = fixture_seed(1);
    (void)state;
    for (uint64_t n = 0; n < 2000; n++) {
        uint32_t count = 3 + (uint32_t)(random_u64(seed, n, 0, RANDOM_NOISE) % 40);
        int32_t corner[48][2], before[48][2];
        for (uint32_t i = 0; i < count; i++) {
            double ray = random_between(seed, n, 2 * i + 1, RANDOM_NOISE, 1500.0, 30000.0);
            double turn =
                TWO_PI * (i + 0.8 * random_unit(seed, n, 2 * i + 2, RANDOM_NOISE)) / count;
            double sine, cosine;
            maths_sincos(turn, &sine, &cosine);
            corner[i][0] = 1000000 + (int32_t)(ray * sine);
            corner[i][1] = 2000000 - (int32_t)(ray * cosine);
        }
        memcpy(before, corner, sizeof before);
        const struct convex_parts_ring whole = {before, count};
        enum convex_parts_result result = split(corner, count);
        /* Three rays may be on one side of the middle, so that the star is none. */
        if (result == CONVEX_PARTS_TANGLED && count < 6)
            continue;
        if (result != CONVEX_PARTS_GOOD)
            fail_msg("outline %llu of %u corners: %d", (unsigned long long)n, count, (int)result);
        int64_t area = twice_area(&whole);
        parts_are_convex(area < 0 ? -area : area);
    }
}

/* As many corners as an outline of OpenStreetMap has at most, and twice as many in a relation. */
static void test_large_outlines_are_split(void **state)
{
    static int32_t corner[CONVEX_PARTS_CORNERS_MAX][2], before[CONVEX_PARTS_CORNERS_MAX][2];
    const uint32_t counts[] = {500, 2000, CONVEX_PARTS_CORNERS_MAX - 2};
    (void)state;
    for (uint32_t n = 0; n < sizeof counts / sizeof counts[0]; n++) {
        for (uint32_t i = 0; i < counts[n]; i++) {
            double sine, cosine, ray = i % 2 ? 200000.0 : 100000.0;
            maths_sincos(TWO_PI * i / counts[n], &sine, &cosine);
            corner[i][0] = 1000000 + (int32_t)(ray * sine);
            corner[i][1] = 2000000 - (int32_t)(ray * cosine);
        }
        memcpy(before, corner, sizeof before);
        const struct convex_parts_ring whole = {before, counts[n]};
        assert_int_equal(split(corner, counts[n]), CONVEX_PARTS_GOOD);
        parts_are_convex(llabs(twice_area(&whole)));
    }
}

static void test_the_smallest_rectangle_is_found(void **state)
{
    int32_t house[4][2];
    struct convex_parts_box box;
    double sine, cosine;
    (void)state;
    maths_sincos(0.5, &sine, &cosine);
    for (int i = 0; i < 4; i++) {
        double along = i == 0 || i == 3 ? 6000.0 : -6000.0, across = i < 2 ? 4000.0 : -4000.0;
        house[i][0] = (int32_t)floor(70000.0 + along * sine + across * cosine + 0.5);
        house[i][1] = (int32_t)floor(90000.0 - along * cosine + across * sine + 0.5);
    }
    assert_true(convex_parts_box_of(&box, house, 4));
    assert_true(fabs(box.x_mm - 70000.0) < 1.0 && fabs(box.z_mm - 90000.0) < 1.0);
    assert_true(fabs(box.half_length_mm - 6000.0) < 1.0 && fabs(box.half_width_mm - 4000.0) < 1.0);
    /* Either end may be the front. */
    double heading = box.turn * (TWO_PI / 65536.0);
    assert_true(fabs(heading - 0.5) < 2e-4 || fabs(heading - 0.5 - PI) < 2e-4);
    assert_false(convex_parts_box_of(&box, house, 1));
}

static int forget(void **state)
{
    (void)state;
    convex_parts_free(&parts);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes_have_few_parts),
        cmocka_unit_test(test_repeated_and_straight_corners_do_not_matter),
        cmocka_unit_test(test_courtyards_stay_open),
        cmocka_unit_test(test_outlines_that_cross_themselves_are_told),
        cmocka_unit_test(test_random_outlines_are_split_exactly),
        cmocka_unit_test(test_large_outlines_are_split),
        cmocka_unit_test(test_the_smallest_rectangle_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, forget);
}
