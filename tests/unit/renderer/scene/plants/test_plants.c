/* Plants of a picture: none in view is culled, distant woods are thinned out without jumps, and
 * single trees stay. */
#include "renderer/scene/scene.h"

#include "tests/support/fixture.h"
#include "tests/support/scene_stage.h"
#include "world/params.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CAPACITY 16u
#define WOOD     40u  /* trees in one gridsquare */
#define LONE     300u /* trees that stand alone */
#define TREES    (WOOD + LONE)
#define WOOD_X   (200.5 * 125.0) /* [m] the gridsquare's middle */

static const struct kind kinds[] = {{.name = "oak",
                                     .domain = DOMAIN_FIXED,
                                     .object_class = OBJECT_TREE,
                                     .radius_m = 4.0,
                                     .height_m = 10.0}};

static int by_square(const void *a, const void *b)
{
    const struct fixed_object *p = a, *q = b;
    uint32_t first = gridsquare_of(&GRIDSQUARES_DEFAULT, p->x, p->z),
             second = gridsquare_of(&GRIDSQUARES_DEFAULT, q->x, q->z);
    return (first > second) - (first < second);
}

/* A wood in the middle of the world, and single trees around it, each in its own gridsquare. */
static void plant(struct scene_stage *s)
{
    uint64_t random = fixture_seed(3);
    for (uint32_t i = 0; i < TREES; i++) {
        struct fixed_object *tree = &s->fixed[i];
        tree->x = WOOD_X + fixture_uniform(&random, -60.0, 60.0);
        tree->z = WOOD_X + fixture_uniform(&random, -60.0, 60.0);
        if (i >= WOOD) {
            uint32_t column = (i - WOOD) % 20, row = (i - WOOD) / 20;
            tree->x = (186.0 + 2.0 * (column + column / 8) + 0.5) * 125.0;
            tree->z = (188.0 + 2.0 * (row + 1.0) + 0.5 - (row >= 5 ? 1.0 : 0.0)) * 125.0;
        }
        tree->y = (float)terrain_base_height(&s->world.terrain, tree->x, tree->z);
        tree->radius_m = 4.0f;
        tree->height_m = (float)fixture_uniform(&random, 6.0, 14.0);
    }
    qsort(s->fixed, TREES, sizeof *s->fixed, by_square);
}

static int open_stage(void **context)
{
    struct scene_stage *s = scene_stage_new(CAPACITY, TREES);
    s->params.hz = 10.0;
    s->params.dt_s = 0.1;
    for (uint32_t row = 0; row < SCENE_STAGE_POSTS; row++)
        for (uint32_t column = 0; column < SCENE_STAGE_POSTS; column++)
            s->posts[row * SCENE_STAGE_POSTS + column] =
                (float)(300.0 + 60.0 * maths_sin(column * 0.11) * maths_cos(row * 0.07));
    s->world.kinds = kinds;
    s->world.counts.kinds = 1;
    s->world.counts.fixed = TREES;
    plant(s);
    scene_stage_ready(s);
    *context = s;
    return 0;
}

static void look(struct scene_stage *s, struct vec3 eye, struct vec3 target)
{
    struct camera camera;
    camera_look(&camera, eye, target, 1280, 720);
    scene_build(&s->list, &camera, &s->static_scene, &s->frame_view, &s->effects);
}

/* Looks at the wood from this far south. */
static void look_at_wood(struct scene_stage *s, double away)
{
    struct vec3 wood = {WOOD_X, terrain_base_height(&s->world.terrain, WOOD_X, WOOD_X), WOOD_X};
    look(s, vec3_add(wood, (struct vec3){0.0, 30.0 + 0.2 * away, away}), wood);
}

/* Returns the plant of the picture for this tree, or NULL. */
static const struct draw_list_plant *shown(const struct scene_stage *s,
                                           const struct fixed_object *tree)
{
    float at[3];
    draw_list_relative(&s->list, fixed_position(tree), at);
    for (uint32_t i = 0; i < s->list.plant_count; i++)
        if (s->list.plants[i].at[0] == at[0] && s->list.plants[i].at[2] == at[2])
            return &s->list.plants[i];
    return NULL;
}

static bool in_wood(const struct fixed_object *tree)
{
    return gridsquare_of(&GRIDSQUARES_DEFAULT, tree->x, tree->z) ==
           gridsquare_of(&GRIDSQUARES_DEFAULT, WOOD_X, WOOD_X);
}

static void test_no_plant_in_view_is_culled(void **context)
{
    struct scene_stage *s = *context;
    uint64_t random = fixture_seed(5);
    uint32_t inside = 0, left_out = 0;
    for (uint32_t round = 0; round < 60; round++) {
        double x = fixture_uniform(&random, 23000.0, 28000.0);
        double z = fixture_uniform(&random, 22500.0, 27500.0);
        double turn = fixture_uniform(&random, 0.0, TWO_PI);
        double y = terrain_base_height(&s->world.terrain, x, z) + fixture_uniform(&random, 2, 300);
        look(s, (struct vec3){x, y, z},
             (struct vec3){x + 100.0 * maths_cos(turn), y + fixture_uniform(&random, -60.0, 10.0),
                           z + 100.0 * maths_sin(turn)});
        for (uint32_t i = 0; i < TREES; i++) {
            const struct fixed_object *tree = &s->fixed[i];
            struct vec3 foot = fixed_position(tree);
            double far = vec3_length(vec3_sub(foot, s->list.camera.eye));
            double pixels = camera_pixels(&s->list.camera, (double)tree->height_m, far);
            if (in_wood(tree) || pixels < 2.1)
                continue;
            bool sees = camera_sees(&s->list.camera, foot, 0.0);
            assert_true(!sees || shown(s, tree) != NULL);
            inside += sees;
            left_out += shown(s, tree) == NULL;
        }
    }
    assert_true(inside > 500 && left_out > 5000);
}

static void test_far_woods_are_thinned_out(void **context)
{
    struct scene_stage *s = *context;
    double width[2] = {0.0, 0.0};
    uint32_t trees[2] = {0, 0};
    for (uint32_t far = 0; far < 2; far++) {
        look_at_wood(s, far ? 2500.0 : 300.0);
        for (uint32_t i = 0; i < TREES; i++) {
            const struct draw_list_plant *plant = shown(s, &s->fixed[i]);
            if (!in_wood(&s->fixed[i]) || plant == NULL)
                continue;
            trees[far]++;
            width[far] += (double)plant->width;
        }
    }
    assert_int_equal(trees[0], WOOD);
    assert_true(trees[1] < WOOD * 2 / 3 && trees[1] > WOOD / 5);
    /* The remaining plants cover as much of the hill as all did, overlapping crowns included. */
    assert_true(width[1] > 0.45 * width[0] && width[1] < width[0]);
}

static void test_single_trees_stay(void **context)
{
    struct scene_stage *s = *context;
    for (double away = 300.0; away < 2600.0; away *= 1.2) {
        look_at_wood(s, away);
        for (uint32_t i = 0; i < TREES; i++) {
            const struct fixed_object *tree = &s->fixed[i];
            double far = vec3_length(vec3_sub(fixed_position(tree), s->list.camera.eye));
            double pixels = camera_pixels(&s->list.camera, (double)tree->height_m, far);
            if (in_wood(tree) || pixels < 3.1 ||
                !camera_sees(&s->list.camera, fixed_position(tree), 0.0))
                continue;
            const struct draw_list_plant *plant = shown(s, tree);
            assert_true(plant != NULL && plant->height == tree->height_m);
        }
    }
}

static void test_no_plant_appears_or_vanishes_suddenly(void **context)
{
    struct scene_stage *s = *context;
    for (double away = 300.0; away < 4500.0; away *= 1.02) {
        float before[TREES];
        look_at_wood(s, away);
        for (uint32_t i = 0; i < TREES; i++) {
            const struct draw_list_plant *plant = shown(s, &s->fixed[i]);
            before[i] = plant == NULL ? 0.0f : plant->height;
        }
        look_at_wood(s, 1.001 * away);
        for (uint32_t i = 0; i < TREES; i++) {
            const struct draw_list_plant *plant = shown(s, &s->fixed[i]);
            float now = plant == NULL ? 0.0f : plant->height;
            if (!in_wood(&s->fixed[i]))
                continue; /* others may leave the picture */
            assert_true(fabsf(now - before[i]) < 0.02f * s->fixed[i].height_m);
        }
    }
}

static void test_less_detail_is_less_of_a_wood(void **context)
{
    struct scene_stage *s = *context;
    uint32_t before = UINT32_MAX;
    for (float detail = 1.0f; detail > 0.2f; detail -= 0.1f) {
        s->list.detail = detail;
        look_at_wood(s, 900.0);
        assert_true(s->list.plant_count <= before);
        before = s->list.plant_count;
    }
    s->list.detail = 1.0f;
    look_at_wood(s, 900.0);
    assert_true(before < s->list.plant_count - 10);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, scene_stage_teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_no_plant_in_view_is_culled),
        TEST(test_far_woods_are_thinned_out),
        TEST(test_single_trees_stay),
        TEST(test_no_plant_appears_or_vanishes_suddenly),
        TEST(test_less_detail_is_less_of_a_wood),
    };
    return cmocka_run_group_tests_name("plants", tests, NULL, NULL);
}
