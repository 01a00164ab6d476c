/* The map against the world table (row 12): every vehicle's symbol is at its position at every
 * scale and size; shapes and forces can be told apart; kept ground equals ground painted anew. */
#include "renderer/chart/map.h"

#include "renderer/chart/base_map.h"
#include "tests/support/map_stage.h"
#include "world/terrain/gridsquare.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REACH 20.0 /* [pixel] no symbol of these tests is larger */

static int open_stage(void **context)
{
    *context = map_stage_new(fixture_seed(12));
    return 0;
}

static const uint8_t *pixel_at(const struct image *image, double x, double y)
{
    return image->pixels + ((size_t)y * image->width + (size_t)x) * 4;
}

static void test_points_of_the_map(void **context)
{
    (void)context;
    struct map_view view = map_whole(WORLD_SIDE_DEFAULT_M, 10, 20, 500); /* 100 m a pixel */
    struct point middle = map_point(&view, 25000.0, 25000.0);
    assert_true(fabs(middle.x - 260.0) < 1e-9 && fabs(middle.y - 270.0) < 1e-9);
    struct map_view close = map_around(30000.0, 20000.0, 10.0, 0, 0, 600, 400);
    struct point centre = map_point(&close, 30000.0, 20000.0);
    assert_true(fabs(centre.x - 300.0) < 1e-9 && fabs(centre.y - 200.0) < 1e-9);
    close.x += 3.7;
    close.z -= 2.2;
    map_align(&close);
    assert_true(fabs(fmod(close.x, 10.0)) < 1e-6 && fabs(fmod(close.z, 10.0)) < 1e-6);
    assert_true(map_round_down(999.0) == 500.0 && map_round_down(2000.0) == 2000.0 &&
                map_round_down(1.5) == 1.0);
}

/* Every vehicle in the view shows, and nothing is drawn away from vehicles. */
static void check_view(const struct map_stage *stage, const struct map_view *view, double pixels)
{
    struct image image;
    uint32_t width = (uint32_t)view->left + view->width,
             height = (uint32_t)view->top + view->height;
    const struct entities *e = &stage->state.entities;
    assert_int_equal(image_init(&image, width, height), 0);
    map_vehicles(&image, view, &stage->frame_view, SLOT_NONE, pixels);
    for (uint32_t i = 0; i < stage->state.head->used; i++) {
        struct point at = map_point(view, e->row[i].x, e->row[i].z);
        if (!map_contains(view, at, 0.0))
            continue;
        if (!map_stage_shows(stage, &image, view, i))
            fail_msg("slot %u does not show at %.1f, %.1f of %ux%u, %.1f m a pixel", i, at.x, at.y,
                     width, height, view->metres);
    }
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const uint8_t *pixel = pixel_at(&image, x, y);
            bool near = pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0;
            for (uint32_t i = 0; i < stage->state.head->used && !near; i++) {
                struct point at = map_point(view, e->row[i].x, e->row[i].z);
                near = hypot(at.x - x, at.y - y) < REACH;
            }
            assert_true(near);
        }
    image_free(&image);
}

static void test_vehicles_are_where_the_table_says(void **context)
{
    const struct map_stage *stage = *context;
    const struct map_view views[] = {
        map_whole(WORLD_SIDE_DEFAULT_M, 0, 0, 200),
        map_whole(WORLD_SIDE_DEFAULT_M, 13, 29, 512),
        map_whole(WORLD_SIDE_DEFAULT_M, 0, 0, 1080),
        map_around(25000.0, 25000.0, 10.0, 0, 0, 1280, 720),
        map_around(25000.0, 25000.0, 31.3, 5, 7, 640, 360),
        map_around(3000.0, 47000.0, 55.0, 0, 0, 300, 700), /* partly beyond the world */
        map_around(25000.0, 25000.0, 3.0, 0, 0, 2000, 2000),
    };
    for (size_t i = 0; i < sizeof views / sizeof views[0]; i++) {
        check_view(stage, &views[i], 5.5);
        check_view(stage, &views[i], 12.0);
    }
}

static void draw_one(struct image *image, struct point at, enum symbol_shape shape, double heading,
                     double pixels, enum force force)
{
    memset(image->pixels, 0, (size_t)image->width * image->height * 4);
    symbol_vehicle(image, at, shape, heading, pixels, force);
}

static void test_every_symbol_is_its_force_in_the_middle(void **context)
{
    (void)context;
    uint64_t seed = fixture_seed(77);
    struct image image;
    assert_int_equal(image_init(&image, 80, 80), 0);
    for (uint32_t i = 0; i < 3000; i++) {
        enum symbol_shape shape = (enum symbol_shape)(i % SYMBOL_COUNT);
        enum force force = (enum force)(i / SYMBOL_COUNT % FORCE_COUNT);
        struct point at = {fixture_uniform(&seed, 30.0, 50.0), fixture_uniform(&seed, 30.0, 50.0)};
        struct rgba colour = symbol_colour(force);
        draw_one(&image, at, shape, fixture_uniform(&seed, 0.0, 6.3),
                 fixture_uniform(&seed, 8.5, 30.0), force);
        const uint8_t *pixel = pixel_at(&image, at.x, at.y);
        if (abs(pixel[0] - colour.r) + abs(pixel[1] - colour.g) + abs(pixel[2] - colour.b) > 100)
            fail_msg("form %d of force %d: %d %d %d", (int)shape, (int)force, pixel[0], pixel[1],
                     pixel[2]);
    }
    image_free(&image);
}

/* Shapes can be told apart without colour: they differ in a good part of their area. */
static void test_shapes_differ(void **context)
{
    (void)context;
    struct image images[SYMBOL_COUNT];
    struct point at = {20.0, 20.0};
    for (uint32_t i = 0; i < SYMBOL_COUNT; i++) {
        assert_int_equal(image_init(&images[i], 40, 40), 0);
        draw_one(&images[i], at, (enum symbol_shape)i, 0.4, 12.0, FORCE_BLUE);
    }
    for (uint32_t a = 0; a < SYMBOL_COUNT; a++)
        for (uint32_t b = 0; b < a; b++) {
            uint32_t differ = 0, either = 0;
            for (size_t i = 0; i < (size_t)40 * 40; i++) {
                bool in_a = images[a].pixels[i * 4 + 2] > 128,
                     in_b = images[b].pixels[i * 4 + 2] > 128;
                differ += in_a != in_b;
                either += in_a || in_b;
            }
            if (differ * 100 < either * 15)
                fail_msg("forms %u and %u differ in %u of %u pixels", a, b, differ, either);
        }
    for (uint32_t i = 0; i < SYMBOL_COUNT; i++)
        image_free(&images[i]);
}

/* Symbols turn with their vehicles: the tank's gun points ahead. */
static void test_a_symbol_points_ahead(void **context)
{
    (void)context;
    struct image image;
    struct point at = {40.0, 40.0};
    assert_int_equal(image_init(&image, 80, 80), 0);
    for (uint32_t i = 0; i < 8; i++) {
        double heading = 0.25 * 3.14159265 * i;
        draw_one(&image, at, SYMBOL_TANK, heading, 30.0, FORCE_BLUE);
        const uint8_t *ahead =
            pixel_at(&image, at.x + 21.0 * sin(heading), at.y - 21.0 * cos(heading));
        const uint8_t *behind =
            pixel_at(&image, at.x - 21.0 * sin(heading), at.y + 21.0 * cos(heading));
        assert_true(ahead[2] > 200);
        assert_int_equal(behind[2], 0);
    }
    image_free(&image);
}

static uint32_t count_red_over_blue(const struct image *image)
{
    uint32_t count = 0;
    for (size_t i = 0; i < (size_t)image->width * image->height; i++)
        count += image->pixels[i * 4] > 200 && image->pixels[i * 4 + 2] < 80;
    return count;
}

static void test_wrecks_burn_and_then_are_crosses(void **context)
{
    struct map_stage *stage = *context;
    struct map_view view = map_whole(WORLD_SIDE_DEFAULT_M, 0, 0, 700);
    struct image image;
    struct entities *e = &stage->state.entities;
    assert_int_equal(image_init(&image, 700, 700), 0);
    for (uint32_t i = 0; i < stage->state.head->used; i++) {
        e->row[i].state = ENTITY_WRECK;
        e->row[i].changed_tick = 0;
    }
    map_vehicles(&image, &view, &stage->frame_view, SLOT_NONE, 12.0);
    assert_true(count_red_over_blue(&image) > 10 * stage->state.head->used);
    memset(image.pixels, 0, (size_t)700 * 700 * 4);
    stage->state.head->tick = (uint64_t)(1000.0 / world_dt_s(stage->frame_view.world));
    map_vehicles(&image, &view, &stage->frame_view, SLOT_NONE, 12.0);
    assert_int_equal(count_red_over_blue(&image), 0);
    image_free(&image);
}

static void test_blasts_show_and_fade(void **context)
{
    struct map_stage *stage = *context;
    struct map_view view = map_whole(WORLD_SIDE_DEFAULT_M, 0, 0, 500);
    static struct effects effects = {.count = 2};
    struct image image;
    effects.effect[0] = (struct effect){.point = {10000.0, 0.0, 20000.0}, .type = EFFECT_EXPLOSION};
    effects.effect[1] = (struct effect){.point = {30000.0, 0.0, 20000.0}, .type = EFFECT_FLASH};
    assert_int_equal(image_init(&image, 500, 500), 0);
    map_blasts(&image, &view, &stage->frame_view, &effects, 12.0);
    assert_true(pixel_at(&image, 100.0, 200.0)[0] > 240);
    assert_int_equal(pixel_at(&image, 300.0, 200.0)[0], 0);
    memset(image.pixels, 0, (size_t)500 * 500 * 4);
    effects.effect[0].time_s = -60.0;
    map_blasts(&image, &view, &stage->frame_view, &effects, 12.0);
    assert_int_equal(pixel_at(&image, 100.0, 200.0)[0], 0);
    image_free(&image);
}

/* The triangle covers what the camera's frustum covers of level ground, up to its length. */
static void test_the_triangle_is_the_cameras(void **context)
{
    (void)context;
    uint64_t seed = fixture_seed(5);
    struct map_view view = map_whole(WORLD_SIDE_DEFAULT_M, 0, 0, 500);
    struct image image;
    assert_int_equal(image_init(&image, 500, 500), 0);
    for (uint32_t i = 0; i < 40; i++) {
        double heading = fixture_uniform(&seed, 0.0, 6.28);
        uint32_t width = 200 + (uint32_t)fixture_uniform(&seed, 0.0, 1200.0);
        struct vec3 eye = {25000.0, 100.0, 25000.0};
        struct vec3 target = {eye.x + 1000.0 * sin(heading), 100.0, eye.z - 1000.0 * cos(heading)};
        struct camera camera;
        camera_look(&camera, eye, target, width, 720);
        memset(image.pixels, 0, (size_t)500 * 500 * 4);
        map_camera(&image, &view, &camera, 100.0);
        double half = atan(camera.tan_x);
        for (int32_t side = -1; side <= 1; side += 2) {
            double within = heading + side * 0.9 * half,
                   outside = heading + side * (1.1 * half + 0.05);
            assert_true(
                pixel_at(&image, 250.0 + 60.0 * sin(within), 250.0 - 60.0 * cos(within))[0] > 40);
            assert_int_equal(
                pixel_at(&image, 250.0 + 60.0 * sin(outside), 250.0 - 60.0 * cos(outside))[0], 0);
        }
    }
    image_free(&image);
}

/* A base map that was moved equals one that was painted anew. */
static void test_kept_ground_is_what_would_be_painted(void **context)
{
    struct map_stage *stage = *context;
    uint64_t seed = fixture_seed(31);
    struct base_map kept, fresh;
    struct image a, b;
    const uint32_t width = 93, height = 61;
    assert_int_equal(image_init(&a, width + 5, height + 7), 0);
    assert_int_equal(image_init(&b, width + 5, height + 7), 0);
    base_map_open(&kept, stage->frame_view.world);
    double x = 300.0, z = 49500.0;
    for (uint32_t i = 0; i < 60; i++) {
        double metres = i < 40 ? 12.0 : 7.0, stride = i % 10 == 9 ? 3000.0 : 90.0;
        x += fixture_uniform(&seed, -stride, stride);
        z += fixture_uniform(&seed, -stride, stride);
        struct map_view view = map_around(x, z, metres, 5, 7, width, height);
        map_align(&view);
        base_map_open(&fresh, stage->frame_view.world);
        assert_int_equal(base_map_draw(&kept, &a, &view), 0);
        assert_int_equal(base_map_draw(&fresh, &b, &view), 0);
        assert_memory_equal(a.pixels, b.pixels, (size_t)a.width * a.height * 4);
        base_map_close(&fresh);
    }
    base_map_close(&kept);
    image_free(&a);
    image_free(&b);
}

static void test_a_map_that_follows_paints_strips(void **context)
{
    struct map_stage *stage = *context;
    struct base_map base;
    struct image image;
    assert_int_equal(image_init(&image, 160, 120), 0);
    base_map_open(&base, stage->frame_view.world);
    for (uint32_t i = 0; i <= 100; i++) {
        struct map_view view = map_around(20000.0 + 10.0 * i, 20000.0, 10.0, 0, 0, 160, 120);
        map_align(&view);
        assert_int_equal(base_map_draw(&base, &image, &view), 0);
    }
    /* It moved by a hundred pixels: altogether less than two pictures are painted. */
    assert_true(base.painted < 2u * 160u * 120u);
    uint64_t painted = base.painted;
    struct map_view same = map_around(21000.0, 20000.0, 10.0, 0, 0, 160, 120);
    map_align(&same);
    assert_int_equal(base_map_draw(&base, &image, &same), 0);
    assert_true(base.painted == painted);
    base_map_close(&base);
    image_free(&image);
}

/* An objective is in the colour of the force that holds it, and nowhere else. */
static void test_objectives_have_their_holders_colour(void **context)
{
    struct map_stage *stage = *context;
    const struct objective hill = {.x0 = 10000.0, .z0 = 20000.0, .x1 = 20000.0, .z1 = 30000.0};
    struct world world = *stage->frame_view.world;
    struct frame_view frame_view = stage->frame_view;
    struct map_view view = map_whole(WORLD_SIDE_DEFAULT_M, 0, 0, 500);
    world.objectives = &hill;
    world.counts.objectives = 1;
    frame_view.world = &world;
    for (uint32_t force = 0; force < FORCE_COUNT; force++) {
        struct image image;
        assert_int_equal(image_init(&image, 500, 500), 0);
        stage->state.head->battle.objective[0].owner = (uint8_t)force;
        map_objectives(&image, &view, &frame_view);
        struct rgba colour = symbol_colour((enum force)force);
        const uint8_t *edge = pixel_at(&image, 150.0, 200.0), *in = pixel_at(&image, 150.0, 250.0);
        assert_true(abs(edge[0] - colour.r) < 80 && abs(edge[2] - colour.b) < 80);
        assert_true(in[0] + in[1] + in[2] > 30 && in[0] + in[1] + in[2] < 200);
        const uint8_t *out = pixel_at(&image, 250.0, 250.0);
        assert_int_equal(out[0] + out[1] + out[2], 0);
        image_free(&image);
    }
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, map_stage_teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_points_of_the_map),
        TEST(test_objectives_have_their_holders_colour),
        TEST(test_vehicles_are_where_the_table_says),
        TEST(test_every_symbol_is_its_force_in_the_middle),
        TEST(test_shapes_differ),
        TEST(test_a_symbol_points_ahead),
        TEST(test_wrecks_burn_and_then_are_crosses),
        TEST(test_blasts_show_and_fade),
        TEST(test_the_triangle_is_the_cameras),
        TEST(test_kept_ground_is_what_would_be_painted),
        TEST(test_a_map_that_follows_paints_strips),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
