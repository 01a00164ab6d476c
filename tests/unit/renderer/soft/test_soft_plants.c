/* The software back end's plants: upright pictures, and their shadows on the slope. */
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

#define WALL 0xff000003u /* not ground: takes no shadow */

static struct soft_detail detail;
static struct soft_plants *plants;
static struct soft_bodies *bodies; /* empty; the shadow kernel takes both */

static int open_plants(void **context)
{
    static struct world world;
    static struct static_scene static_scene = {.world = &world};
    struct error_text error;
    (void)context;
    if (soft_detail_make(&detail) != 0)
        return -1;
    plants = soft_plants_open(&error);
    bodies = soft_bodies_open(&static_scene, &detail, &error);
    return plants != NULL && bodies != NULL ? 0 : -1;
}

static int close_plants(void **context)
{
    (void)context;
    soft_plants_close(plants);
    soft_bodies_close(bodies);
    soft_detail_free(&detail);
    return 0;
}

static void open_stage(struct soft_stage *stage)
{
    const struct soft_kernels *builds[2];
    soft_stage_builds(builds);
    soft_stage_open(stage, builds[1]);
}

static void draw(struct soft_stage *stage)
{
    const struct soft_kernels *k = stage->frame.kernels;
    assert_int_equal(soft_bodies_prepare(bodies, &stage->frame), 0);
    assert_int_equal(soft_plants_prepare(plants, &stage->frame), 0);
    for (uint32_t band = 0; band < stage->frame.bands; band++) {
        struct soft_target target = soft_stage_band(stage, band);
        k->soft_shadows_fill(bodies, plants, &stage->frame, &target);
        k->soft_plants_fill(plants, &stage->frame, &target);
    }
}

static struct draw_list_plant *add(struct soft_stage *stage, float x, float y, float far_m,
                                   float high)
{
    struct draw_list_plant *plant = &stage->list.plants[stage->list.plant_count++];
    *plant = (struct draw_list_plant){.at = {x, y, -far_m},
                                      .width = high,
                                      .height = high,
                                      .picture = (float)PLANT_IMPOSTORS_OAK_A,
                                      .tint = {1.0f, 1.0f, 1.0f}};
    return plant;
}

static uint32_t shadow_at(const struct soft_stage *stage, uint32_t x, uint32_t y)
{
    return soft_stage_colour(stage, x, y) >> SOFT_SHADOW_BITS & 255u;
}

/* Fills the picture as level ground that is low_m below the eye. */
static void lay_ground(struct soft_stage *stage, float low_m)
{
    soft_stage_clear(stage, 0, 0.0f);
    for (uint32_t y = STAGE_HEIGHT / 2 + 1; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++) {
            size_t at = (size_t)y * stage->stride + x;
            stage->colour[at] = STAGE_GROUND;
            stage->depth[at] =
                ((float)y + 0.5f - 0.5f * (float)STAGE_HEIGHT) / (STAGE_FOCAL * low_m);
        }
}

/* An oak of 10 m at 50 m is 40 pixels wide and high and stands on its foot. */
static void test_stands_on_its_foot(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    add(&stage, 5.0f, -5.0f, 50.0f, 10.0f);
    draw(&stage);
    uint32_t left = STAGE_WIDTH, right = 0, high = STAGE_HEIGHT, low = 0;
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++)
            if (soft_stage_colour(&stage, x, y) != STAGE_GROUND) {
                left = x < left ? x : left;
                right = x > right ? x : right;
                high = y < high ? y : high;
                low = y > low ? y : low;
                assert_true(fabsf(1.0f / soft_stage_depth(&stage, x, y) - 50.0f) < 2.5f);
            }
    assert_in_range(left, STAGE_WIDTH / 2, STAGE_WIDTH / 2 + 6);
    assert_in_range(right, STAGE_WIDTH / 2 + 33, STAGE_WIDTH / 2 + 40);
    assert_in_range(high, STAGE_HEIGHT / 2 - 21, STAGE_HEIGHT / 2 - 13);
    assert_in_range(low, STAGE_HEIGHT / 2 + 18, STAGE_HEIGHT / 2 + 19);
    soft_stage_close(&stage);
}

static void test_hidden_behind_a_wall(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    add(&stage, 0.0f, -5.0f, 50.0f, 10.0f);
    soft_stage_clear(&stage, WALL, 49.0f);
    draw(&stage);
    assert_int_equal(soft_stage_painted(&stage, WALL), 0);
    soft_stage_clear(&stage, WALL, 51.0f);
    draw(&stage);
    assert_true(soft_stage_painted(&stage, WALL) > 300);
    soft_stage_close(&stage);
}

/* The result does not depend on the order in the list. */
static void test_nearer_wins_in_any_order(void **context)
{
    struct soft_stage stages[2];
    (void)context;
    for (uint32_t i = 0; i < 2; i++) {
        open_stage(&stages[i]);
        struct draw_list_plant *a = add(&stages[i], 0.0f, -5.0f, i == 0 ? 50.0f : 40.0f, 10.0f);
        struct draw_list_plant *b = add(&stages[i], 0.0f, -5.0f, i == 0 ? 40.0f : 50.0f, 10.0f);
        (i == 0 ? a : b)->tint[0] = 0.0f;
        draw(&stages[i]);
    }
    soft_stage_assert_same(&stages[0], &stages[1]);
    soft_stage_close(&stages[0]);
    soft_stage_close(&stages[1]);
}

static void test_none_behind_the_eye(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    add(&stage, 0.0f, -1.0f, -5.0f, 10.0f);
    draw(&stage);
    assert_int_equal(soft_stage_painted(&stage, STAGE_GROUND), 0);
    /* This plant is beside the eye: half of its width lies ahead, mostly outside the picture. */
    add(&stage, 3.0f, -5.0f, 1.5f, 10.0f);
    draw(&stage);
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++)
            assert_true(soft_stage_depth(&stage, x, y) <= 1.0f / STAGE_NEAR_M + 1e-3f);
    soft_stage_close(&stage);
}

/* The shadow lies only on the ground, on the side away from the sun. */
static void test_shadow_on_ground_alone(void **context)
{
    struct soft_stage stage;
    (void)context;
    open_stage(&stage);
    lay_ground(&stage, 10.0f);
    add(&stage, 0.0f, -10.0f, 50.0f, 10.0f);
    draw(&stage);
    uint32_t dark = 0, east = 0;
    for (uint32_t y = 0; y < STAGE_HEIGHT; y++)
        for (uint32_t x = 0; x < STAGE_WIDTH; x++) {
            if (soft_stage_colour(&stage, x, y) >= 0x01000000u || shadow_at(&stage, x, y) == 0)
                continue;
            assert_true(y > STAGE_HEIGHT / 2);
            assert_int_equal(soft_stage_colour(&stage, x, y) & 0xffffu, STAGE_GROUND);
            dark++;
            east += x > STAGE_WIDTH / 2;
        }
    assert_true(dark > 100);
    assert_true(east > dark * 9 / 10); /* the sun is in the west */

    /* Neither other surfaces nor ground in front of the shadow's plane take a shadow. */
    soft_stage_clear(&stage, WALL, 60.0f);
    stage.list.plants[0].tint[0] = stage.list.plants[0].tint[1] = 0.0f;
    assert_int_equal(soft_plants_prepare(plants, &stage.frame), 0);
    for (uint32_t band = 0; band < stage.frame.bands; band++) {
        struct soft_target target = soft_stage_band(&stage, band);
        stage.frame.kernels->soft_shadows_fill(bodies, plants, &stage.frame, &target);
    }
    assert_int_equal(soft_stage_painted(&stage, WALL), 0);
    soft_stage_clear(&stage, STAGE_GROUND, 30.0f);
    for (uint32_t band = 0; band < stage.frame.bands; band++) {
        struct soft_target target = soft_stage_band(&stage, band);
        stage.frame.kernels->soft_shadows_fill(bodies, plants, &stage.frame, &target);
    }
    assert_int_equal(soft_stage_painted(&stage, STAGE_GROUND), 0);
    soft_stage_close(&stage);
}

static void random_plants(struct soft_stage *stage, uint64_t seed)
{
    lay_ground(stage, 6.0f);
    for (uint32_t i = 0; i < 300; i++) {
        float far_m = 100.0f / (float)fixture_uniform(&seed, 0.1, 60.0);
        float aside = (float)fixture_uniform(&seed, -0.7, 0.7) * far_m;
        struct draw_list_plant *plant = add(stage, aside, (float)fixture_uniform(&seed, -7.0, -5.0),
                                            far_m, (float)fixture_uniform(&seed, 0.2, 14.0));
        plant->picture = (float)(i % PLANT_IMPOSTORS_COUNT);
        plant->lean = i % 5 == 0 ? (float)fixture_uniform(&seed, -2.0, 2.0) : 0.0f;
        plant->slope[0] = (float)fixture_uniform(&seed, -0.3, 0.3);
        plant->slope[1] = (float)fixture_uniform(&seed, -0.3, 0.3);
    }
}

static void test_same_everywhere(void **context)
{
    const struct soft_kernels *builds[2];
    struct soft_stage stages[2];
    uint64_t seed = fixture_seed(12);
    (void)context;
    soft_stage_builds(builds);
    for (uint32_t i = 0; i < 2; i++) {
        soft_stage_open(&stages[i], builds[i]);
        random_plants(&stages[i], seed);
        stages[i].frame.texture = seed % 2 == 0;
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
        cmocka_unit_test(test_stands_on_its_foot),
        cmocka_unit_test(test_hidden_behind_a_wall),
        cmocka_unit_test(test_nearer_wins_in_any_order),
        cmocka_unit_test(test_none_behind_the_eye),
        cmocka_unit_test(test_shadow_on_ground_alone),
        cmocka_unit_test(test_same_everywhere),
    };
    return cmocka_run_group_tests_name("soft_plants", tests, open_plants, close_plants);
}
