/* Buildings, trees and poles of a ground file in a scenario and in the world made of it. */
#include "config/ground_objects.h"

#include "supervisor/ground/ground_write.h"
#include "tests/support/quick_config.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/maths/rotation.h"
#include "world/model.h"
#include "world/terrain/fixed.h"
#include "world/terrain/ground_tile.h"

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

/* A house that stands askew, and one of two parts. */
#define CORNERS 12u
static const struct ground_building buildings[] = {
    {20000123, 30000457, -1500, 5000, 7000, 12345, 1},
    {20100000, 30000000, -500, 6000, 6000, 40000, 2}};
static const struct ground_corner corners[] = {
    {-1234, -6789, 0}, {6543, 1111, 0},  {1234, 6789, 0}, {-6543, -1111, 0},
    {-5000, -5000, 1}, {5000, -5000, 1}, {5000, 0, 1},    {-5000, 0, 1},
    {-5000, 0, 2},     {0, 0, 2},        {0, 7000, 2},    {-5000, 7000, 2}};
static const struct ground_object objects[] = {{1000000, 2000000, GROUND_TREE, 90, 3},
                                               {1000000, 2050500, GROUND_POLE, 250, 16384},
                                               {1100000, 2000000, GROUND_BUSH, 100, 0},
                                               {1200000, 2000000, GROUND_PINE, 110, 65535},
                                               {1300000, 2000000, GROUND_WATERTOWER, 100, 0}};
#define OBJECTS 5u

static float posts[SIDE * SIDE];
static uint8_t cover[SIDE * SIDE];
static char path[96];
static struct error_text error;

static double side_m = 50000.0;

static void put_ground(void)
{
    struct ground_header header = {.latitude_deg = 44.5,
                                   .longitude_deg = -71.25,
                                   .side_m = side_m,
                                   .spacing_m = side_m / (SIDE - 1),
                                   .posts_side = SIDE};
    const struct ground_content content = {.posts = posts,
                                           .cover = cover,
                                           .text = "",
                                           .objects = objects,
                                           .object_count = OBJECTS,
                                           .buildings = buildings,
                                           .building_count = 2,
                                           .corners = corners,
                                           .corner_count = CORNERS};
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        posts[i] = 100.0f;
    snprintf(path, sizeof path, "%s/x.ground", quick_config.folder);
    assert_int_equal(ground_write(path, &header, &content, NULL, &error), 0);
}

static void must_load(struct scenario *scenario, const char *text)
{
    if (quick_config_load(scenario, text, NULL, &error) != 0)
        fail_msg("refused: %s", error.text);
}

/* Returns how far the nearest corner of the outline is from a point on the map [m]. */
static double nearest(const struct ground_building *building, uint32_t first, uint32_t count,
                      double x, double z)
{
    double least = INFINITY;
    for (uint32_t i = first; i < first + count; i++) {
        double dx = (building->x_mm + corners[i].x_mm) / 1000.0 - x;
        double dz = (building->z_mm + corners[i].z_mm) / 1000.0 - z;
        least = fmin(least, sqrt(dx * dx + dz * dz));
    }
    return least;
}

static void test_a_building_has_the_hulls_of_its_outline(void **state)
{
    struct scenario s;
    struct world_build built;
    (void)state;
    put_ground();
    must_load(&s, TEXT);
    assert_int_equal(world_build_make(&built, &s, &error), 0);
    assert_int_equal(built.counts.fixed, 2 + OBJECTS);
    uint32_t found = 0;
    for (uint32_t i = 0; i < built.counts.fixed; i++) {
        const struct fixed_object *object = &built.fixed[i];
        const struct kind *kind = &s.kinds[object->kind];
        if (!kind->outline)
            continue;
        uint32_t which = object->kind - (s.kind_count - 2), vertices = 0;
        assert_int_equal(kind->hull_count, which == 0 ? 1 : 2);
        struct mat3 turn = rotation_matrix(rotation_of(fixed_heading(object), 0.0, 0.0));
        for (uint32_t h = 0; h < kind->hull_count; h++) {
            const struct hull *hull = &s.hulls[kind->first_hull + h];
            for (uint32_t v = 0; v < hull->vertex_count; v++, vertices++) {
                struct vec3 at =
                    vec3_add(fixed_position(object),
                             rotation_apply(&turn, s.hull_vertices[hull->first_vertex + v]));
                double off = nearest(&buildings[which], which * 4, which == 0 ? 4 : 8, at.x, at.z);
                /* The ends of the ridge are between corners. */
                bool ridge = which == 0 && at.y > 106.9;
                assert_true(ridge || off < 1e-6);
                assert_true(at.y > 98.4 && at.y < 107.1);
            }
        }
        assert_int_equal(vertices, which == 0 ? 10 : 16);
        assert_true(fabs((double)object->y - 100.0) < 1e-6);
        found++;
    }
    assert_int_equal(found, 2);
    world_build_free(&built);
    scenario_free(&s);
}

static void test_a_building_is_as_heavy_as_it_is_large(void **state)
{
    struct scenario s;
    (void)state;
    put_ground();
    must_load(&s, TEXT);
    const struct kind *base = &s.kinds[kind_find(s.kinds, s.kind_count, "building")];
    const struct kind *own = &s.kinds[s.kind_count - 1];
    double ratio = 85.0 * 6.0 / (base->length_m * base->width_m * base->height_m);
    assert_int_equal(base->outline, 0);
    assert_string_equal(own->name, "building");
    assert_true(fabs(own->mass_kg - ratio * base->mass_kg) < 1.0);
    assert_true(fabs(own->resistance_j - ratio * base->resistance_j) < 1.0);
    assert_true(own->height_m == 6.0 && own->radius_m >= sqrt(74.0) - 1e-9);
    assert_int_equal(kind_of_files(s.kinds, s.kind_count), s.kind_count - 2);
    scenario_free(&s);
}

static void test_objects_have_their_kinds_and_sizes(void **state)
{
    static const char *const names[] = {"tree", "pole", "bush", "pine", "watertower"};
    struct scenario s;
    (void)state;
    put_ground();
    must_load(&s, TEXT);
    assert_int_equal(s.object_count, 2 + OBJECTS);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        const struct scenario_object *object = &s.object_list[2 + i];
        assert_string_equal(s.kinds[object->kind].name, names[i]);
        assert_true(fabs((double)object->size - objects[i].size_percent / 100.0) < 1e-6);
        assert_int_equal(object->turn, objects[i].turn);
        assert_true(object->x == objects[i].x_mm / 1000.0);
    }
    scenario_free(&s);
}

static void test_models_are_closed_walls_and_roofs(void **state)
{
    struct scenario s;
    (void)state;
    put_ground();
    must_load(&s, TEXT);
    for (uint32_t k = s.kind_count - 2; k < s.kind_count; k++) {
        const struct model *model = &s.models[s.kinds[k].model];
        double volume = 0.0;
        assert_true(model->triangle_count >= 12);
        for (uint32_t t = 0; t < model->triangle_count; t++) {
            const struct model_triangle *triangle = &s.triangles[model->first_triangle + t];
            const struct model_vertex *v = &s.vertices[model->first_vertex];
            const struct model_vertex *a = &v[triangle->vertex[0]], *b = &v[triangle->vertex[1]],
                                      *c = &v[triangle->vertex[2]];
            if (triangle->blue > triangle->red) /* a window */
                continue;
            /* The open bottom lies in the plane y = foot, which adds nothing from there. */
            double foot = buildings[k - (s.kind_count - 2)].foot_mm / 1000.0;
            double ay = (double)a->y - foot, by = (double)b->y - foot, cy = (double)c->y - foot;
            volume += ((double)a->x * (by * (double)c->z - (double)b->z * cy) +
                       ay * ((double)b->z * (double)c->x - (double)b->x * (double)c->z) +
                       (double)a->z * ((double)b->x * cy - by * (double)c->x)) /
                      6.0;
        }
        /* Walls between parts are left out, and the volume is still that of both. */
        double area = k == s.kind_count - 1 ? 85.0 : 0.0;
        if (area > 0.0)
            assert_true(fabs(volume - area * 6.5) < 0.01);
        else
            assert_true(volume > 0.0);
    }
    scenario_free(&s);
}

static void test_objects_of_a_small_square_lie_in_the_middle(void **state)
{
    struct scenario s;
    (void)state;
    side_m = 40000.0;
    put_ground();
    must_load(&s, TEXT);
    assert_true(s.object_list[0].x == buildings[0].x_mm / 1000.0 + 5000.0);
    assert_true(s.object_list[0].z == buildings[0].z_mm / 1000.0 + 5000.0);
    assert_true(s.object_list[2].x == objects[0].x_mm / 1000.0 + 5000.0);
    scenario_free(&s);
    side_m = 50000.0;
}

static void test_other_objects_take_their_place(void **state)
{
    struct scenario s;
    (void)state;
    put_ground();
    must_load(&s, TEXT "objects = { source = \"none\"; };");
    assert_int_equal(s.object_count, 0);
    assert_false(s.kinds[s.kind_count - 1].outline);
    scenario_free(&s);
    must_load(&s, TEXT "objects = ( { kind = \"tree\"; at = [9.0, 9.0]; } );");
    assert_int_equal(s.object_count, 1);
    scenario_free(&s);
    assert_int_equal(quick_config_load(&s, "objects = { source = \"file\"; };", NULL, &error), -1);
    assert_non_null(strstr(error.text, "objects.source = file: needs terrain.source = \"file\""));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_building_has_the_hulls_of_its_outline),
        cmocka_unit_test(test_a_building_is_as_heavy_as_it_is_large),
        cmocka_unit_test(test_objects_have_their_kinds_and_sizes),
        cmocka_unit_test(test_models_are_closed_walls_and_roofs),
        cmocka_unit_test(test_objects_of_a_small_square_lie_in_the_middle),
        cmocka_unit_test(test_other_objects_take_their_place),
    };
    return cmocka_run_group_tests(tests, quick_config_make, quick_config_remove);
}
