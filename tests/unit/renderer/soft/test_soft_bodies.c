/* The software back end's bodies: a box at a known place covers the pixels it must. */
#include "renderer/soft/soft_texture.h"
#include "tests/support/fixture.h"
#include "tests/support/soft_stage.h"
#include "renderer/soft/soft_bodies.h"
#include "renderer/soft/soft_plants.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <string.h>

/* A red box of two metres a side about its middle. */
static const struct model_vertex vertices[] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                               {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

#define FACE(a, b, c)                                                                              \
    {                                                                                              \
        .vertex = {a, b, c}, .red = 200, .green = 40, .blue = 40                                   \
    }

static const struct model_triangle triangles[] = {
    FACE(0, 2, 1), FACE(0, 3, 2), FACE(4, 5, 6), FACE(4, 6, 7), FACE(0, 4, 7), FACE(0, 7, 3),
    FACE(1, 2, 6), FACE(1, 6, 5), FACE(0, 1, 5), FACE(0, 5, 4), FACE(3, 7, 6), FACE(3, 6, 2),
};

static const struct model models[] = {{.name = "box", .triangle_count = 12, .vertex_count = 8}};

static struct world world = {.models = models,
                             .model_vertices = vertices,
                             .model_triangles = triangles,
                             .counts = {.models = 1}};
static struct mesh_skeleton skeletons[1];
static struct static_scene static_scene = {.world = &world, .skeletons = skeletons};
static struct soft_bodies *bodies;
static struct soft_detail detail;
static struct soft_plants *plants;

static int open_bodies(void **context)
{
    struct error_text error;
    (void)context;
    if (soft_detail_make(&detail) != 0)
        return -1;
    if (mesh_skeleton(&skeletons[0], &world, 0) != 0)
        return -1;
    bodies = soft_bodies_open(&static_scene, &detail, &error);
    plants = soft_plants_open(&error);
    return bodies != NULL && plants != NULL ? 0 : -1;
}

static int close_bodies(void **context)
{
    (void)context;
    soft_bodies_close(bodies);
    soft_detail_free(&detail);
    soft_plants_close(plants);
    return 0;
}

static void open_stage(struct soft_stage *stage)
{
    const struct soft_kernels *builds[2];
    soft_stage_builds(builds);
    soft_stage_open(stage, builds[1]);
    soft_stage_clear(stage, STAGE_GROUND, 1000.0f);
}

static void draw(struct soft_stage *stage)
{
    const struct soft_kernels *k = stage->frame.kernels;
    assert_int_equal(soft_bodies_prepare(bodies, &stage->frame), 0);
    assert_int_equal(soft_plants_prepare(plants, &stage->frame), 0);
    for (uint32_t band = 0; band < stage->frame.bands; band++) {
        struct soft_target target = soft_stage_band(stage, band);
        k->soft_shadows_fill(bodies, plants, &stage->frame, &target);
        k->soft_bodies_fill(bodies, &stage->frame, &target);
    }
}

/* Adds a box that faces north, its middle at a point. */
static struct draw_list_body *add(struct soft_stage *stage, float x, float y, float far_m,
                                  float scale)
{
    uint32_t i = stage->list.body_count++;
    stage->list.instances[i] = (struct draw_list_instance){.detail = MESH_FULL};
    stage->list.bodies[i] = (struct draw_list_body){.at = {x, y, -far_m},
                                                    .forward = {0.0f, 0.0f, -scale},
                                                    .up = {0.0f, scale, 0.0f},
                                                    .right = {scale, 0.0f, 0.0f},
                                                    .tint = {0.3f, 0.3f, 0.3f}};
    return &stage->list.bodies[i];
}

static void expect_box(const struct soft_stage *stage, uint32_t half)
{
    uint32_t middle_x = STAGE_WIDTH / 2, middle_y = STAGE_HEIGHT / 2;
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++) {
            bool in = x >= middle_x - half && x < middle_x + half && y >= middle_y - half &&
                      y < middle_y + half;
            assert_int_equal(soft_stage_colour(stage, x, y) != STAGE_GROUND, in);
        }
}

/* The near side of 2 m is 20 pixels wide at 20 m and 10 pixels at 40 m, textured and flat. */
static void test_covers_its_square(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    add(&stage, 0.0f, 0.0f, 21.0f, 1.0f);
    draw(&stage);
    expect_box(&stage, 10);
    float depth = soft_stage_depth(&stage, STAGE_WIDTH / 2, STAGE_HEIGHT / 2);
    assert_true(fabsf(1.0f / depth - 20.0f) < 0.01f);
    uint32_t colour = soft_stage_colour(&stage, STAGE_WIDTH / 2, STAGE_HEIGHT / 2);
    assert_true((colour & 255u) > 2 * (colour >> 8 & 255u));

    soft_stage_clear(&stage, STAGE_GROUND, 1000.0f);
    stage.list.bodies[0].at[2] = -41.0f;
    draw(&stage);
    expect_box(&stage, 5);
    soft_stage_close(&stage);
}

/* The nearest box is visible whatever the order; a box behind other things is hidden. */
static void test_nearest_wins(void **context)
{
    struct soft_stage stages[2];
    (void)context;
    for (uint32_t i = 0; i < 2; i++) {
        open_stage(&stages[i]);
        add(&stages[i], 0.3f, 0.1f, i == 0 ? 12.0f : 22.0f, 1.0f);
        add(&stages[i], 0.3f, 0.1f, i == 0 ? 22.0f : 12.0f, 1.0f);
        draw(&stages[i]);
    }
    soft_stage_assert_same(&stages[0], &stages[1]);
    soft_stage_clear(&stages[0], STAGE_GROUND, 10.0f);
    draw(&stages[0]);
    assert_int_equal(soft_stage_painted(&stages[0], STAGE_GROUND), 0);
    soft_stage_close(&stages[0]);
    soft_stage_close(&stages[1]);
}

/* A box around the eye is invisible, since its inner faces look away. A box that crosses the near
 * plane is clipped there. */
static void test_near_plane(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    add(&stage, 0.0f, 0.0f, 0.0f, 5.0f);
    draw(&stage);
    assert_int_equal(soft_stage_painted(&stage, STAGE_GROUND), 0);
    stage.list.body_count = 0;
    add(&stage, 0.0f, -3.0f, 0.0f, 2.5f); /* a floor under the eye, which crosses the near plane */
    draw(&stage);
    assert_true(soft_stage_painted(&stage, STAGE_GROUND) > 1000);
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++) {
            assert_true(soft_stage_depth(&stage, x, y) <= 1.0f / STAGE_NEAR_M + 1e-3f);
            if (y < STAGE_HEIGHT / 2)
                assert_int_equal(soft_stage_colour(&stage, x, y), STAGE_GROUND);
        }
    stage.list.body_count = 0;
    soft_stage_clear(&stage, STAGE_GROUND, 1000.0f);
    add(&stage, 0.0f, 0.0f, -20.0f, 3.0f);
    draw(&stage);
    assert_int_equal(soft_stage_painted(&stage, STAGE_GROUND), 0);
    soft_stage_close(&stage);
}

/* A box that is turned by 45 degrees is wider. */
static void test_turned_box_is_wider(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    struct draw_list_body *body = add(&stage, 0.0f, 0.0f, 21.0f, 1.0f);
    float part = 0.70710678f;
    memcpy(body->forward, (float[3]){part, 0.0f, -part}, sizeof body->forward);
    memcpy(body->right, (float[3]){part, 0.0f, part}, sizeof body->right);
    draw(&stage);
    uint32_t y = STAGE_HEIGHT / 2, wide = 0;
    for (uint32_t x = 0; x < STAGE_WIDTH; x++)
        wide += soft_stage_colour(&stage, x, y) != STAGE_GROUND;
    assert_in_range(wide, 26, 28);
    /* The side towards the sun is brighter. */
    uint32_t west = soft_stage_colour(&stage, STAGE_WIDTH / 2 - 6, y) & 255u;
    uint32_t east = soft_stage_colour(&stage, STAGE_WIDTH / 2 + 6, y) & 255u;
    assert_true(west > east + 20);
    soft_stage_close(&stage);
}

/* A dent moves the surface away. */
static void test_dent(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    struct draw_list_body *body = add(&stage, 0.0f, 0.0f, 11.0f, 1.0f);
    stage.list.instances[0].detail = MESH_FINE;
    draw(&stage);
    float whole = 1.0f / soft_stage_depth(&stage, STAGE_WIDTH / 2, STAGE_HEIGHT / 2);
    body->dents[1] = 1.0f;
    /* The dent is in the near side, which is the box's back. */
    stage.list.dents[0] = (struct draw_list_dent){.point = {-1.0f, 0.0f, 0.0f},
                                                  .depth_m = 0.6f,
                                                  .direction = {1.0f, 0.0f, 0.0f},
                                                  .reach_m = 1.0f};
    stage.list.dent_count = 1;
    soft_stage_clear(&stage, STAGE_GROUND, 1000.0f);
    draw(&stage);
    float bent = 1.0f / soft_stage_depth(&stage, STAGE_WIDTH / 2, STAGE_HEIGHT / 2);
    assert_true(bent > whole + 0.3f && bent < whole + 0.7f);
    soft_stage_close(&stage);
}

/* The shadow falls only on ground, and only where its plane lies. */
static void test_shadow_on_ground_alone(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    soft_stage_clear(&stage, STAGE_GROUND, 0.0f);
    for (uint32_t y = STAGE_HEIGHT / 2 + 1; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++)
            stage.depth[(size_t)y * stage.stride + x] =
                ((float)y + 0.5f - 0.5f * STAGE_HEIGHT) / (STAGE_FOCAL * 5.0f);
    struct draw_list_body *body = add(&stage, 0.0f, -4.0f, 30.0f, 1.0f);
    memcpy(body->plane, (float[4]){0.0f, 1.0f, 0.0f, -5.0f}, sizeof body->plane);
    stage.list.instances[0].shadow = 1;
    draw(&stage);
    uint32_t dark = 0;
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++) {
            uint32_t colour = soft_stage_colour(&stage, x, y);
            if (colour >= 0x01000000u || colour == STAGE_GROUND)
                continue;
            assert_int_equal(colour & 0xffffu, STAGE_GROUND);
            assert_in_range(colour >> SOFT_SHADOW_BITS, 250, SOFT_SHADOW_FULL);
            assert_true(y > STAGE_HEIGHT / 2 && x > STAGE_WIDTH / 2 - 8);
            dark++;
        }
    /* A box of 8 m3 under a sun 34 degrees high darkens some 6 m2 beside it, seen at ten
     * degrees. */
    assert_in_range(dark, 30, 150);

    stage.list.instances[0].shadow = 0;
    soft_stage_clear(&stage, STAGE_GROUND, 1000.0f);
    draw(&stage);
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++)
            assert_true(soft_stage_colour(&stage, x, y) == STAGE_GROUND ||
                        soft_stage_colour(&stage, x, y) >= 0x01000000u);
    soft_stage_close(&stage);
}

static float draw_number(uint64_t *seed, double low, double high)
{
    return (float)fixture_uniform(seed, low, high);
}

static void random_bodies(struct soft_stage *stage, uint64_t seed)
{
    for (uint32_t i = 0; i < 60; i++) {
        float far_m = 100.0f / draw_number(&seed, 1.0, 60.0);
        float x = draw_number(&seed, -0.7, 0.7) * far_m, y = draw_number(&seed, -0.4, 0.4) * far_m;
        struct draw_list_body *body = add(stage, x, y, far_m, draw_number(&seed, 0.5, 2.0));
        float turn = draw_number(&seed, -3.0, 3.0), scale = body->right[0];
        double s, c;
        maths_sincos((double)turn, &s, &c);
        memcpy(body->forward, (float[3]){(float)s * scale, 0.0f, -(float)c * scale},
               sizeof body->forward);
        memcpy(body->right, (float[3]){(float)c * scale, 0.0f, (float)s * scale},
               sizeof body->right);
        body->burn = draw_number(&seed, 0.0, 1.0);
        stage->list.instances[i].detail = (uint8_t)(i % MESH_DETAIL_COUNT);
        if (i % 3 == 0) {
            memcpy(body->plane, (float[4]){0.0f, 1.0f, 0.0f, y - scale}, sizeof body->plane);
            stage->list.instances[i].shadow = 1;
        }
        if (i % 4 == 0) {
            body->dents[0] = (float)stage->list.dent_count;
            body->dents[1] = 2.0f;
            for (uint32_t d = 0; d < 2; d++)
                stage->list.dents[stage->list.dent_count++] =
                    (struct draw_list_dent){.point = {draw_number(&seed, -1.0, 1.0), 1.0f, 0.0f},
                                            .depth_m = 0.3f,
                                            .direction = {0.0f, -1.0f, 0.0f},
                                            .reach_m = 0.9f};
        }
        if (i % 5 == 0)
            memcpy(body->collapse, (float[3]){0.5f, 0.2f, 0.9f}, sizeof body->collapse);
        if (i % 7 == 0)
            memcpy(body->broken, (float[3]){0.0f, 0.2f, 0.8f}, sizeof body->broken);
        body->noise_seed = (float)i;
    }
}

static void test_same_everywhere(void **context)
{
    const struct soft_kernels *builds[2];
    struct soft_stage stages[2];
    uint64_t seed = fixture_seed(13);
    (void)context;
    soft_stage_builds(builds);
    for (uint32_t i = 0; i < 2; i++) {
        soft_stage_open(&stages[i], builds[i]);
        soft_stage_clear(&stages[i], STAGE_GROUND, 60.0f);
        random_bodies(&stages[i], seed);
        draw(&stages[i]);
    }
    assert_true(soft_stage_painted(&stages[0], STAGE_GROUND) > 5000);
    soft_stage_assert_same(&stages[0], &stages[1]);
    soft_stage_close(&stages[0]);
    soft_stage_close(&stages[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_covers_its_square),
        cmocka_unit_test(test_nearest_wins),
        cmocka_unit_test(test_near_plane),
        cmocka_unit_test(test_turned_box_is_wider),
        cmocka_unit_test(test_dent),
        cmocka_unit_test(test_shadow_on_ground_alone),
        cmocka_unit_test(test_same_everywhere),
    };
    return cmocka_run_group_tests_name("soft_bodies", tests, open_bodies, close_bodies);
}
