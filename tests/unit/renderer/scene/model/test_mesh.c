/* Meshes: consecutive levels of detail look alike, and parts turn about the right pivots. */
#include "renderer/scene/model/mesh.h"

#include "config/loader.h"
#include "renderer/scene/model/track_outline.h"
#include "tests/support/quick_config.h"
#include "world/making/scenario.h"
#include "world/maths/maths.h"
#include "world/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE_MAX   440u /* [sample] side of a silhouette's square */
#define SAMPLES    2.0  /* samples along a pixel's side */
#define VIEWS      4u
#define AREA_APART 0.15 /* most difference of the areas of silhouettes of two levels ... */
#define SKIN_APART 0.16 /* ... and most area that only one of them covers */
#define FAR_SHARE  3.2  /* factor from the coarsest level on, which has a few pixels */

static struct scenario shipped;
static struct world world;

static int load_shipped(void **state)
{
    struct error_text error;
    (void)state;
    if (loader_scenario(&shipped, QUICK_CONFIG_SHIPPED, "duel", NULL, 0, &error) != 0)
        return -1;
    world = (struct world){.models = shipped.models,
                           .model_vertices = shipped.vertices,
                           .model_triangles = shipped.triangles};
    world.counts.models = shipped.model_count;
    return 0;
}

static int free_shipped(void **state)
{
    (void)state;
    scenario_free(&shipped);
    return 0;
}

static uint32_t model_of(const char *kind)
{
    uint16_t index = kind_find(shipped.kinds, shipped.kind_count, kind);
    assert_int_not_equal(index, KIND_NONE);
    return shipped.kinds[index].model;
}

/* --- silhouettes ------------------------------------------------------------------------------ */

struct silhouette {
    double right[3], up[3]; /* axes of the picture, scaled to samples a metre */
    double middle[3];
    uint8_t covered[SIDE_MAX * SIDE_MAX];
};

static double cross2(const double a[2], const double b[2], double x, double y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static void cover(struct silhouette *s, const double p[3][2])
{
    double x0 = fmin(p[0][0], fmin(p[1][0], p[2][0])), x1 = fmax(p[0][0], fmax(p[1][0], p[2][0]));
    double y0 = fmin(p[0][1], fmin(p[1][1], p[2][1])), y1 = fmax(p[0][1], fmax(p[1][1], p[2][1]));
    assert_true(x0 >= 0.0 && y0 >= 0.0 && x1 < SIDE_MAX && y1 < SIDE_MAX);
    for (uint32_t y = (uint32_t)y0; y <= (uint32_t)y1; y++)
        for (uint32_t x = (uint32_t)x0; x <= (uint32_t)x1; x++) {
            double at[2] = {x + 0.5, y + 0.5};
            double a = cross2(p[0], p[1], at[0], at[1]), b = cross2(p[1], p[2], at[0], at[1]),
                   c = cross2(p[2], p[0], at[0], at[1]);
            if ((a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0))
                s->covered[y * SIDE_MAX + x] = 1;
        }
}

static void draw(struct silhouette *s, const struct mesh *mesh)
{
    memset(s->covered, 0, sizeof s->covered);
    for (uint32_t i = 0; i < mesh->count; i += 3) {
        double p[3][2];
        for (uint32_t c = 0; c < 3; c++) {
            p[c][0] = p[c][1] = 0.5 * SIDE_MAX;
            for (uint32_t axis = 0; axis < 3; axis++) {
                double off = (double)mesh->vertices[i + c].position[axis] - s->middle[axis];
                p[c][0] += s->right[axis] * off;
                p[c][1] += s->up[axis] * off;
            }
        }
        cover(s, (const double(*)[2])p);
    }
}

/* Draws the silhouette from the side and slightly above. samples: in a metre. */
static void look(struct silhouette *s, const struct mesh_skeleton *skeleton, uint32_t view,
                 double samples)
{
    double turn = 0.3 + TWO_PI * view / VIEWS, lift = 0.35;
    const double right[3] = {sin(turn), 0.0, cos(turn)};
    const double up[3] = {-cos(turn) * sin(lift), cos(lift), sin(turn) * sin(lift)};
    for (uint32_t i = 0; i < 3; i++) {
        s->right[i] = right[i] * samples;
        s->up[i] = up[i] * samples;
        s->middle[i] = 0.5 * ((double)skeleton->low[i] + (double)skeleton->high[i]);
    }
}

static void compare(const struct mesh *fine, const struct mesh *coarse,
                    const struct mesh_skeleton *skeleton, double pixels, const char *name)
{
    static struct silhouette a, b;
    double longest = 0.0;
    for (uint32_t i = 0; i < 3; i++)
        longest = fmax(longest, (double)skeleton->high[i] - (double)skeleton->low[i]);
    for (uint32_t view = 0; view < VIEWS; view++) {
        uint32_t area_a = 0, area_b = 0, apart = 0;
        look(&a, skeleton, view, SAMPLES * pixels / longest);
        look(&b, skeleton, view, SAMPLES * pixels / longest);
        draw(&a, fine);
        draw(&b, coarse);
        for (uint32_t i = 0; i < SIDE_MAX * SIDE_MAX; i++) {
            area_a += a.covered[i];
            area_b += b.covered[i];
            apart += a.covered[i] != b.covered[i];
        }
        double share = pixels > MESH_COARSE_PIXELS ? 1.0 : FAR_SHARE;
        if (fabs((double)area_a - (double)area_b) > share * AREA_APART * area_a ||
            apart > share * SKIN_APART * area_a)
            fail_msg("%s at %g pixels, view %u: covers %u samples, then %u; %u apart", name, pixels,
                     view, area_a, area_b, apart);
    }
}

/* Where one level follows another, the pictures are nearly equal. */
static void test_levels_look_alike(void **state)
{
    static const double pixels[MESH_DETAIL_COUNT] = {[MESH_MIDDLE] = MESH_FULL_PIXELS,
                                                     [MESH_COARSE] = MESH_MIDDLE_PIXELS,
                                                     [MESH_COARSEST] = MESH_COARSE_PIXELS};
    (void)state;
    for (uint32_t m = 0; m < world.counts.models; m++) {
        struct mesh_skeleton skeleton;
        struct mesh fine;
        assert_int_equal(mesh_skeleton(&skeleton, &world, m), 0);
        assert_int_equal(mesh_build(&fine, &world, m, MESH_FULL), 0);
        for (enum mesh_detail detail = MESH_MIDDLE; detail < MESH_DETAIL_COUNT; detail++) {
            struct mesh coarse;
            assert_int_equal(mesh_build(&coarse, &world, m, detail), 0);
            assert_true(coarse.count <= fine.count);
            compare(&fine, &coarse, &skeleton, pixels[detail], shipped.models[m].name);
            mesh_free(&fine);
            fine = coarse;
        }
        mesh_free(&fine);
    }
}

/* Coarse levels have few triangles, because many bodies may be far away. */
static void test_coarse_levels_are_small(void **state)
{
    static const uint32_t most[MESH_DETAIL_COUNT] = {[MESH_MIDDLE] = MESH_MIDDLE_MAX,
                                                     [MESH_COARSE] = MESH_COARSE_MAX,
                                                     [MESH_COARSEST] = MESH_COARSEST_MAX};
    (void)state;
    for (uint32_t m = 0; m < world.counts.models; m++)
        for (enum mesh_detail detail = MESH_MIDDLE; detail < MESH_DETAIL_COUNT; detail++) {
            struct mesh mesh;
            assert_int_equal(mesh_build(&mesh, &world, m, detail), 0);
            if (mesh.count / 3 > most[detail])
                fail_msg("%s has %u triangles at level %u", shipped.models[m].name, mesh.count / 3,
                         detail);
            mesh_free(&mesh);
        }
}

/* --- parts ------------------------------------------------------------------------------------ */

/* The corners of a joint lie around its pivot: those of a wheel within its radius, some at it. */
static void test_wheels_turn_about_their_axles(void **state)
{
    static const char *const kinds[] = {"tank", "carrier", "truck", "jeep"};
    (void)state;
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        struct mesh_skeleton skeleton;
        struct mesh mesh;
        double reach[MODEL_JOINTS_MAX] = {0.0};
        assert_int_equal(mesh_skeleton(&skeleton, &world, model_of(kinds[k])), 0);
        assert_int_equal(mesh_build(&mesh, &world, model_of(kinds[k]), MESH_FULL), 0);
        for (uint32_t i = 0; i < mesh.count; i++) {
            const struct mesh_vertex *v = &mesh.vertices[i];
            const float *pivot = skeleton.pivot[v->joint];
            if (v->part == PART_WHEEL || v->part == PART_FRONT_WHEEL)
                reach[v->joint] =
                    fmax(reach[v->joint], hypot((double)v->position[0] - (double)pivot[0],
                                                (double)v->position[1] - (double)pivot[1]));
        }
        for (uint32_t joint = 1; joint < MODEL_JOINTS_MAX; joint++)
            if (reach[joint] > 0.0) {
                double radius = (double)skeleton.pivot[joint][3];
                assert_true(fabs(reach[joint] / radius - 1.0) < 0.06);
                assert_true(fabs((double)skeleton.pivot[joint][2]) > 0.4); /* at a side */
            }
        mesh_free(&mesh);
    }
}

/* The tank's turret is on its ring, its gun held behind the mantlet. */
static void test_turret_and_gun_pivots(void **state)
{
    struct mesh_skeleton skeleton;
    uint32_t guns = 0;
    (void)state;
    assert_int_equal(mesh_skeleton(&skeleton, &world, model_of("tank")), 0);
    assert_true(skeleton.turret);
    assert_true(fabs((double)skeleton.pivot[0][0] + 0.2) < 0.02);
    assert_true(fabs((double)skeleton.pivot[0][2]) < 0.02);
    for (uint32_t joint = 1; joint < MODEL_JOINTS_MAX; joint++)
        guns += fabsf(skeleton.pivot[joint][0] - 1.3f) < 0.01f && skeleton.pivot[joint][1] > 1.5f;
    assert_int_equal(guns, 1);
    assert_int_equal(mesh_skeleton(&skeleton, &world, model_of("jet")), 0);
    assert_false(skeleton.turret);
}

/* A rotor's hub is above the fuselage, its radius that of its blades; the tail rotor is upright. */
static void test_rotors_reach_to_their_tips(void **state)
{
    struct mesh_skeleton skeleton;
    uint32_t rotors = 0, tails = 0;
    (void)state;
    assert_int_equal(mesh_skeleton(&skeleton, &world, model_of("helicopter")), 0);
    for (uint32_t joint = 0; joint < MODEL_JOINTS_MAX; joint++) {
        const float *pivot = skeleton.pivot[joint];
        if (skeleton.part[joint] == PART_ROTOR) {
            rotors++;
            assert_true(fabsf(pivot[0]) < 0.01f && fabsf(pivot[2]) < 0.01f && pivot[1] > 1.5f);
            assert_true(fabsf(pivot[3] - 6.38f) < 0.05f);
        } else if (skeleton.part[joint] == PART_TAIL_ROTOR) {
            tails++;
            assert_true(pivot[0] < -6.0f && fabsf(pivot[3] - 1.0f) < 0.05f);
        }
    }
    assert_true(rotors == 1 && tails == 1);
}

/* Links have about the intended length, a whole even number goes around, and no triangle of a track
 * spans a jump. */
static void test_links_run_around_a_track(void **state)
{
    uint32_t model = model_of("tank"), on_track = 0;
    struct mesh_skeleton skeleton;
    struct mesh mesh;
    (void)state;
    assert_int_equal(mesh_skeleton(&skeleton, &world, model), 0);
    for (enum mesh_detail detail = MESH_FINE; detail < MESH_DETAIL_COUNT; detail++) {
        assert_int_equal(mesh_build(&mesh, &world, model, detail), 0);
        for (uint32_t i = 0; i < mesh.count; i += 3) {
            const struct mesh_vertex *v = &mesh.vertices[i];
            double link_m = (double)skeleton.pivot[v->joint][3], longest = 0.0;
            if (v->part != PART_TRACK)
                continue;
            on_track++;
            assert_true(link_m > 0.15 && link_m < 0.3);
            for (uint32_t c = 1; c < 3; c++)
                longest = fmax(longest, fabs((double)v[c].along - (double)v[0].along));
            struct track_outline belt;
            assert_int_equal(track_outline_find(&belt, &world, model, v->joint), 0);
            double links = (double)belt.along[belt.count] / link_m;
            assert_true(fabs(links / 2.0 - round(links / 2.0)) < 1e-3);
            assert_true(longest <= 0.5 * links + 1e-3);
            track_outline_free(&belt);
        }
        mesh_free(&mesh);
    }
    assert_true(on_track > 100);
}

/* The lower run moves backwards when driving forward, so along falls from front to rear. */
static void test_links_count_backwards(void **state)
{
    struct track_outline belt;
    struct mesh mesh;
    uint32_t model = model_of("tank"), i = 0;
    (void)state;
    assert_int_equal(mesh_build(&mesh, &world, model, MESH_FULL), 0);
    while (i < mesh.count && mesh.vertices[i].part != PART_TRACK)
        i++;
    assert_true(i < mesh.count);
    assert_int_equal(track_outline_find(&belt, &world, model, mesh.vertices[i].joint), 0);
    mesh_free(&mesh);
    const float rear[3] = {-1.0f, 0.0f, 0.0f}, front[3] = {1.0f, 0.0f, 0.0f};
    float from = track_outline_along(&belt, rear, 0.0f),
          to = track_outline_along(&belt, front, from);
    assert_true(fabs((double)(to - from) * (double)belt.link_m - 2.0) < 1e-3);
    track_outline_free(&belt);
}

/* Round bodies are smooth, and all normals are unit vectors. */
static void test_normals(void **state)
{
    struct mesh mesh;
    uint32_t smooth = 0;
    (void)state;
    assert_int_equal(mesh_build(&mesh, &world, model_of("attack-tomato"), MESH_FULL), 0);
    for (uint32_t i = 0; i < mesh.count; i++) {
        const float *n = mesh.vertices[i].normal, *first = mesh.vertices[i - i % 3].normal;
        double length = sqrt((double)n[0] * (double)n[0] + (double)n[1] * (double)n[1] +
                             (double)n[2] * (double)n[2]);
        assert_true(fabs(length - 1.0) < 1e-5);
        smooth += memcmp(n, first, 3 * sizeof *n) != 0;
    }
    assert_true(smooth > mesh.count / 3);
    mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_levels_look_alike),
        cmocka_unit_test(test_coarse_levels_are_small),
        cmocka_unit_test(test_wheels_turn_about_their_axles),
        cmocka_unit_test(test_turret_and_gun_pivots),
        cmocka_unit_test(test_rotors_reach_to_their_tips),
        cmocka_unit_test(test_links_run_around_a_track),
        cmocka_unit_test(test_links_count_backwards),
        cmocka_unit_test(test_normals),
    };
    return cmocka_run_group_tests(tests, load_shipped, free_shipped);
}
