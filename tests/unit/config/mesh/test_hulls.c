/* Hulls of models (row 38). Simple shapes are checked to the last plane. The hulls of shipped
 * models must hold the whole model, be valid, and leave the free space free. */
#include "config/mesh/hulls.h"

#include "config/loader.h"
#include "config/mesh/connected_pieces.h"
#include "tests/support/quick_config.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/model.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define HALF_STEP 0.5e-6 /* the lattice may move a corner by this */
#define NEAR_M    1e-6

static struct error_text error;

/* --- shapes ------------------------------------------------------------------------------------*/

#define SHAPE_VERTICES  16384
#define SHAPE_TRIANGLES 16384

/* A model under construction, in tables like a scenario's. */
static struct model_vertex vertices[SHAPE_VERTICES];
static struct model_triangle triangles[SHAPE_TRIANGLES];
static struct model model;
static struct scenario scenario;
static struct hulls hulls;

static void begin(void)
{
    memset(&model, 0, sizeof(model));
    memset(&scenario, 0, sizeof(scenario));
}

static uint32_t vertex(double x, double y, double z)
{
    assert_true(model.vertex_count < SHAPE_VERTICES);
    vertices[model.vertex_count] = (struct model_vertex){(float)x, (float)y, (float)z};
    return model.vertex_count++;
}

static void triangle(uint32_t a, uint32_t b, uint32_t c)
{
    assert_true(model.triangle_count < SHAPE_TRIANGLES);
    triangles[model.triangle_count++] = (struct model_triangle){.vertex = {a, b, c}};
}

/* Adds a vertex for each corner, as models do: several vertices share a place. */
static void quad(const double a[3], const double b[3], const double c[3], const double d[3])
{
    uint32_t first = vertex(a[0], a[1], a[2]);

    vertex(b[0], b[1], b[2]);
    vertex(c[0], c[1], c[2]);
    vertex(d[0], d[1], d[2]);
    triangle(first, first + 1, first + 2);
    triangle(first, first + 2, first + 3);
}

/* Adds a box around a middle; each face has side * side squares. */
static void box(double x, double y, double z, const double half[3], int side)
{
    const double middle[3] = {x, y, z};

    for (int face = 0; face < 6; face++) {
        int out = face / 2, right = (out + 1) % 3, up = (out + 2) % 3;

        for (int n = 0; n < side * side; n++) {
            double corner[4][3];

            for (int k = 0; k < 4; k++) {
                double u = n % side + (k == 1 || k == 2), v = n / side + (k >= 2);

                corner[k][out] = middle[out] + (face % 2 == 0 ? half[out] : -half[out]);
                corner[k][right] = middle[right] + half[right] * (2.0 * u / side - 1.0);
                corner[k][up] = middle[up] + half[up] * (2.0 * v / side - 1.0);
            }
            quad(corner[0], corner[1], corner[2], corner[3]);
        }
    }
}

static void cube(double x, double y, double z, double half)
{
    const double halves[3] = {half, half, half};

    box(x, y, z, halves, 1);
}

/* Adds a ball of rings * around corners and two poles. */
static void ball(double x, double radius, int rings, int around)
{
    uint32_t first = model.vertex_count;

    for (int ring = 1; ring <= rings; ring++) {
        for (int n = 0; n < around; n++) {
            double up = PI * ring / (rings + 1), turn = TWO_PI * n / around;

            vertex(x + radius * sin(up) * cos(turn), radius * cos(up),
                   radius * sin(up) * sin(turn));
        }
    }
    uint32_t top = vertex(x, radius, 0), bottom = vertex(x, -radius, 0);
    for (uint32_t n = 0; n < (uint32_t)around; n++) {
        uint32_t next = (n + 1) % (uint32_t)around, last = (uint32_t)((rings - 1) * around);

        triangle(top, first + n, first + next);
        triangle(bottom, first + last + n, first + last + next);
        for (uint32_t ring = 0; ring + 1 < (uint32_t)rings; ring++) {
            uint32_t at = first + ring * (uint32_t)around;

            triangle(at + n, at + next, at + (uint32_t)around + n);
            triangle(at + next, at + (uint32_t)around + n, at + (uint32_t)around + next);
        }
    }
}

static int build(void)
{
    const struct key_place place = {"k.obj", 0};

    scenario.vertices = vertices;
    scenario.vertex_count = model.vertex_count;
    scenario.triangles = triangles;
    scenario.triangle_count = model.triangle_count;
    return hulls_build(&hulls, &scenario, &model, place, &error);
}

static void must_build(uint32_t count)
{
    if (build() != 0)
        fail_msg("refused: %s", error.text);
    assert_int_equal(hulls.first, 0);
    assert_int_equal(hulls.count, count);
    assert_int_equal(hulls.outer, count); /* the hull around all of them comes last */
    assert_int_equal(scenario.hull_count, count + 1);
}

static void drop(void)
{
    free(scenario.hulls);
    free(scenario.hull_vertices);
    free(scenario.hull_planes);
}

static void must_be_refused(const char *says)
{
    assert_int_equal(build(), -1);
    assert_string_equal(error.text, says);
    drop();
}

static bool has_plane(const struct scenario *s, const struct hull *hull, double x, double y,
                      double z, double offset)
{
    for (uint32_t i = 0; i < hull->plane_count; i++) {
        const struct hull_plane *plane = &s->hull_planes[hull->first_plane + i];

        if (fabs(plane->normal.x - x) < 1e-6 && fabs(plane->normal.y - y) < 1e-6 &&
            fabs(plane->normal.z - z) < 1e-6 && fabs(plane->offset_m - offset) < NEAR_M)
            return true;
    }
    return false;
}

static void check_cube(uint32_t n, double x, double half)
{
    const struct hull *hull = &scenario.hulls[n];

    assert_int_equal(hull->vertex_count, 8);
    assert_int_equal(hull->plane_count, 6);
    assert_true(has_plane(&scenario, hull, 1, 0, 0, x + half));
    assert_true(has_plane(&scenario, hull, -1, 0, 0, half - x));
    assert_true(has_plane(&scenario, hull, 0, 1, 0, half));
    assert_true(has_plane(&scenario, hull, 0, -1, 0, half));
    assert_true(has_plane(&scenario, hull, 0, 0, 1, half));
    assert_true(has_plane(&scenario, hull, 0, 0, -1, half));
    for (uint32_t i = 0; i < 8; i++) {
        const struct vec3 *v = &scenario.hull_vertices[hull->first_vertex + i];

        assert_true(fabs(fabs(v->x - x) - half) < HALF_STEP);
        assert_true(fabs(fabs(v->y) - half) < HALF_STEP);
        assert_true(fabs(fabs(v->z) - half) < HALF_STEP);
        if (i > 0)
            assert_true(convex_hull_compare(v - 1, v) < 0);
    }
    assert_true(fabs(hull->centre.x - x) < NEAR_M && fabs(hull->centre.y) < NEAR_M &&
                fabs(hull->centre.z) < NEAR_M);
    assert_true(fabs(hull->half.x - half) < NEAR_M && fabs(hull->half.y - half) < NEAR_M &&
                fabs(hull->half.z - half) < NEAR_M);
    assert_true(fabs(hull->radius_m - half * sqrt(3.0)) < NEAR_M);
}

static void test_cube_has_8_vertices_and_6_planes(void **state)
{
    (void)state;
    begin();
    cube(0, 0, 0, 0.3);
    must_build(1);
    check_cube(0, 0, 0.3);
    assert_true(fabs(hulls.bound_m - 0.3 * sqrt(3.0)) < NEAR_M);
    assert_true(fabs(hulls.level_m - 0.3 * sqrt(2.0)) < NEAR_M);
    assert_true(fabs(hulls.low_m + 0.3) < NEAR_M && fabs(hulls.high_m - 0.3) < NEAR_M);
    drop();
}

/* Corners within faces and edges are not vertices of the hull, and triangles in one plane are one
 * face. */
static void test_triangles_in_one_plane_are_one_face(void **state)
{
    const double half[3] = {0.3, 0.3, 0.3};

    (void)state;
    begin();
    box(0, 0, 0, half, 7);
    must_build(1);
    check_cube(0, 0, 0.3);
    drop();
}

static void test_two_pieces_are_two_hulls(void **state)
{
    (void)state;
    begin();
    cube(5, 0, 0, 0.5);
    cube(-5, 0, 0, 0.4);
    must_build(2);
    check_cube(0, -5, 0.4);
    check_cube(1, 5, 0.5);
    assert_true(fabs(hulls.bound_m - sqrt(5.5 * 5.5 + 0.5)) < NEAR_M);
    drop();
}

/* Cubes that touch at one corner: the same place, but different vertices. */
static void test_pieces_that_share_a_corner_are_one(void **state)
{
    (void)state;
    begin();
    cube(0, 0, 0, 1);
    cube(2, 2, 2, 1);
    must_build(1);
    assert_int_equal(scenario.hulls[0].vertex_count, 14);
    drop();
    begin();
    cube(0, 0, 0, 1);
    cube(2, 2, 2.001, 1); /* a millimetre apart */
    must_build(2);
    drop();
}

static void test_piece_within_another_is_left_out(void **state)
{
    (void)state;
    begin();
    cube(0.2, 0, 0, 0.5);
    cube(0, 0, 0, 1);
    must_build(1);
    check_cube(0, 0, 1);
    drop();
    begin();
    cube(0, 0, 0, 1);
    cube(0, 0, 0, 1);
    must_build(1);
    drop();
}

/* Pieces whose joining adds less than HULLS_FREE_M3 are joined, even if more hulls would be
 * allowed. */
static void test_pieces_close_together_are_joined(void **state)
{
    (void)state;
    begin();
    cube(0, 0, 0, 0.5);
    cube(1.015, 0, 0, 0.5);
    must_build(1);
    drop();
    begin();
    cube(0, 0, 0, 0.5);
    cube(1.025, 0, 0, 0.5);
    must_build(2);
    drop();
}

static double width_of(uint32_t n)
{
    const struct hull *hull = &scenario.hulls[n];

    return scenario.hull_vertices[hull->first_vertex + hull->vertex_count - 1].x -
           scenario.hull_vertices[hull->first_vertex].x;
}

/* Ten cubes with increasing gaps: the two narrowest gaps are filled. */
static void test_cheapest_pairs_are_joined_until_eight_are_left(void **state)
{
    double x = 0;

    (void)state;
    begin();
    for (int i = 0; i < 10; i++) {
        cube(x, 0, 0, 0.5);
        x += 9.0 - 0.7 * i;
    }
    must_build(8);
    for (uint32_t i = 0; i < 7; i++)
        assert_true(fabs(width_of(i) - 1.0) < NEAR_M);
    assert_true(fabs(width_of(7) - (1.0 + 4.1 + 3.4)) < 1e-5);
    drop();
}

/* Nine cubes, two pairs of them equally near: both pairs are joined. */
static void test_symmetry_is_kept(void **state)
{
    static const double x[] = {0, 5, 7, 20, 40, -5, -7, -20, -40};

    (void)state;
    begin();
    for (int i = 0; i < 9; i++)
        cube(x[i], 0, 0, 0.5);
    must_build(7);
    assert_true(fabs(width_of(2) - 3.0) < NEAR_M && fabs(width_of(4) - 3.0) < NEAR_M);
    drop();
}

/* --- flat pieces -------------------------------------------------------------------------------*/

static void check_thickened(double length, double width)
{
    const struct hull *hull = &scenario.hulls[0];
    struct vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};

    assert_int_equal(hull->vertex_count, 8);
    assert_int_equal(hull->plane_count, 6);
    for (uint32_t i = 0; i < 8; i++) {
        const struct vec3 *v = &scenario.hull_vertices[i];

        low = (struct vec3){fmin(low.x, v->x), fmin(low.y, v->y), fmin(low.z, v->z)};
        high = (struct vec3){fmax(high.x, v->x), fmax(high.y, v->y), fmax(high.z, v->z)};
    }
    assert_true(fabs(high.x - low.x - length) < NEAR_M);
    assert_true(fabs(high.z - low.z - width) < NEAR_M);
    assert_true(fabs(high.y - low.y - CONNECTED_PIECES_THICKNESS_M) < NEAR_M);
}

static void test_flat_piece_is_given_a_little_thickness(void **state)
{
    const double a[3] = {0, 2, 0}, b[3] = {6, 2, 0}, c[3] = {6, 2, 0.4}, d[3] = {0, 2, 0.4};

    (void)state;
    begin();
    quad(a, b, c, d);
    must_build(1);
    check_thickened(6.0, 0.4);
    drop();
    begin();
    quad(a, b, b, a); /* a line */
    must_build(1);
    check_thickened(6.0, CONNECTED_PIECES_THICKNESS_M);
    drop();
    begin();
    quad(a, a, a, a); /* a point */
    must_build(1);
    check_thickened(CONNECTED_PIECES_THICKNESS_M, CONNECTED_PIECES_THICKNESS_M);
    drop();
}

/* A blade that leans: it becomes thicker across itself, not along an axis. */
static void test_flat_piece_that_leans(void **state)
{
    const double a[3] = {0, 0, 0}, b[3] = {3, 4, 0}, c[3] = {3, 4, 1}, d[3] = {0, 0, 1};

    (void)state;
    begin();
    quad(a, b, c, d);
    must_build(1);
    assert_int_equal(scenario.hulls[0].vertex_count, 8);
    assert_int_equal(scenario.hulls[0].plane_count, 6);
    assert_true(
        has_plane(&scenario, &scenario.hulls[0], 0.8, -0.6, 0, CONNECTED_PIECES_THICKNESS_M / 2));
    drop();
}

/* --- the same from the same --------------------------------------------------------------------*/

/* Triangles and vertices in another order give the same hulls. */
static void test_order_of_triangles_changes_nothing(void **state)
{
    struct hull first_hulls[16];
    struct vec3 first_vertices[256];
    struct hull_plane first_planes[256];
    uint32_t vertex_count, plane_count;

    (void)state;
    for (int pass = 0; pass < 2; pass++) {
        begin();
        for (int n = 0; n < 12; n++) {
            int i = pass == 0 ? n : (n * 5 + 3) % 12;

            cube(1.7 * i + 0.13 * i * i, 0.3 * (i % 3), 0.1 * i, 0.4 + 0.03 * i);
        }
        must_build(8);
        if (pass == 0) {
            memcpy(first_hulls, scenario.hulls, 8 * sizeof(*first_hulls));
            vertex_count = scenario.hull_vertex_count;
            plane_count = scenario.hull_plane_count;
            memcpy(first_vertices, scenario.hull_vertices, vertex_count * sizeof(*first_vertices));
            memcpy(first_planes, scenario.hull_planes, plane_count * sizeof(*first_planes));
        } else {
            assert_int_equal(scenario.hull_vertex_count, vertex_count);
            assert_int_equal(scenario.hull_plane_count, plane_count);
            assert_memory_equal(scenario.hulls, first_hulls, 8 * sizeof(*first_hulls));
            assert_memory_equal(scenario.hull_vertices, first_vertices,
                                vertex_count * sizeof(*first_vertices));
            assert_memory_equal(scenario.hull_planes, first_planes,
                                plane_count * sizeof(*first_planes));
        }
        drop();
    }
}

/* --- too much ----------------------------------------------------------------------------------*/

static void test_ball_of_as_many_corners_as_a_hull_has(void **state)
{
    (void)state;
    begin();
    ball(0, 2.0, 2, 127);
    must_build(1);
    assert_int_equal(scenario.hulls[0].vertex_count, HULL_VERTICES_MAX);
    drop();
    begin();
    ball(0, 2.0, 15, 17); /* 257 corners */
    must_be_refused("k.obj: has a piece whose hull has too many corners; allowed: up to 256");
    begin();
    ball(0, 2.0, 90, 91); /* more than CONVEX_HULL_FACES_MAX */
    must_be_refused("k.obj: has a piece whose hull has too many corners; allowed: up to 256");
}

static void test_too_many_pieces_are_refused(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < CONNECTED_PIECES_MAX; i++)
        cube(0.25 * i, 0, 0, 0.1);
    if (build() != 0)
        fail_msg("refused: %s", error.text);
    assert_in_range(hulls.count, 1, 8);
    drop();
    begin();
    for (int i = 0; i <= CONNECTED_PIECES_MAX; i++)
        cube(0.25 * i, 0, 0, 0.1);
    must_be_refused("k.obj: has too many pieces; allowed: up to 256");
}

/* --- shipped -----------------------------------------------------------------------------------*/

static struct scenario shipped;

static int load_shipped(void **state)
{
    (void)state;
    return loader_scenario(&shipped, QUICK_CONFIG_SHIPPED, "duel", NULL, 0, &error);
}

static int free_shipped(void **state)
{
    (void)state;
    scenario_free(&shipped);
    return 0;
}

static const struct kind *kind_of(const char *name)
{
    uint16_t index = kind_find(shipped.kinds, shipped.kind_count, name);

    assert_int_not_equal(index, KIND_NONE);
    return &shipped.kinds[index];
}

/* How far a point is outside a hull by its planes [m]. */
static double outside(const struct hull *hull, struct vec3 p)
{
    double most = -INFINITY;

    for (uint32_t i = 0; i < hull->plane_count; i++) {
        const struct hull_plane *plane = &shipped.hull_planes[hull->first_plane + i];

        most = fmax(most, vec3_dot(plane->normal, p) - plane->offset_m);
    }
    return most;
}

/* Returns the hull of a kind that holds the point or is nearest to it. */
static double outside_all(const struct kind *kind, struct vec3 p)
{
    double least = INFINITY;

    for (uint32_t i = 0; i < kind->hull_count; i++)
        least = fmin(least, outside(&shipped.hulls[kind->first_hull + i], p));
    return least;
}

static void test_shipped_hulls_fill_the_tables(void **state)
{
    uint32_t hull_count = 0, vertex_count = 0, plane_count = 0;

    (void)state;
    for (uint32_t k = 0; k < shipped.kind_count; k++) {
        const struct kind *kind = &shipped.kinds[k];

        assert_in_range(kind->hull_count, 1, HULLS_A_MODEL);
        assert_int_equal(kind->outer_hull, kind->first_hull + kind->hull_count);
        if (kind->first_hull < hull_count) /* the model was checked with an earlier kind */
            continue;
        assert_int_equal(kind->first_hull, hull_count);
        assert_int_equal(kind->first_part_hull, kind->outer_hull + 1);
        hull_count += kind->hull_count + 1 + kind->part_count;
    }
    assert_int_equal(hull_count, shipped.hull_count);
    for (uint32_t i = 0; i < shipped.hull_count; i++) {
        const struct hull *hull = &shipped.hulls[i];

        assert_in_range(hull->vertex_count, 4, HULL_VERTICES_MAX);
        assert_in_range(hull->plane_count, 4, 2 * hull->vertex_count - 4);
        assert_int_equal(hull->first_vertex, vertex_count);
        assert_int_equal(hull->first_plane, plane_count);
        vertex_count += hull->vertex_count;
        plane_count += hull->plane_count;
    }
    assert_int_equal(vertex_count, shipped.hull_vertex_count);
    assert_int_equal(plane_count, shipped.hull_plane_count);
}

/* Normals have unit length. All vertices are behind each plane, and three or more lie in it; each
 * vertex is on three planes or more. The sphere holds all vertices. */
static void check_hull(const struct hull *hull)
{
    const struct vec3 *v = &shipped.hull_vertices[hull->first_vertex];
    const struct hull_plane *plane = &shipped.hull_planes[hull->first_plane];
    uint32_t on_vertex[HULL_VERTICES_MAX] = {0};

    for (uint32_t p = 0; p < hull->plane_count; p++) {
        uint32_t on = 0;

        assert_true(fabs(vec3_length(plane[p].normal) - 1.0) < 1e-12);
        for (uint32_t i = 0; i < hull->vertex_count; i++) {
            double out = vec3_dot(plane[p].normal, v[i]) - plane[p].offset_m;

            assert_true(out < NEAR_M);
            if (out > -5e-6) {
                on++;
                on_vertex[i]++;
            }
        }
        assert_true(on >= 3);
        for (uint32_t other = 0; other < p; other++)
            assert_true(vec3_dot(plane[p].normal, plane[other].normal) < 1.0 - 1e-12);
    }
    for (uint32_t i = 0; i < hull->vertex_count; i++) {
        assert_true(on_vertex[i] >= 3);
        struct vec3 arm = vec3_sub(v[i], hull->centre);
        assert_true(vec3_length(arm) <= hull->radius_m);
        assert_true(fabs(arm.x) <= hull->half.x && fabs(arm.y) <= hull->half.y &&
                    fabs(arm.z) <= hull->half.z);
    }
}

static void test_shipped_hulls_are_convex_and_closed(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < shipped.hull_count; i++)
        check_hull(&shipped.hulls[i]);
}

/* Each corner of the solid parts of the model is in a hull, and each vertex of a hull is such a
 * corner. */
static void test_shipped_hulls_hold_their_models(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < shipped.kind_count; k++) {
        const struct kind *kind = &shipped.kinds[k];
        const struct model *of = &shipped.models[kind->model];
        const struct model_vertex *corner = &shipped.vertices[of->first_vertex];
        uint32_t solid = of->solid_triangles > 0 ? of->solid_vertices : of->vertex_count;

        for (uint32_t i = 0; i < solid; i++) {
            struct vec3 p = {(double)corner[i].x, (double)corner[i].y, (double)corner[i].z};

            if (outside_all(kind, p) > NEAR_M)
                fail_msg("%s: vertex %u is %g m outside", kind->name, i, outside_all(kind, p));
        }
        for (uint32_t h = 0; h < kind->hull_count; h++) {
            const struct hull *hull = &shipped.hulls[kind->first_hull + h];

            for (uint32_t n = 0; n < hull->vertex_count; n++) {
                struct vec3 v = shipped.hull_vertices[hull->first_vertex + n];
                double nearest = INFINITY;

                for (uint32_t i = 0; i < solid; i++)
                    nearest = fmin(nearest, vec3_length((struct vec3){(double)corner[i].x - v.x,
                                                                      (double)corner[i].y - v.y,
                                                                      (double)corner[i].z - v.z}));
                assert_true(nearest < NEAR_M);
            }
        }
    }
}

static void test_extents_of_shipped_kinds(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < shipped.kind_count; k++) {
        const struct kind *kind = &shipped.kinds[k];
        double bound = 0, level = 0, low = INFINITY, high = -INFINITY;

        for (uint32_t h = 0; h < kind->hull_count; h++) {
            const struct hull *hull = &shipped.hulls[kind->first_hull + h];

            for (uint32_t n = 0; n < hull->vertex_count; n++) {
                struct vec3 v = shipped.hull_vertices[hull->first_vertex + n];

                bound = fmax(bound, vec3_length(v));
                level = fmax(level, hypot(v.x, v.z));
                low = fmin(low, v.y);
                high = fmax(high, v.y);
            }
        }
        assert_true(fabs(kind->bound_m - bound) < 1e-12 && fabs(kind->level_m - level) < 1e-12);
        assert_true(kind->low_m == low && kind->high_m == high);
        /* The hulls have the size that the kind says. Guns, rotors and aerials may stick out. */
        assert_true(level < 0.9 * kind->length_m + 0.5 * kind->width_m);
        assert_true(high - low < 1.3 * kind->height_m + 0.6);
    }
}

/* A jeep with its gun is 1.7 m high, and the crown of a tree begins at 3 m: the space between trunk
 * and crown is free. */
static void test_space_between_trunk_and_crown_is_free(void **state)
{
    const struct kind *tree = kind_of("tree"), *jeep = kind_of("jeep");

    (void)state;
    assert_true(jeep->high_m < 2.0);
    assert_true(tree->hull_count >= 2);
    for (double y = 0.1; y < 2.9; y += 0.1) {
        assert_true(outside_all(tree, (struct vec3){0, y, 0}) < 0.0);
        for (double turn = 0; turn < TWO_PI; turn += 0.1) {
            struct vec3 p = {0.5 * sin(turn), y, 0.5 * cos(turn)};

            assert_true(outside_all(tree, p) > 0.0);
        }
    }
    assert_true(outside_all(tree, (struct vec3){2.5, 5.5, 0}) < 0.0); /* in the crown */
}

/* The space under the water tower's tank and between its legs is free. */
static void test_space_between_legs_is_free(void **state)
{
    const struct kind *tower = kind_of("watertower");

    (void)state;
    for (double y = 0.1; y < 4.0; y += 0.1) {
        assert_true(outside_all(tower, (struct vec3){0, y, 1.2}) > 0.0);
        assert_true(outside_all(tower, (struct vec3){2.2, y, 0}) > 0.0);
    }
    assert_true(outside_all(tower, (struct vec3){0, 16, 0}) < 0.0);
}

/* A tank's gun is a hull of its own; the space beside it is free. */
static void test_space_beside_gun_is_free(void **state)
{
    const struct kind *tank = kind_of("tank");

    (void)state;
    assert_true(outside_all(tank, (struct vec3){5.0, 1.75, 0}) < 0.0);
    assert_true(outside_all(tank, (struct vec3){5.0, 1.75, 0.5}) > 0.0);
    assert_true(outside_all(tank, (struct vec3){5.0, 1.0, 0}) > 0.0);
}

int main(void)
{
    const struct CMUnitTest shapes[] = {
        cmocka_unit_test(test_cube_has_8_vertices_and_6_planes),
        cmocka_unit_test(test_triangles_in_one_plane_are_one_face),
        cmocka_unit_test(test_two_pieces_are_two_hulls),
        cmocka_unit_test(test_pieces_that_share_a_corner_are_one),
        cmocka_unit_test(test_piece_within_another_is_left_out),
        cmocka_unit_test(test_pieces_close_together_are_joined),
        cmocka_unit_test(test_cheapest_pairs_are_joined_until_eight_are_left),
        cmocka_unit_test(test_symmetry_is_kept),
        cmocka_unit_test(test_flat_piece_is_given_a_little_thickness),
        cmocka_unit_test(test_flat_piece_that_leans),
        cmocka_unit_test(test_order_of_triangles_changes_nothing),
        cmocka_unit_test(test_ball_of_as_many_corners_as_a_hull_has),
        cmocka_unit_test(test_too_many_pieces_are_refused),
    };
    const struct CMUnitTest models[] = {
        cmocka_unit_test(test_shipped_hulls_fill_the_tables),
        cmocka_unit_test(test_shipped_hulls_are_convex_and_closed),
        cmocka_unit_test(test_shipped_hulls_hold_their_models),
        cmocka_unit_test(test_extents_of_shipped_kinds),
        cmocka_unit_test(test_space_between_trunk_and_crown_is_free),
        cmocka_unit_test(test_space_between_legs_is_free),
        cmocka_unit_test(test_space_beside_gun_is_free),
    };

    return cmocka_run_group_tests(shapes, NULL, NULL) +
           cmocka_run_group_tests(models, load_shipped, free_shipped);
}
