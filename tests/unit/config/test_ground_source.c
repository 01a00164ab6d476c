/* Scenarios on ground files: which file is meant, what of it counts, and what is refused. */
#include "config/ground_source.h"

#include "supervisor/ground/ground_write.h"
#include "tests/support/quick_config.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/terrain/ground_tile.h"
#include "world/terrain/terrain.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define SIDE 401u
#define TEXT "terrain = { source = \"file\"; file = \"x.ground\"; };"

static float posts[SIDE * SIDE];
static uint8_t cover[SIDE * SIDE];
static char path[96];
static struct error_text error;

/* Writes a ground with a slope to the east and with roads beside the scenario. Returns its hash. */
static uint64_t put_ground_with(double side_m, double rise_m, const struct ground_road_point *roads,
                                uint32_t road_points)
{
    struct ground_header header = {.latitude_deg = 44.5,
                                   .longitude_deg = -71.25,
                                   .side_m = side_m,
                                   .spacing_m = side_m / (SIDE - 1),
                                   .undulation_m = -28.5,
                                   .posts_side = SIDE};
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        posts[i] = ground_tile_round(rise_m * (i % SIDE));
    snprintf(path, sizeof path, "%s/x.ground", quick_config.folder);
    const struct ground_content content = {
        .posts = posts, .cover = cover, .text = "", .roads = roads, .road_points = road_points};
    assert_int_equal(ground_write(path, &header, &content, NULL, &error), 0);
    return header.hash;
}

static uint64_t put_ground(double side_m, double rise_m)
{
    return put_ground_with(side_m, rise_m, NULL, 0);
}

static void must_load(struct scenario *scenario, const char *text, const char *override)
{
    if (quick_config_load(scenario, text, override, &error) != 0)
        fail_msg("refused: %s", error.text);
}

static void refused(const char *text, const char *override, const char *because)
{
    struct scenario s;
    assert_int_equal(quick_config_load(&s, text, override, &error), -1);
    if (!strstr(error.text, because))
        fail_msg("\"%s\" does not say \"%s\"", error.text, because);
}

static void test_a_world_has_the_posts_of_its_file(void **state)
{
    struct scenario s;
    struct world_build built;
    (void)state;
    uint64_t hash = put_ground(50000.0, 0.5);
    must_load(&s, TEXT, NULL);
    assert_true(s.settings->ground_hash == hash);
    assert_int_equal(s.settings->objects, OBJECTS_FILE);
    assert_int_equal(world_build_make(&built, &s, &error), 0);
    assert_int_equal(built.counts.posts_side, SIDE);
    assert_memory_equal(built.posts, posts, sizeof posts);
    assert_memory_equal(built.cover, cover, sizeof cover);
    world_build_free(&built);
    /* The file becomes another one between the two readings. */
    put_ground(50000.0, 0.25);
    assert_int_equal(world_build_make(&built, &s, &error), -1);
    assert_non_null(strstr(error.text, "has changed since the scenario was read"));
    scenario_free(&s);
}

static void test_the_hash_of_the_ground_is_a_part_of_the_scenario(void **state)
{
    struct scenario one, other, named;
    char set[128], kept[160];
    (void)state;
    put_ground(50000.0, 0.5);
    must_load(&one, TEXT, NULL);
    snprintf(set, sizeof set, "terrain.file=%s", path);
    must_load(&named, TEXT, set);
    uint64_t hash = put_ground(50000.0, 0.25);
    must_load(&other, TEXT, NULL);
    assert_true(one.settings->params.scenario_hash == named.settings->params.scenario_hash);
    assert_true(one.settings->params.scenario_hash != other.settings->params.scenario_hash);
    snprintf(kept, sizeof kept, "%016lx %s", (unsigned long)hash, path);
    assert_string_equal(provenance_find(other.recipe.text, other.recipe.bytes, "ground"), kept);
    assert_string_equal(provenance_find(named.recipe.text, named.recipe.bytes, "set"), set);
    scenario_free(&one);
    scenario_free(&other);
    scenario_free(&named);
}

static void test_the_gateway_is_where_the_ground_is(void **state)
{
    struct scenario s;
    (void)state;
    put_ground(50000.0, 0.5);
    must_load(&s, TEXT, NULL);
    assert_true(s.settings->params.gateway.latitude_deg == 44.5);
    assert_true(s.settings->params.gateway.longitude_deg == -71.25);
    assert_true(s.settings->params.gateway.undulation_m == -28.5);
    scenario_free(&s);
    must_load(&s, TEXT "gateway = { latitude_deg = 10.0; };", "gateway.undulation_m=3");
    assert_true(s.settings->params.gateway.latitude_deg == 10.0);
    assert_true(s.settings->params.gateway.longitude_deg == -71.25);
    assert_true(s.settings->params.gateway.undulation_m == 3.0);
    scenario_free(&s);
}

static void test_a_small_square_lies_in_the_middle(void **state)
{
    struct scenario s;
    struct world_build built;
    const uint32_t first = 800; /* 20 km at 25 m */
    (void)state;
    memset(cover, COVER_FOREST, sizeof cover);
    cover[7] = COVER_ROAD;
    cover[9] = COVER_SEA;
    put_ground(10000.0, 0.5);
    must_load(&s, TEXT, NULL);
    assert_int_equal(world_build_make(&built, &s, &error), 0);
    assert_int_equal(built.counts.posts_side, 2001);
    for (uint32_t row = 0; row < SIDE; row++) {
        const size_t at = (size_t)(first + row) * 2001 + first;
        assert_memory_equal(built.posts + at, posts + row * SIDE, SIDE * sizeof *posts);
        assert_memory_equal(built.cover + at, cover + row * SIDE, SIDE);
    }
    /* Far away the ground has the mean height of the edge, whose western posts have 0 m and the
     * eastern ones 200 m; the sea goes on, and roads do not. */
    assert_true(fabs((double)built.posts[0] - 100.0) < 0.01);
    assert_true(built.posts[(size_t)1000 * 2001 + first - 1] < 0.1f);
    assert_true(fabs((double)built.posts[(size_t)1000 * 2001] - 100.0) < 0.01);
    assert_int_equal(built.cover[0], COVER_FOREST);
    assert_int_equal(built.cover[first + 7], COVER_FOREST);
    assert_int_equal(built.cover[(size_t)(first - 1) * 2001 + first + 7], COVER_FOREST);
    assert_int_equal(built.cover[first + 9], COVER_SEA);
    assert_true(built.posts[first + 9] == posts[9]);
    world_build_free(&built);
    scenario_free(&s);
    memset(cover, COVER_GRASS, sizeof cover);
}

/* Its own if it does not fit into 50 km, or another that holds it. */
static void test_a_world_has_the_side_of_its_file(void **state)
{
    static const struct {
        double file_m;
        const char *override;
        double side_m;
        uint32_t posts;
    } rows[] = {{60000.0, NULL, 60000.0, 401},
                {6000.0, NULL, 6000.0, 401},
                {500000.0, NULL, 500000.0, 401},
                {10000.0, "terrain.side_m=10000", 10000.0, 401},
                {10000.0, "terrain.side_m=12000", 12000.0, 481},
                {100000.0, "terrain.side_m=200000", 200000.0, 801}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct scenario s;
        struct world_build built;
        put_ground(rows[i].file_m, 0.5);
        must_load(&s, TEXT, rows[i].override);
        assert_true(s.settings->side_m == rows[i].side_m);
        assert_true(s.areas[0].x1 == rows[i].side_m && s.areas[0].z1 == rows[i].side_m);
        assert_int_equal(world_build_make(&built, &s, &error), 0);
        assert_int_equal(built.counts.posts_side, rows[i].posts);
        assert_int_equal(built.counts.side_m, rows[i].side_m);
        struct terrain terrain = world_build_terrain(&built);
        assert_true(terrain.squares.world_m == rows[i].side_m);
        assert_true(terrain.spacing_m == rows[i].file_m / (SIDE - 1));
        double middle = terrain_base_height(&terrain, 0.5 * rows[i].side_m, 0.5 * rows[i].side_m);
        assert_true(fabs(middle - 100.0) < 0.02);
        world_build_free(&built);
        scenario_free(&s);
    }
}

/* Roads keep their millimetres at the far corner of the largest square. */
static void test_roads_are_exact(void **state)
{
    const struct ground_road_point roads[] = {
        {1, 2, 0}, {499999999, 499999998, 0}, {333333333, 7, 1}, {333333334, 499999997, 1}};
    struct scenario s;
    struct world_build built;
    (void)state;
    uint64_t hash = put_ground_with(500000.0, 0.5, roads, 4);
    assert_true(hash != put_ground(500000.0, 0.5) &&
                hash == put_ground_with(500000.0, 0.5, roads, 4));
    must_load(&s, TEXT, NULL);
    assert_int_equal(world_build_make(&built, &s, &error), 0);
    assert_int_equal(built.counts.road_points, 4);
    for (int i = 0; i < 4; i++) {
        assert_true(built.roads[i].x == roads[i].x_mm / 1000.0);
        assert_true(built.roads[i].z == roads[i].z_mm / 1000.0);
        assert_int_equal(built.roads[i].road, roads[i].road);
    }
    world_build_free(&built);
    scenario_free(&s);
}

static void test_refusals(void **state)
{
    (void)state;
    unlink(path);
    refused(TEXT, NULL, "battle.cfg:1: terrain.file = x.ground: no such file");
    refused("terrain = { source = \"file\"; };", NULL,
            "needs a ground file; right would be: terrain.file = ");
    refused("terrain = { file = \"x.ground\"; };", NULL, "needs terrain.source = \"file\"");
    put_ground(60000.0, 0.5);
    refused(TEXT, "terrain.side_m=50000",
            "its square has a side of 60000 m, and terrain.side_m is 50000");
    put_ground(6000.0, 0.5);
    refused(TEXT, "terrain.side_m=50000",
            "its posts are 15 m apart, which are no posts of a world of 50 km");
    put_ground(4000.0, 0.5);
    refused(TEXT, "terrain.side_m=50000", "its posts are 10 m apart");
    refused(TEXT, "terrain.side_m=50001", "terrain.side_m = 50001: is no multiple of 125 m");
    refused("terrain = { side_m = 60000.0; };", NULL, "generated ground has 50 km");
    refused("terrain = { source = \"flat\"; side_m = 200000.0; };", NULL,
            "has too many posts for terrain.spacing_m");
    refused(TEXT "vehicles = ( { kind = \"tank\"; at = [4000.5, 100]; } );", NULL,
            "vehicles[0].at = [4000.5, 100]: out of range; allowed: [x, z], each 0..4000 m");
    quick_config_write(path, "nonsense");
    refused(TEXT, NULL, "is no ground file");
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_world_has_the_posts_of_its_file),
        cmocka_unit_test(test_the_hash_of_the_ground_is_a_part_of_the_scenario),
        cmocka_unit_test(test_the_gateway_is_where_the_ground_is),
        cmocka_unit_test(test_a_small_square_lies_in_the_middle),
        cmocka_unit_test(test_a_world_has_the_side_of_its_file),
        cmocka_unit_test(test_roads_are_exact),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, quick_config_make, quick_config_remove);
}
