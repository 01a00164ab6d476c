/* The core of the software back end: which pixels triangles cover, and that a picture is the same
 * on every processor and for any number of threads. */
#include "renderer/soft/fxaa.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/terrain/terrain_tiles.h"
#include "renderer/soft/kernel.h"
#include "renderer/soft/triangle_raster.h"
#include "tests/support/fixture.h"
#include "renderer/soft/soft.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#define SEED    20261122u
#define WIDTH   200
#define HEIGHT  120
#define STRIDE  208
#define POSTS   401u
#define SPACING 125.0

/* --- triangles ---------------------------------------------------------------------------------*/

/* How often each pixel was drawn, and the last value it was given. */
struct sheet {
    uint32_t times[HEIGHT * STRIDE];
    float value[HEIGHT * STRIDE];
    struct triangle_edges edges;
    struct triangle_plane plane;
};

SIMD8 void count_pixels(void *context, int32_t x, int32_t y, size_t at, v8i inside)
{
    struct sheet *sheet = context;
    v8f value = triangle_raster_value(&sheet->edges, &sheet->plane, x, y);
    (void)at;
    for (int32_t i = 0; i < LANES; i++)
        if (inside[i] != 0) {
            sheet->times[y * STRIDE + x + i]++;
            sheet->value[y * STRIDE + x + i] = value[i];
        }
}

/* Draws a triangle band by band; corners are x, y and a value. Returns false when no pixel could be
 * covered. */
static bool draw_triangle(struct sheet *sheet, float corner[3][3])
{
    struct corners8 corners;
    struct edges8 edges;
    v8f at[3];
    for (uint32_t c = 0; c < 3; c++) {
        corners.x[c] = simd8_f(corner[c][0]);
        corners.y[c] = simd8_f(corner[c][1]);
        at[c] = simd8_f(corner[c][2]);
    }
    if (simd8_bits(triangle_raster_set_up(&edges, &corners, WIDTH, HEIGHT)) == 0)
        return false;
    struct plane8 planes = triangle_raster_plane(&edges, at[0], at[1], at[2]);
    sheet->edges = triangle_raster_of(&edges, 3);
    sheet->plane = triangle_raster_plane_of(&planes, 3);
    for (int32_t first = 0; first < HEIGHT; first += SOFT_BAND_ROWS) {
        int32_t end = first + SOFT_BAND_ROWS;
        struct soft_target band = {
            .width = WIDTH, .stride = STRIDE, .first = first, .end = end < HEIGHT ? end : HEIGHT};
        triangle_raster_walk(&sheet->edges, &band, count_pixels, sheet);
    }
    return true;
}

/* A grid of irregular quadrangles covers the whole picture. Some are thinner than a pixel. */
static void test_grid_has_no_gap_and_no_overlap(void **context)
{
    static struct sheet sheet;
    uint64_t state = fixture_seed(SEED);
    (void)context;
    for (uint32_t round = 0; round < 20; round++) {
        enum { SIDE = 24 };
        float grid[SIDE + 1][SIDE + 1][3];
        double shake = fixture_uniform(&state, 0.0, 0.24);
        for (int32_t r = 0; r <= SIDE; r++)
            for (int32_t c = 0; c <= SIDE; c++) {
                double x = c + fixture_uniform(&state, -shake, shake);
                double y = r + fixture_uniform(&state, -shake, shake);
                /* The grid is fine in the middle and reaches beyond the picture's edges. */
                double u = (x / SIDE - 0.5) * 2.0, v = (y / SIDE - 0.5) * 2.0;
                grid[r][c][0] = (float)(WIDTH * (0.5 + 0.6 * u * u * u + 0.04 * u));
                grid[r][c][1] = (float)(HEIGHT * (0.5 + 0.6 * v * v * v + 0.04 * v));
                grid[r][c][2] = 0.0f;
            }
        memset(&sheet, 0, sizeof sheet);
        for (uint32_t r = 0; r < SIDE; r++)
            for (uint32_t c = 0; c < SIDE; c++) {
                float triangle[3][3];
                memcpy(triangle[0], grid[r][c], sizeof triangle[0]);
                memcpy(triangle[1], grid[r + 1][c + 1], sizeof triangle[1]);
                memcpy(triangle[2], grid[r][c + 1], sizeof triangle[2]);
                draw_triangle(&sheet, triangle);
                memcpy(triangle[2], triangle[0], sizeof triangle[2]);
                memcpy(triangle[0], grid[r + 1][c], sizeof triangle[0]);
                draw_triangle(&sheet, triangle);
            }
        for (int32_t y = 0; y < HEIGHT; y++)
            for (int32_t x = 0; x < STRIDE; x++)
                assert_int_equal(sheet.times[y * STRIDE + x], x < WIDTH ? 1 : 0);
    }
}

/* When corners lie on pixel centres, the pixel belongs to the triangle below and to the right. */
static void test_centre_on_an_edge_belongs_to_one(void **context)
{
    static struct sheet sheet;
    (void)context;
    memset(&sheet, 0, sizeof sheet);
    float upper[3][3] = {{10.5f, 10.5f, 0.0f}, {20.5f, 10.5f, 0.0f}, {10.5f, 20.5f, 0.0f}};
    float lower[3][3] = {{20.5f, 10.5f, 0.0f}, {20.5f, 20.5f, 0.0f}, {10.5f, 20.5f, 0.0f}};
    assert_true(draw_triangle(&sheet, upper));
    assert_true(draw_triangle(&sheet, lower));
    for (int32_t y = 5; y < 25; y++)
        for (int32_t x = 5; x < 25; x++)
            assert_int_equal(sheet.times[y * STRIDE + x],
                             x >= 10 && x < 20 && y >= 10 && y < 20 ? 1 : 0);
}

static void test_degenerate_triangles_are_refused(void **context)
{
    static struct sheet sheet;
    const float nan = (float)NAN, inf = (float)INFINITY;
    float refused[][3][3] = {
        {{10, 10, 1}, {10, 10, 1}, {10, 10, 1}},          /* a point */
        {{10, 10, 1}, {50, 50, 1}, {90, 90, 1}},          /* a line */
        {{10.6f, 10, 1}, {11.4f, 10, 1}, {11, 90, 1}},    /* between two columns */
        {{10, 10.6f, 1}, {90, 10.7f, 1}, {50, 11.4f, 1}}, /* between two rows */
        {{-90, 10, 1}, {-5, 10, 1}, {-50, 90, 1}},        /* beside the picture */
        {{10, 300, 1}, {90, 300, 1}, {50, 130, 1}},       /* below it */
        {{nan, 10, 1}, {90, 10, 1}, {50, 90, 1}},         {{10, 10, 1}, {90, nan, 1}, {50, 90, 1}},
        {{10, 10, 1}, {90, 10, 1}, {inf, 90, 1}},
    };
    (void)context;
    memset(&sheet, 0, sizeof sheet);
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++)
        assert_false(draw_triangle(&sheet, refused[i]));
}

/* A triangle whose corners are far outside fills the picture and no more. */
static void test_huge_triangles_are_cut_to_the_picture(void **context)
{
    static struct sheet sheet;
    float huge[3][3] = {{-3.0e6f, -1.0e6f, 1.0f}, {3.0e6f, -1.0e6f, 1.0f}, {100.0f, 5.0e6f, 1.0f}};
    (void)context;
    memset(&sheet, 0, sizeof sheet);
    assert_true(draw_triangle(&sheet, huge));
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < STRIDE; x++)
            assert_int_equal(sheet.times[y * STRIDE + x], x < WIDTH ? 1 : 0);
}

/* The plane through three corners has the expected value at every pixel. */
static void test_values_lie_on_the_plane(void **context)
{
    static struct sheet sheet;
    uint64_t state = fixture_seed(SEED + 1);
    (void)context;
    for (uint32_t round = 0; round < 200; round++) {
        double at = fixture_uniform(&state, -1, 1), by_x = fixture_uniform(&state, -0.1, 0.1);
        double by_y = fixture_uniform(&state, -0.1, 0.1), area = 0.0;
        float corner[3][3];
        while (fabs(area) < 200.0) {
            for (uint32_t c = 0; c < 3; c++) {
                double x = fixture_uniform(&state, -50.0, WIDTH + 50.0);
                double y = fixture_uniform(&state, -50.0, HEIGHT + 50.0);
                corner[c][0] = (float)x;
                corner[c][1] = (float)y;
                corner[c][2] = (float)(at + by_x * x + by_y * y);
            }
            area = (double)((corner[1][0] - corner[0][0]) * (corner[2][1] - corner[0][1]) -
                            (corner[2][0] - corner[0][0]) * (corner[1][1] - corner[0][1]));
        }
        memset(&sheet, 0, sizeof sheet);
        draw_triangle(&sheet, corner);
        for (int32_t y = 0; y < HEIGHT; y++)
            for (int32_t x = 0; x < WIDTH; x++)
                if (sheet.times[y * STRIDE + x] > 0)
                    assert_true(fabs((double)sheet.value[y * STRIDE + x] -
                                     (at + by_x * (x + 0.5) + by_y * (y + 0.5))) < 2e-3);
    }
}

static void test_near_plane_cuts_where_it_lies(void **context)
{
    /* First one corner is behind the plane, then two, then all. The value is proportional to the
     * distance. */
    struct clip_corner corner[3] = {{.ahead = 3.0f, .value = {30.0f, 1.0f}},
                                    {.ahead = -1.0f, .value = {-10.0f, 1.0f}},
                                    {.ahead = 2.0f, .value = {20.0f, 1.0f}}};
    struct clip_corner cut[4];
    (void)context;
    assert_int_equal(triangle_raster_clip(corner, 2, 1.0f, cut), 4);
    for (uint32_t i = 0; i < 4; i++) {
        assert_true(cut[i].ahead >= 1.0f);
        assert_true(fabsf(cut[i].value[0] - 10.0f * cut[i].ahead) < 1e-5f);
        assert_true(cut[i].value[1] == 1.0f);
    }
    corner[2].ahead = -2.0f;
    assert_int_equal(triangle_raster_clip(corner, 2, 1.0f, cut), 3);
    corner[0].ahead = 0.5f;
    assert_int_equal(triangle_raster_clip(corner, 2, 1.0f, cut), 0);
    for (uint32_t i = 0; i < 3; i++)
        corner[i].ahead = 1.0f + (float)i;
    assert_int_equal(triangle_raster_clip(corner, 2, 1.0f, cut), 3);
    assert_memory_equal(cut, corner, sizeof corner);
}

/* --- pictures --------------------------------------------------------------------------------- */

/* A landscape of hills with a sea in the west. */
struct landscape {
    struct world world;
    struct frame_view frame_view;
    struct crater craters[4];
    struct crater_index index;
    struct static_scene static_scene;
    struct draw_list list;
    struct back_end_interface plain; /* on one thread */
    float posts[POSTS * POSTS];
    uint8_t cover[POSTS * POSTS];
};

static int open_landscape(void **context)
{
    struct landscape *c = calloc(1, sizeof *c);
    assert_non_null(c);
    for (uint32_t row = 0; row < POSTS; row++)
        for (uint32_t column = 0; column < POSTS; column++) {
            bool sea = column < 60;
            float hills = (float)(200.0 + 150.0 * sin(column * 0.11) * cos(row * 0.07) +
                                  20.0 * sin(column * 0.9 + row));
            c->posts[row * POSTS + column] = sea ? 0.0f : hills;
            c->cover[row * POSTS + column] = sea ? COVER_SEA : COVER_GRASS;
        }
    c->world.terrain = (struct terrain){.posts = c->posts,
                                        .cover = c->cover,
                                        .side = POSTS,
                                        .spacing_m = SPACING,
                                        .squares = GRIDSQUARES_DEFAULT_INIT};
    assert_int_equal(crater_index_init(&c->index, &GRIDSQUARES_DEFAULT, c->craters), 0);
    assert_int_equal(static_scene_init(&c->static_scene, &c->world), 0);
    assert_int_equal(scene_init(&c->list), 0);
    c->frame_view = (struct frame_view){
        .world = &c->world, .craters = &c->index, .roads = &c->static_scene.roads};
    struct error_text error;
    assert_int_equal(
        soft_open_build(&c->plain, &c->static_scene, 300, 144, 1, &soft_kernels_plain, &error), 0);
    *context = c;
    return 0;
}

static int close_landscape(void **context)
{
    struct landscape *c = *context;
    c->plain.close(c->plain.self);
    scene_free(&c->list);
    static_scene_free(&c->static_scene);
    crater_index_free(&c->index);
    free(c);
    return 0;
}

/* Looks at the shore from a low eye, in haze and fog. */
static void look(struct landscape *c, uint32_t width, uint32_t height)
{
    struct vec3 eye = {7800.0, 0.0, 25000.0}, target = {3000.0, 0.0, 27000.0};
    eye.y = terrain_height(&c->world.terrain, NULL, eye.x, eye.z) + 3.0;
    camera_look(&c->list.camera, eye, target, width, height);
    c->list.time_s = 30.0;
    c->list.fog = c->list.haze = c->list.texture = true;
    c->list.texture_budget = TERRAIN_TILES_ALL; /* no picture depends on an earlier one */
    c->list.patch_count =
        terrain_quadtree_select(&c->static_scene.ground, &c->list.camera, c->list.patches);
}

static struct image draw(struct landscape *c, struct back_end_interface *by, uint32_t width,
                         uint32_t height)
{
    struct image image;
    struct error_text error;
    look(c, width, height);
    assert_int_equal(image_init(&image, width, height), 0);
    assert_int_equal(by->picture(by->self, &c->list, &c->frame_view, &image, &error), 0);
    assert_true(by->stages(by->self)->count > 0);
    return image;
}

static void assert_same(const struct image *a, const struct image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_memory_equal(a->pixels, b->pixels, (size_t)a->width * a->height * 4);
}

/* Returns the build that soft_open() chooses on this processor. */
static const struct soft_kernels *best_build(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2"))
        return &soft_kernels_avx2;
#endif
    return &soft_kernels_plain;
}

/* Some widths are no multiple of a vector. */
static void test_threads_and_vectors_change_nothing(void **context)
{
    struct landscape *c = *context;
    for (uint32_t threads = 2; threads <= 4; threads++) {
        const struct soft_kernels *build = threads % 2 == 0 ? best_build() : &soft_kernels_plain;
        struct back_end_interface many;
        struct error_text error;
        assert_int_equal(soft_open_build(&many, &c->static_scene, 300, 144, threads, build, &error),
                         0);
        for (uint32_t width = 251; width <= 256; width += 5) {
            struct image one = draw(c, &c->plain, width, 131);
            struct image other = draw(c, &many, width, 131);
            assert_same(&one, &other);
            image_free(&one);
            image_free(&other);
        }
        many.close(many.self);
    }
}

/* Sky is above, ground below, water between. Every pixel has a colour. */
static void test_every_pixel_is_coloured(void **context)
{
    struct landscape *c = *context;
    struct image image = draw(c, &c->plain, 256, 144);
    const uint8_t *sky = image.pixels + (5 * 256 + 128) * 4;
    const uint8_t *ground = image.pixels + (138 * 256 + 128) * 4;
    assert_true(sky[2] > sky[0]);
    assert_true(ground[0] > ground[2]);
    uint32_t dark = 0;
    for (size_t i = 0; i < 256u * 144u; i++) {
        const uint8_t *p = image.pixels + i * 4;
        assert_int_equal(p[3], 255);
        dark += p[0] < 16 && p[1] < 16 && p[2] < 16;
    }
    assert_int_equal(dark, 0);
    image_free(&image);
}

static void test_refuses_what_is_too_large(void **context)
{
    struct landscape *c = *context;
    struct back_end_interface refused;
    struct image image;
    struct error_text error;
    look(c, 301, 64);
    assert_int_equal(soft_open(&refused, &c->static_scene, 0, 64, 1, &error), -1);
    assert_int_equal(soft_open(&refused, &c->static_scene, 64, SOFT_SIDE_MAX + 1, 1, &error), -1);
    assert_int_equal(image_init(&image, 301, 64), 0);
    assert_int_equal(c->plain.picture(c->plain.self, &c->list, &c->frame_view, &image, &error), -1);
    image_free(&image);
}

/* --- smoothing -------------------------------------------------------------------------------- */

static void fill(struct image *image, uint64_t *state)
{
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
        uint64_t random = fixture_random(state);
        /* The pixels are steps with noise, marked as objects, or as ground near and far. */
        uint8_t level = i % 37 < 18 ? 40 : 200;
        for (uint32_t c = 0; c < 3; c++)
            image->pixels[i * 4 + c] = (uint8_t)(level + ((random >> (8 * c)) & 31));
        image->pixels[i * 4 + 3] =
            (random >> 32 & 7) == 0 ? 255 : (uint8_t)(40 + (random >> 40 & 1));
    }
}

static void test_smoothing_is_the_same_in_any_parts(void **context)
{
    uint64_t state = fixture_seed(SEED + 2);
    (void)context;
    for (uint32_t width = 1; width < 80; width += 13) {
        struct image from, whole, parts;
        assert_int_equal(image_init(&from, width, 40), 0);
        assert_int_equal(image_init(&whole, width, 40), 0);
        assert_int_equal(image_init(&parts, width, 40), 0);
        fill(&from, &state);
        fxaa_rows_plain(&whole, &from, 0, 40);
        for (uint32_t row = 0; row < 40; row += 8)
            fxaa_rows(&parts, &from, row, row + 8);
        assert_same(&whole, &parts);
        image_free(&from);
        image_free(&whole);
        image_free(&parts);
    }
}

/* Steps between black and white are smoothed on objects and stay on ground. */
static void test_smooths_objects_and_not_ground(void **context)
{
    struct image from, to;
    (void)context;
    assert_int_equal(image_init(&from, 32, 32), 0);
    assert_int_equal(image_init(&to, 32, 32), 0);
    for (uint32_t alpha = 100; alpha <= 255; alpha += 155) {
        for (uint32_t i = 0; i < 32 * 32; i++) {
            uint8_t level = i % 32 > i / 32 ? 255 : 0;
            memset(from.pixels + (size_t)i * 4, level, 3);
            from.pixels[i * 4 + 3] = (uint8_t)alpha;
        }
        fxaa_edges(&to, &from);
        uint32_t changed = 0;
        for (uint32_t i = 0; i < 32 * 32; i++) {
            changed += to.pixels[i * 4] != from.pixels[i * 4];
            assert_int_equal(to.pixels[i * 4 + 3], 255);
        }
        assert_true(alpha == 255 ? changed >= 28 : changed == 0);
    }
    image_free(&from);
    image_free(&to);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_grid_has_no_gap_and_no_overlap),
        cmocka_unit_test(test_centre_on_an_edge_belongs_to_one),
        cmocka_unit_test(test_degenerate_triangles_are_refused),
        cmocka_unit_test(test_huge_triangles_are_cut_to_the_picture),
        cmocka_unit_test(test_values_lie_on_the_plane),
        cmocka_unit_test(test_near_plane_cuts_where_it_lies),
        cmocka_unit_test(test_threads_and_vectors_change_nothing),
        cmocka_unit_test(test_every_pixel_is_coloured),
        cmocka_unit_test(test_refuses_what_is_too_large),
        cmocka_unit_test(test_smoothing_is_the_same_in_any_parts),
        cmocka_unit_test(test_smooths_objects_and_not_ground),
    };
    return cmocka_run_group_tests(tests, open_landscape, close_landscape);
}
