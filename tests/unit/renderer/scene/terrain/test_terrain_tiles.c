/* The cache of ground tiles: what is made when, stand-ins, and the effect of craters. */
#include "renderer/scene/terrain/terrain_tiles.h"

#include "renderer/scene/terrain/terrain_colour.h"
#include "world/road_index.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define POSTS   401u
#define SPACING 125.0

/* Hills of grass and chaparral, sea in the west, a road across. */
struct terrain_context {
    struct world world;
    struct frame_view frame_view;
    struct crater craters[8];
    struct crater_index index;
    struct road_index roads;
    struct road_point road[3];
    struct terrain_tiles tiles;
    float posts[POSTS * POSTS];
    uint8_t cover[POSTS * POSTS];
};

static int open_country(void **context)
{
    struct terrain_context *c = calloc(1, sizeof *c);
    assert_non_null(c);
    for (uint32_t row = 0; row < POSTS; row++)
        for (uint32_t column = 0; column < POSTS; column++) {
            bool sea = column < 60;
            c->posts[row * POSTS + column] =
                sea ? 0.0f
                    : (float)(200.0 + 150.0 * sin(column * 0.11) * cos(row * 0.07) +
                              20.0 * sin(column * 0.9 + row));
            c->cover[row * POSTS + column] =
                (uint8_t)(sea                          ? COVER_SEA
                          : (column / 7 + row / 5) % 3 ? COVER_GRASS
                                                       : COVER_CHAPARRAL);
        }
    c->road[0] = (struct road_point){.x = 20000.0f, .z = 21000.0f, .road = 1};
    c->road[1] = (struct road_point){.x = 26000.0f, .z = 25100.0f, .road = 1};
    c->road[2] = (struct road_point){.x = 31000.0f, .z = 25100.0f, .road = 1};
    c->world.terrain = (struct terrain){.posts = c->posts,
                                        .cover = c->cover,
                                        .side = POSTS,
                                        .spacing_m = SPACING,
                                        .squares = GRIDSQUARES_DEFAULT_INIT};
    c->world.road_points = c->road;
    c->world.counts.road_points = 3;
    assert_int_equal(crater_index_init(&c->index, &GRIDSQUARES_DEFAULT, c->craters), 0);
    assert_int_equal(terrain_tiles_init(&c->tiles), 0);
    assert_int_equal(road_index_make(&c->roads, c->road, 3, WORLD_SIDE_DEFAULT_M), 0);
    c->frame_view =
        (struct frame_view){.world = &c->world, .craters = &c->index, .roads = &c->roads};
    *context = c;
    return 0;
}

static int close_country(void **context)
{
    struct terrain_context *c = *context;
    terrain_tiles_free(&c->tiles);
    crater_index_free(&c->index);
    road_index_free(&c->roads);
    free(c);
    return 0;
}

/* Fills in patches of a level from a corner on, row by row. */
static uint32_t block(struct terrain_quadtree_patch *patches, int32_t level, int32_t column,
                      int32_t row, int32_t wide)
{
    uint32_t n = 0;
    for (int32_t r = 0; r < wide; r++)
        for (int32_t c = 0; c < wide; c++)
            patches[n++] = (struct terrain_quadtree_patch){
                .column = column + c, .row = row + r, .level = level};
    return n;
}

/* Returns the patch of a level at a place. */
static struct terrain_quadtree_patch at(int32_t level, double x, double z)
{
    double side = terrain_quadtree_patch_side(level);
    return (struct terrain_quadtree_patch){
        .column = (int32_t)floor(x / side), .row = (int32_t)floor(z / side), .level = level};
}

static void dig(struct terrain_context *c, double x, double z, float radius_m)
{
    c->craters[c->index.count] =
        (struct crater){.x = x, .z = z, .radius_m = radius_m, .depth_m = 0.3f * radius_m};
    crater_index_update(&c->index, c->index.count + 1);
}

static void assert_own(const struct tile_view *view)
{
    assert_ptr_equal(view->texture_tile, view->tile);
    assert_true(view->at_u == 0.0f && view->at_v == 0.0f && view->share == 1.0f);
}

static void test_makes_all_without_a_budget(void **context)
{
    struct terrain_context *c = *context;
    struct terrain_quadtree_patch patches[16];
    uint32_t count = block(patches, 8, 90, 95, 4);
    terrain_tiles_update(&c->tiles, patches, count, &c->frame_view, TERRAIN_TILES_ALL);
    assert_int_equal(c->tiles.view_count, count);
    assert_int_equal(c->tiles.textures_made, count);
    assert_int_equal(c->tiles.waiting, 0);
    for (uint32_t i = 0; i < count; i++) {
        const struct tile_view *view = &c->tiles.views[i];
        assert_own(view);
        assert_int_equal(view->tile->key.column, patches[i].column);
        assert_int_equal(view->tile->key.row, patches[i].row);
        for (uint32_t v = 0; v < view->tile->mesh.top_vertices; v++)
            assert_true(view->tile->mesh.vertices[v][1] >= view->tile->low &&
                        view->tile->mesh.vertices[v][1] <= view->tile->high);
    }
}

static void test_keeps_tiles(void **context)
{
    struct terrain_context *c = *context;
    struct terrain_quadtree_patch patches[16];
    struct tile before[16];
    uint32_t count = block(patches, 8, 90, 95, 4);
    terrain_tiles_update(&c->tiles, patches, count, &c->frame_view, TERRAIN_TILES_ALL);
    for (uint32_t i = 0; i < count; i++)
        before[i] = *c->tiles.views[i].tile;
    terrain_tiles_update(&c->tiles, patches, count, &c->frame_view, TERRAIN_TILES_ALL);
    assert_int_equal(c->tiles.textures_made, 0);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(c->tiles.views[i].tile->texture_version, before[i].texture_version);
        assert_int_equal(c->tiles.views[i].tile->mesh_version, before[i].mesh_version);
        assert_ptr_equal(c->tiles.views[i].tile->texture, before[i].texture);
    }
}

/* Textures made a few at a time equal those made at once. */
static void test_a_budget_only_delays(void **context)
{
    struct terrain_context *c = *context;
    static uint8_t whole[64][TILE_TEXTURE_BYTES];
    struct terrain_quadtree_patch patches[64];
    uint32_t count = block(patches, 10, 400, 405, 8), updates = 0;
    terrain_tiles_update(&c->tiles, patches, count, &c->frame_view, TERRAIN_TILES_ALL);
    for (uint32_t i = 0; i < count; i++)
        memcpy(whole[i], c->tiles.views[i].texture_tile->texture, TILE_TEXTURE_BYTES);
    terrain_tiles_free(&c->tiles);
    assert_int_equal(terrain_tiles_init(&c->tiles), 0);
    do {
        terrain_tiles_update(&c->tiles, patches, count, &c->frame_view, 5);
        /* Stand-ins are made first; an 8 x 8 block then has room for at most four of its own. */
        assert_true(c->tiles.textures_made <= (updates == 0 ? 5 + 4 : 5));
        assert_int_equal(c->tiles.view_count, count);
        for (uint32_t i = 0; i < count; i++)
            assert_true(c->tiles.views[i].texture_tile->texture_version != 0);
        updates++;
    } while (c->tiles.waiting > 0 && updates < 50);
    assert_true(updates > 10 && updates < 16);
    for (uint32_t i = 0; i < count; i++) {
        assert_own(&c->tiles.views[i]);
        assert_memory_equal(c->tiles.views[i].texture_tile->texture, whole[i], TILE_TEXTURE_BYTES);
    }
}

static void test_an_ancestor_stands_in(void **context)
{
    struct terrain_context *c = *context;
    struct terrain_quadtree_patch above = at(8, 25000.0, 25000.0), below[16];
    terrain_tiles_update(&c->tiles, &above, 1, &c->frame_view, TERRAIN_TILES_ALL);
    uint32_t count = block(below, 10, above.column * 4, above.row * 4, 4);
    terrain_tiles_update(&c->tiles, below, count, &c->frame_view, 0);
    assert_int_equal(c->tiles.textures_made, 0);
    assert_int_equal(c->tiles.waiting, count);
    double wide = terrain_quadtree_patch_side(8), side = terrain_quadtree_patch_side(10);
    for (uint32_t i = 0; i < count; i++) {
        const struct tile_view *view = &c->tiles.views[i];
        assert_int_equal(view->texture_tile->key.level, 8);
        assert_true(view->share == 0.25f);
        assert_true((double)view->at_u * wide + above.column * wide == below[i].column * side);
        assert_true((double)view->at_v * wide + above.row * wide == below[i].row * side);
    }
}

/* Ground outside the square has negative numbers. */
static void test_an_ancestor_stands_in_west_of_the_square(void **context)
{
    struct terrain_context *c = *context;
    struct terrain_quadtree_patch above = at(6, -700.0, 25000.0), below = at(8, -10.0, 25000.0);
    terrain_tiles_update(&c->tiles, &above, 1, &c->frame_view, TERRAIN_TILES_ALL);
    terrain_tiles_update(&c->tiles, &below, 1, &c->frame_view, 0);
    const struct tile_view *view = &c->tiles.views[0];
    assert_int_equal(view->texture_tile->key.column, above.column);
    assert_true(view->at_u == 0.75f);
}

static void test_the_coarsest_stand_in_is_made_when_there_is_none(void **context)
{
    struct terrain_context *c = *context;
    struct terrain_quadtree_patch patch = at(10, 25000.0, 25000.0), root = {.level = 0};
    terrain_tiles_update(&c->tiles, &root, 1, &c->frame_view, TERRAIN_TILES_ALL);
    terrain_tiles_update(&c->tiles, &patch, 1, &c->frame_view, 0);
    assert_int_equal(c->tiles.textures_made, 1); /* the root's texels of 500 m are too wide */
    assert_int_equal(c->tiles.views[0].texture_tile->key.level, 7);
}

static void test_a_crater_updates_its_tiles(void **context)
{
    struct terrain_context *c = *context;
    struct terrain_quadtree_patch patches[9];
    uint64_t mesh_versions[9], texture_versions[9];
    uint32_t count = block(patches, 10, 399, 399, 3);
    terrain_tiles_update(&c->tiles, patches, count, &c->frame_view, TERRAIN_TILES_ALL);
    for (uint32_t i = 0; i < count; i++) {
        mesh_versions[i] = c->tiles.views[i].tile->mesh_version;
        texture_versions[i] = c->tiles.views[i].texture_tile->texture_version;
    }
    /* 16 m from the west edge of the middle tile: its soot reaches across, its bowl does not. */
    double side = terrain_quadtree_patch_side(10);
    dig(c, 400.0 * side + 16.0, 400.5 * side, 8.0f);
    terrain_tiles_update(&c->tiles, patches, count, &c->frame_view, 0);
    assert_int_equal(c->tiles.textures_made, 0);
    assert_int_equal(c->tiles.waiting, 2);
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(c->tiles.views[i].tile->mesh_version == mesh_versions[i], i != 4);
        assert_own(&c->tiles.views[i]);
    }
    terrain_tiles_update(&c->tiles, patches, count, &c->frame_view, TERRAIN_TILES_ALL);
    assert_int_equal(c->tiles.textures_made, 2);
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(c->tiles.views[i].texture_tile->texture_version == texture_versions[i],
                         i != 3 && i != 4);
    terrain_tiles_update(&c->tiles, patches, count, &c->frame_view, TERRAIN_TILES_ALL);
    assert_int_equal(c->tiles.textures_made, 0);
}

/* An earlier state of the world has fewer craters: tiles that show missing ones are made again. */
static void test_a_removed_crater_vanishes_from_the_tile(void **context)
{
    struct terrain_context *c = *context;
    static uint8_t clean[TILE_TEXTURE_BYTES];
    struct terrain_quadtree_patch patch = at(10, 25030.0, 25030.0);
    terrain_tiles_update(&c->tiles, &patch, 1, &c->frame_view, TERRAIN_TILES_ALL);
    memcpy(clean, c->tiles.views[0].texture_tile->texture, sizeof clean);
    dig(c, 25030.0, 25030.0, 6.0f);
    terrain_tiles_update(&c->tiles, &patch, 1, &c->frame_view, TERRAIN_TILES_ALL);
    assert_memory_not_equal(c->tiles.views[0].texture_tile->texture, clean, sizeof clean);
    crater_index_update(&c->index, 0);
    terrain_tiles_update(&c->tiles, &patch, 1, &c->frame_view, TERRAIN_TILES_ALL);
    assert_memory_equal(c->tiles.views[0].texture_tile->texture, clean, sizeof clean);
}

static void test_mips_are_means(void **context)
{
    struct terrain_context *c = *context;
    struct terrain_quadtree_patch patch = at(9, 26000.0, 25100.0);
    terrain_tiles_update(&c->tiles, &patch, 1, &c->frame_view, TERRAIN_TILES_ALL);
    const uint8_t *texture = c->tiles.views[0].texture_tile->texture;
    assert_int_equal(tile_mip_offset(0), 0);
    assert_int_equal(tile_mip_offset(TILE_MIPS), TILE_TEXTURE_BYTES);
    for (uint32_t mip = 0; mip < TILE_MIPS; mip++) {
        double sum[4] = {0.0};
        uint32_t texels = tile_mip_side(mip) * tile_mip_side(mip);
        assert_int_equal(tile_mip_offset(mip + 1) - tile_mip_offset(mip), 4 * texels);
        for (uint32_t i = 0; i < 4 * texels; i++)
            sum[i % 4] += texture[tile_mip_offset(mip) + i];
        for (uint32_t i = 0; i < 4; i++) {
            double whole = 0.0, all = (double)TILE_TEXELS * TILE_TEXELS;
            for (uint32_t t = 0; t < TILE_TEXELS * TILE_TEXELS; t++)
                whole += texture[4 * t + i];
            assert_true(fabs(sum[i] / texels - whole / all) < 1.0 + 0.5 * mip);
        }
    }
}

/* A patch that is divided shows its largest mip; its parts show their second mip, which has texels
 * as wide and is nearly equal. */
static void test_textures_do_not_jump_when_a_patch_is_divided(void **context)
{
    struct terrain_context *c = *context;
    for (int32_t level = 4; level < TERRAIN_QUADTREE_LEVEL_MAX; level++) {
        double side = terrain_quadtree_patch_side(level), far = TERRAIN_QUADTREE_SPLIT * side;
        float texel_m = (float)(side / (TILE_TEXELS - 1));
        assert_true(fabsf(tile_texels((float)far, 0.0f, texel_m) - 1.0f) < 1e-3f);
        assert_true(fabsf(tile_texels((float)far, 0.0f, 0.5f * texel_m) - 2.0f) < 2e-3f);
        struct terrain_quadtree_patch pair[2] = {at(level, 26000.0, 25100.0)};
        pair[1] = (struct terrain_quadtree_patch){
            .column = 2 * pair[0].column, .row = 2 * pair[0].row, .level = level + 1};
        terrain_tiles_update(&c->tiles, pair, 2, &c->frame_view, TERRAIN_TILES_ALL);
        const uint8_t *whole = c->tiles.views[0].texture_tile->texture;
        const uint8_t *part = c->tiles.views[1].texture_tile->texture + tile_mip_offset(1);
        double off = 0.0;
        const uint32_t half = TILE_TEXELS / 2;
        for (uint32_t row = 0; row < half; row++)
            for (uint32_t column = 0; column < half; column++)
                for (uint32_t k = 0; k < 3; k++)
                    off += abs(whole[(row * TILE_TEXELS + column) * 4 + k] -
                               part[(row * half + column) * 4 + k]);
        off /= 3.0 * half * half;
        print_message("level %d: colours change by %.1f of 255\n", level, off);
        assert_true(off < 7.0);
    }
}

static void test_neighbours_meet_in_the_same_colour(void **context)
{
    struct terrain_context *c = *context;
    struct terrain_quadtree_patch pair[2];
    /* Grass with the road, and the shore. */
    const double places[][2] = {{26000.0, 25100.0}, {60 * SPACING, 21000.0}, {33000.0, 31000.0}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++)
        for (int32_t level = 5; level <= TERRAIN_QUADTREE_LEVEL_MAX; level++) {
            pair[0] = pair[1] = at(level, places[i][0], places[i][1]);
            pair[1].column++;
            terrain_tiles_update(&c->tiles, pair, 2, &c->frame_view, TERRAIN_TILES_ALL);
            const uint8_t *west = c->tiles.views[0].texture_tile->texture;
            const uint8_t *east = c->tiles.views[1].texture_tile->texture;
            for (uint32_t row = 0; row < TILE_TEXELS; row++)
                for (uint32_t k = 0; k < 4; k++)
                    assert_true(abs(west[(row * TILE_TEXELS + TILE_TEXELS - 1) * 4 + k] -
                                    east[row * TILE_TEXELS * 4 + k]) <= 1);
        }
}

static void test_replaces_the_tile_unused_longest(void **context)
{
    struct terrain_context *c = *context;
    struct terrain_quadtree_patch here = at(10, 25000.0, 25000.0), many[256];
    terrain_tiles_update(&c->tiles, &here, 1, &c->frame_view, TERRAIN_TILES_ALL);
    uint64_t version = c->tiles.views[0].texture_tile->texture_version;
    for (int32_t i = 0; i < 2; i++) {
        uint32_t count = block(many, 10, 100 + 16 * i, 100, 16);
        terrain_tiles_update(&c->tiles, many, count, &c->frame_view, 0);
    }
    terrain_tiles_update(&c->tiles, &here, 1, &c->frame_view, 0);
    assert_int_equal(c->tiles.views[0].texture_tile->texture_version, version);
    for (int32_t i = 2; i < 8; i++) {
        uint32_t count = block(many, 10, 100 + 16 * i, 100, 16);
        terrain_tiles_update(&c->tiles, many, count, &c->frame_view, 0);
    }
    terrain_tiles_update(&c->tiles, &here, 1, &c->frame_view, TERRAIN_TILES_ALL);
    assert_int_equal(c->tiles.textures_made, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define WITH_COUNTRY(test) cmocka_unit_test_setup_teardown(test, open_country, close_country)
        WITH_COUNTRY(test_makes_all_without_a_budget),
        WITH_COUNTRY(test_keeps_tiles),
        WITH_COUNTRY(test_a_budget_only_delays),
        WITH_COUNTRY(test_an_ancestor_stands_in),
        WITH_COUNTRY(test_an_ancestor_stands_in_west_of_the_square),
        WITH_COUNTRY(test_the_coarsest_stand_in_is_made_when_there_is_none),
        WITH_COUNTRY(test_a_crater_updates_its_tiles),
        WITH_COUNTRY(test_a_removed_crater_vanishes_from_the_tile),
        WITH_COUNTRY(test_mips_are_means),
        WITH_COUNTRY(test_textures_do_not_jump_when_a_patch_is_divided),
        WITH_COUNTRY(test_neighbours_meet_in_the_same_colour),
        WITH_COUNTRY(test_replaces_the_tile_unused_longest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
