/* Rays against polygons, and the thesis's two rays (row 21), on boxes. */
#include "collider/geometry/ray_polygon.h"

#include "tests/support/fixture.h"
#include "world/model.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>

#include <cmocka.h>

#define RAYS 20000

enum { CUBE, TWO_CUBES, STONE };

/* A cube of half a side of 1; a second one behind it, 3 m on; a stone with eight uneven faces. */
static const struct model_vertex vertices[] = {
    {-1, -1, -1},        {1, -1, -1},         {-1, 1, -1},        {1, 1, -1},
    {-1, -1, 1},         {1, -1, 1},          {-1, 1, 1},         {1, 1, 1},
    {2, -1, -1},         {4, -1, -1},         {2, 1, -1},         {4, 1, -1},
    {2, -1, 1},          {4, -1, 1},          {2, 1, 1},          {4, 1, 1},
    {1.3f, 0.1f, -0.2f}, {-0.9f, 0.3f, 0.1f}, {0.2f, 1.7f, 0.3f}, {-0.1f, -0.7f, 0.4f},
    {0.3f, 0.2f, 1.1f},  {0.1f, -0.3f, -1.9f}};

#define TRIANGLE(a, b, c)                                                                          \
    {                                                                                              \
        .vertex = { a, b, c }                                                                      \
    }
#define CUBE_FROM(n)                                                                               \
    TRIANGLE(n + 0, n + 4, n + 6), TRIANGLE(n + 0, n + 6, n + 2), TRIANGLE(n + 1, n + 3, n + 7),   \
        TRIANGLE(n + 1, n + 7, n + 5), TRIANGLE(n + 0, n + 1, n + 5),                              \
        TRIANGLE(n + 0, n + 5, n + 4), TRIANGLE(n + 2, n + 6, n + 7),                              \
        TRIANGLE(n + 2, n + 7, n + 3), TRIANGLE(n + 0, n + 2, n + 3),                              \
        TRIANGLE(n + 0, n + 3, n + 1), TRIANGLE(n + 4, n + 5, n + 7),                              \
        TRIANGLE(n + 4, n + 7, n + 6)

/* The far cube comes first, so that the nearest is not simply the first. */
static const struct model_triangle triangles[] = {
    CUBE_FROM(8),      CUBE_FROM(0),      TRIANGLE(0, 2, 4), TRIANGLE(2, 1, 4), TRIANGLE(1, 3, 4),
    TRIANGLE(3, 0, 4), TRIANGLE(2, 0, 5), TRIANGLE(1, 2, 5), TRIANGLE(3, 1, 5), TRIANGLE(0, 3, 5)};

static const struct model models[] = {
    [CUBE] = {.name = "cube", .first_triangle = 12, .triangle_count = 12, .vertex_count = 8},
    [TWO_CUBES] = {.name = "two", .triangle_count = 24, .vertex_count = 16},
    [STONE] = {.name = "stone",
               .first_triangle = 24,
               .triangle_count = 8,
               .first_vertex = 16,
               .vertex_count = 6},
};

static const struct world world = {
    .models = models, .model_vertices = vertices, .model_triangles = triangles};

static struct ray_polygon_model put(uint32_t model, struct vec3 at, double heading)
{
    return (struct ray_polygon_model){
        &world, model, 1.0, rotation_matrix(rotation_of(heading, 0.0, 0.0)), at, 0.0};
}

static bool near(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_sub(a, b)) < 1e-12;
}

/* --- one ray -----------------------------------------------------------------------------------*/

static void test_row_21_a_ray_meets_the_face_before_it(void **state)
{
    struct ray_polygon_model cube = put(CUBE, (struct vec3){10, 0, 0}, HALF_PI);
    struct ray_polygon_hit hit;
    (void)state;
    assert_true(ray_polygon_nearest(&cube, (struct vec3){0, 0.5, 0.25}, (struct vec3){1, 0, 0},
                                    100.0, &hit));
    assert_true(fabs(hit.distance_m - 9.0) < 1e-12);
    assert_true(near(hit.point, (struct vec3){9, 0.5, 0.25}));
    assert_true(near(hit.normal, (struct vec3){-1, 0, 0}));
    assert_false(
        ray_polygon_nearest(&cube, (struct vec3){0, 0.5, 0.25}, (struct vec3){1, 0, 0}, 8.9, &hit));
    assert_false(
        ray_polygon_nearest(&cube, (struct vec3){0, 2, 0}, (struct vec3){1, 0, 0}, 100.0, &hit));
    assert_false(
        ray_polygon_nearest(&cube, (struct vec3){0, 0, 0}, (struct vec3){-1, 0, 0}, 100.0, &hit));
}

static void test_row_21_scale_and_turn_count(void **state)
{
    struct ray_polygon_model cube = put(CUBE, (struct vec3){10, 0, 0}, 0.25 * PI);
    struct ray_polygon_hit hit;
    (void)state;
    cube.scale = 2.0; /* an edge points at the ray */
    assert_true(
        ray_polygon_nearest(&cube, (struct vec3){0, 0, 0.1}, (struct vec3){1, 0, 0}, 100, &hit));
    assert_true(fabs(hit.distance_m - (10.0 - 2.0 * sqrt(2.0) + 0.1)) < 1e-12);
    assert_true(near(hit.normal, (struct vec3){-sqrt(0.5), 0, sqrt(0.5)}));
}

static void test_row_21_of_several_it_is_the_nearest(void **state)
{
    struct ray_polygon_model two = put(TWO_CUBES, (struct vec3){0, 0, 0}, HALF_PI);
    struct ray_polygon_hit hit;
    (void)state;
    assert_true(
        ray_polygon_nearest(&two, (struct vec3){-9, 0.2, 0.1}, (struct vec3){1, 0, 0}, 99, &hit));
    assert_true(fabs(hit.distance_m - 8.0) < 1e-12 && hit.triangle >= 12);
    assert_true(
        ray_polygon_nearest(&two, (struct vec3){9, 0.2, 0.1}, (struct vec3){-1, 0, 0}, 99, &hit));
    assert_true(fabs(hit.distance_m - 5.0) < 1e-12 && hit.triangle < 12);
    assert_true(
        ray_polygon_nearest(&two, (struct vec3){0, 0.2, 0.1}, (struct vec3){1, 0, 0}, 99, &hit));
    assert_true(fabs(hit.distance_m - 1.0) < 1e-12); /* from inside: the face's back */
    assert_true(near(hit.normal, (struct vec3){1, 0, 0}));
}

/* Aimed at points of edges, and of the diagonals in a face's middle, where two polygons meet. */
static void test_row_21_no_ray_slips_through_an_edge(void **state)
{
    uint64_t random = fixture_seed(321);
    struct ray_polygon_hit hit;
    (void)state;
    for (int n = 0; n < RAYS; n++) {
        struct ray_polygon_model model = put(n & 1 ? STONE : CUBE, (struct vec3){25000, 100, 25000},
                                             n & 2 ? 0.0 : fixture_uniform(&random, 0.0, TWO_PI));
        const struct model *shape = &models[model.model];
        const struct model_triangle *triangle =
            &triangles[shape->first_triangle + fixture_random(&random) % shape->triangle_count];
        struct vec3 corner[2];
        for (int i = 0; i < 2; i++) {
            const struct model_vertex *v = &vertices[shape->first_vertex + triangle->vertex[i]];
            corner[i] = (struct vec3){(double)v->x, (double)v->y, (double)v->z};
        }
        double t = n & 4 ? 0.5 : n & 8 ? 0.0 : fixture_uniform(&random, 0.0, 1.0);
        struct vec3 in = {0.0, 0.0, 0.0};
        if (n & 16)
            in = vec3_scale(fixture_direction(&random), 0.3);
        struct vec3 out =
            rotation_apply(&model.turn, vec3_sub(vec3_lerp(corner[0], corner[1], t), in));
        out = vec3_scale(out, 1.0 / vec3_length(out));
        in = vec3_add(model.at, rotation_apply(&model.turn, in));
        assert_true(ray_polygon_nearest(&model, in, out, 10.0, &hit));
        assert_true(vec3_dot(hit.normal, out) > 0.0);
    }
}

static void test_row_21_a_hit_lies_on_its_polygons_plane(void **state)
{
    uint64_t random = fixture_seed(322), hits = 0;
    struct ray_polygon_hit hit;
    (void)state;
    for (int n = 0; n < RAYS; n++) {
        struct ray_polygon_model cube = put(CUBE, (struct vec3){40000, 100, 40000}, 1.0 + n);
        cube.scale = fixture_uniform(&random, 0.5, 3.0);
        struct vec3 along = fixture_direction(&random);
        struct vec3 from = vec3_add(cube.at, vec3_add(vec3_scale(fixture_direction(&random), 1.5),
                                                      vec3_scale(along, -10.0)));
        if (!ray_polygon_nearest(&cube, from, along, 100.0, &hit))
            continue;
        hits++;
        struct vec3 body = rotation_back(&cube.turn, vec3_sub(hit.point, cube.at));
        struct vec3 out = rotation_back(&cube.turn, hit.normal);
        assert_true(fabs(vec3_dot(body, out) - cube.scale) < 1e-9);
        assert_true(maths_max(fabs(body.x), maths_max(fabs(body.y), fabs(body.z))) <
                    cube.scale + 1e-9);
        assert_true(vec3_dot(hit.normal, along) < 0.0); /* from outside: its front */
        assert_true(fabs(vec3_length(hit.normal) - 1.0) < 1e-12);
        assert_true(fabs(vec3_length(vec3_sub(hit.point, from)) - hit.distance_m) < 1e-9);
    }
    assert_in_range(hits, RAYS / 4, RAYS - 100);
}

/* --- the two rays ------------------------------------------------------------------------------*/

static void test_row_21_spheres_that_overlap_are_no_collision_of_the_objects(void **state)
{
    struct ray_polygon_model vehicle = put(CUBE, (struct vec3){0, 0, 0}, 0.0);
    struct ray_polygon_hit hit;
    (void)state;
    for (double apart = 2.01; apart < 3.4; apart += 0.01) { /* sqrt(3) + sqrt(3) */
        struct ray_polygon_model object = put(CUBE, (struct vec3){apart, 0, 0}, 0.0);
        assert_false(ray_polygon_collision(&vehicle, 1.7, &object, 1.7, &hit));
    }
}

static void test_row_21_objects_that_touch_collide_on_a_polygon(void **state)
{
    struct ray_polygon_model vehicle = put(CUBE, (struct vec3){0, 0, 0}, 0.0);
    struct ray_polygon_hit hit;
    (void)state;
    for (double apart = 1.99; apart > 1.01; apart -= 0.01) {
        struct ray_polygon_model object = put(CUBE, (struct vec3){apart, 0, 0}, 0.0);
        assert_true(ray_polygon_collision(&vehicle, 1.7, &object, 1.7, &hit));
        assert_true(near(hit.point, (struct vec3){apart - 1.0, 0, 0}));
        assert_true(near(hit.normal, (struct vec3){-1, 0, 0}));
        assert_true(fabs(hit.distance_m - (apart - 1.0)) < 1e-12);
    }
}

static void test_row_21_a_skin_beyond_the_sphere_counts_as_far_as_the_sphere(void **state)
{
    struct ray_polygon_model vehicle =
        put(CUBE, (struct vec3){0, 0, 0}, 0.25 * PI); /* edge first */
    struct ray_polygon_model object = put(CUBE, (struct vec3){2.35, 0, 0}, 0.0);
    struct ray_polygon_hit hit;
    (void)state;
    assert_true(
        ray_polygon_collision(&vehicle, 1.5, &object, 1.7, &hit)); /* its edge is at 1.414 */
    assert_false(ray_polygon_collision(&vehicle, 1.3, &object, 1.7, &hit));
    object.at.x = 2.2;
    assert_true(ray_polygon_collision(&vehicle, 1.3, &object, 1.7, &hit));
}

static void test_row_20_without_spheres_that_meet_there_is_no_ray(void **state)
{
    struct ray_polygon_model vehicle = put(CUBE, (struct vec3){0, 0, 0}, 0.0);
    struct ray_polygon_model object = put(CUBE, (struct vec3){1.9, 0, 0}, 0.0);
    struct ray_polygon_hit hit;
    (void)state;
    assert_true(ray_polygon_collision(&vehicle, 1.0, &object, 0.91, &hit));
    assert_false(ray_polygon_collision(&vehicle, 1.0, &object, 0.89, &hit));
    object.at.x = 0.0; /* in each other: straight ahead, which is north */
    assert_true(ray_polygon_collision(&vehicle, 1.7, &object, 1.7, &hit));
    assert_true(near(hit.point, (struct vec3){0, 0, -1}));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_row_21_a_ray_meets_the_face_before_it),
        cmocka_unit_test(test_row_21_scale_and_turn_count),
        cmocka_unit_test(test_row_21_of_several_it_is_the_nearest),
        cmocka_unit_test(test_row_21_no_ray_slips_through_an_edge),
        cmocka_unit_test(test_row_21_a_hit_lies_on_its_polygons_plane),
        cmocka_unit_test(test_row_21_spheres_that_overlap_are_no_collision_of_the_objects),
        cmocka_unit_test(test_row_21_objects_that_touch_collide_on_a_polygon),
        cmocka_unit_test(test_row_21_a_skin_beyond_the_sphere_counts_as_far_as_the_sphere),
        cmocka_unit_test(test_row_20_without_spheres_that_meet_there_is_no_ray),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
