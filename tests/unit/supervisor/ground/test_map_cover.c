/* Coastlines: what lies on their right becomes sea, also where their corners are on posts. */
#include "supervisor/ground/map_cover.h"

#include "world/terrain/terrain.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define SIDE 11u

static uint8_t cover[SIDE * SIDE];

/* Makes the sea of a coastline in 11 x 11 posts of land, 2 m apart. */
static struct map_cover_sea make(double (*place)[2], uint32_t count)
{
    static float posts[SIDE * SIDE];
    struct feature_line line = {place, count, 0.0};
    const struct features features = {.line = &line, .lines = 1};
    const struct post_grid grid = {.projection.middle_m = 10.0, .side = SIDE, .spacing_m = 2.0};
    struct map_cover_sea sea;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        posts[i] = 5.0f;
        cover[i] = COVER_GRASS;
    }
    assert_int_equal(map_cover_coasts(&features, &grid, posts, cover, &sea), 0);
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        assert_true((cover[i] == COVER_SEA) == (posts[i] == 0.0f));
    return sea;
}

/* An island whose four corners lie on posts, drawn from each of them, at each place in and around
 * the square: the posts within are land and those outside are sea. */
static void test_corners_may_lie_on_posts(void **state)
{
    (void)state;
    const int corner[4][2] = {{0, -3}, {-3, 0}, {0, 3}, {3, 0}};
    for (int i = 0; i < 4 * 15 * 15; i++) {
        int x = i / 4 % 15 - 2, z = i / 60 - 2, all = 0;
        double place[5][2];
        for (int k = 0; k < 5; k++) {
            place[k][0] = 2.0 * (x + corner[(i + k) % 4][0]);
            place[k][1] = 2.0 * (z + corner[(i + k) % 4][1]);
        }
        struct map_cover_sea sea = make(place, 5);
        assert_int_equal(sea.torn, 0);
        for (int post = 0; post < (int)(SIDE * SIDE); post++) {
            int away = abs(post % (int)SIDE - x) + abs(post / (int)SIDE - z);
            all += away < 3;
            if (away != 3 && sea.posts > 0)
                assert_int_equal(cover[post] == COVER_SEA, away > 3);
        }
        assert_true(sea.posts > 0 || all == 0);
    }
}

static void test_a_coast_between_two_rows_parts_them(void **state)
{
    (void)state;
    double south[2][2] = {{-1.0, 9.0}, {21.0, 9.5}}, north[2][2] = {{21.0, 9.5}, {-1.0, 9.0}};
    assert_int_equal(make(south, 2).posts, 6 * SIDE);
    assert_int_equal(cover[4 * SIDE], COVER_GRASS);
    assert_int_equal(make(north, 2).posts, 5 * SIDE);
    assert_int_equal(cover[5 * SIDE], COVER_GRASS);
}

static void test_what_lies_between_posts_makes_no_sea(void **state)
{
    (void)state;
    double islet[4][2] = {{4.5, 4.5}, {4.5, 5.5}, {5.5, 5.0}, {4.5, 4.5}};
    struct map_cover_sea sea = make(islet, 4);
    assert_int_equal(sea.posts, 0);
    assert_true(sea.coast && sea.coast_x == 4.5 && sea.coast_z == 4.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_corners_may_lie_on_posts),
        cmocka_unit_test(test_a_coast_between_two_rows_parts_them),
        cmocka_unit_test(test_what_lies_between_posts_makes_no_sea),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
