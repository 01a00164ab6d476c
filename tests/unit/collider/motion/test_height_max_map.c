/* Squares' crests: who is told to stay above them never meets the ground, whatever was asked
 * before. */
#include "collider/motion/height_max_map.h"

#include "collider/geometry/analytic_impact.h"
#include "tests/support/fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define SIDE    401 /* squares are cells */
#define CRATERS 2000
#define WAYS    100000

static struct terrain ground;
static struct height_max_map crest;
static struct crater_index craters;
static struct crater dug[CRATERS];

/* Hills of 80 m from 1,500 m below the sea to 9,000 m above it. */
static void raise(uint64_t *random, double spacing_m)
{
    uint32_t side = (uint32_t)(WORLD_SIDE_M / spacing_m) + 1;
    float *posts = malloc((size_t)side * side * sizeof *posts);
    assert_non_null(posts);
    for (uint32_t i = 0; i < side * side; i++)
        posts[i] = (float)(10500.0 * (i % side) / side - 1500.0 + fixture_uniform(random, 0, 80));
    ground = (struct terrain){.posts = posts, .side = side, .spacing_m = spacing_m};
}

static void lower(void)
{
    free((void *)(uintptr_t)ground.posts);
    height_max_map_free(&crest);
    crater_index_free(&craters);
}

static void open_ground(uint64_t *random, double spacing_m)
{
    raise(random, spacing_m);
    for (uint32_t i = 0; i < CRATERS; i++)
        dug[i] = (struct crater){fixture_uniform(random, 0.0, WORLD_SIDE_M),
                                 fixture_uniform(random, 0.0, WORLD_SIDE_M), 40.0f, 60.0f, 1};
    assert_int_equal(crater_index_init(&craters, dug), 0);
    crater_index_update(&craters, CRATERS);
    assert_int_equal(height_max_map_init(&crest, &ground), 0);
}

/* A way of up to 200 m near the ground, often from or to a crater's lip or a square's border. */
static struct path draw(uint64_t *random)
{
    const struct crater *crater = &dug[fixture_random(random) % CRATERS];
    struct vec3 at = {fixture_uniform(random, -100.0, WORLD_SIDE_M + 100.0), 0.0,
                      fixture_uniform(random, 0.0, WORLD_SIDE_M)};
    if (fixture_random(random) % 2)
        at = (struct vec3){crater->x + 40.0, 0.0, crater->z};
    if (fixture_random(random) % 4 == 0)
        at.x = GRIDSQUARE_SIDE_M * (double)(fixture_random(random) % GRIDSQUARE_PER_SIDE);
    at.y = terrain_height(&ground, &craters, at.x, at.z) + fixture_uniform(random, 0.0, 120.0);
    return (struct path){.at = at,
                         .along = {fixture_uniform(random, -140.0, 140.0),
                                   fixture_uniform(random, -60.0, 30.0),
                                   fixture_uniform(random, -140.0, 140.0)}};
}

static void check_ways(uint64_t *random)
{
    uint32_t above = 0, met = 0;
    for (uint32_t i = 0; i < WAYS; i++) {
        struct path path = draw(random);
        struct vec3 to = path_at(&path, 1.0);
        double toi;
        bool below = height_max_map_below(&crest, &craters, path.at, to);
        bool meets = analytic_impact_ground(&ground, &craters, &path, &toi);
        assert_false(below && meets);
        assert_true(height_max_map_below(&crest, &craters, path.at, to) == below);
        above += below;
        met += meets;
    }
    print_message("%u of %u ways are above the crests, %u meet the ground\n", above, WAYS, met);
    assert_true(above > WAYS / 20 && met > WAYS / 20);
}

static void test_who_is_above_never_meets_the_ground(void **state)
{
    uint64_t random = fixture_seed(2026);
    static const double spacings[] = {125.0, 62.5};
    (void)state;
    for (uint32_t i = 0; i < sizeof spacings / sizeof spacings[0]; i++) {
        open_ground(&random, spacings[i]);
        check_ways(&random);
        lower();
    }
}

static void test_the_highest_post_of_the_square_counts_and_none_beyond_it(void **state)
{
    static float posts[SIDE * SIDE];
    const struct terrain flat = {.posts = posts, .side = SIDE, .spacing_m = 125.0};
    struct vec3 at = {25.0 * 125.0 + 60.0, 11.0, 40.0 * 125.0 + 60.0};
    struct vec3 west = {at.x - 300.0, at.y, at.z}, beside = {at.x + 100.0, at.y, at.z};
    (void)state;
    posts[41 * SIDE + 26] = 50.0f; /* the square's south-eastern corner */
    assert_int_equal(height_max_map_init(&crest, &flat), 0);
    assert_false(height_max_map_below(&crest, NULL, at, at));
    assert_false(height_max_map_below(&crest, NULL, west, beside));
    assert_true(height_max_map_below(&crest, NULL, west, west));
    at.y = west.y = 51.0;
    assert_true(height_max_map_below(&crest, NULL, at, west));
    height_max_map_free(&crest);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_who_is_above_never_meets_the_ground),
        cmocka_unit_test(test_the_highest_post_of_the_square_counts_and_none_beyond_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
