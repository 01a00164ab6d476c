/* Meshes and levels of detail of the ground: within a pixel of the terrain, without gaps between
 * neighbours and jumps when a patch is divided. */
#include "renderer/scene/terrain/terrain_mesh.h"

#include "renderer/scene/noise/value_noise.h"
#include "tests/support/fixture.h"
#include "tests/support/works.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#define POSTS   1601u
#define SPACING 31.25
#define SEED    11u
#define CRATERS 12u

/* Width of the picture for which the tolerances hold [pixel]. */
#define FOCAL_PIXELS 1108.5

struct relief {
    struct terrain terrain;
    struct crater_index index;
    struct crater craters[CRATERS];
    struct terrain_mesh mesh, other;
    float posts[POSTS * POSTS];
    uint8_t cover[POSTS * POSTS];
};

static struct relief *relief;

static void open_mesh(struct terrain_mesh *mesh)
{
    mesh->vertices = malloc(GROUND_VERTICES_MAX * sizeof *mesh->vertices);
    mesh->triangles = malloc(GROUND_TRIANGLES_MAX * sizeof *mesh->triangles);
    assert_non_null(mesh->vertices);
    assert_non_null(mesh->triangles);
}

/* Mountains as rough as Hunter-Liggett's: each octave is half as long and half as high. */
static int open_relief(void **context)
{
    (void)context;
    relief = calloc(1, sizeof *relief);
    assert_non_null(relief);
    for (uint32_t row = 0; row < POSTS; row++)
        for (uint32_t column = 0; column < POSTS; column++) {
            double x = column * SPACING, z = row * SPACING, height = 300.0;
            for (uint32_t i = 0; i < 5; i++)
                height +=
                    260.0 / (1u << i) *
                    (double)value_noise_value(x * (1u << i) / 5000.0, z * (1u << i) / 5000.0, i);
            relief->posts[row * POSTS + column] = (float)height;
        }
    relief->terrain = (struct terrain){.posts = relief->posts,
                                       .cover = relief->cover,
                                       .side = POSTS,
                                       .spacing_m = SPACING,
                                       .squares = GRIDSQUARES_DEFAULT_INIT};
    open_mesh(&relief->mesh);
    open_mesh(&relief->other);
    return crater_index_init(&relief->index, &GRIDSQUARES_DEFAULT, relief->craters);
}

static int close_relief(void **context)
{
    (void)context;
    crater_index_free(&relief->index);
    free(relief->mesh.vertices);
    free(relief->mesh.triangles);
    free(relief->other.vertices);
    free(relief->other.triangles);
    free(relief);
    return 0;
}

/* Returns the patch of a level at a place. */
static struct terrain_quadtree_patch patch_at(int32_t level, double x, double z)
{
    double side = terrain_quadtree_patch_side(level);
    return (struct terrain_quadtree_patch){
        .column = (int32_t)floor(x / side), .row = (int32_t)floor(z / side), .level = level};
}

static struct terrain_quadtree_patch some_patch(uint64_t *state, int32_t level)
{
    double x = fixture_uniform(state, 0.0, 50000.0);
    return patch_at(level, x, fixture_uniform(state, 0.0, 50000.0));
}

/* Returns twice the triangle's area seen from above; negative if it faces down. */
static double area(const float *a, const float *b, const float *c)
{
    return ((double)b[2] - (double)a[2]) * ((double)c[0] - (double)a[0]) -
           ((double)b[0] - (double)a[0]) * ((double)c[2] - (double)a[2]);
}

/* Returns the mesh's height at a point in metres from its corner, or NAN outside its triangles. */
static double mesh_height(const struct terrain_mesh *mesh, double x, double z)
{
    const float p[3] = {(float)x, 0.0f, (float)z};
    for (uint32_t i = 0; i < mesh->top_triangles; i++) {
        const float *a = mesh->vertices[mesh->triangles[i][0]];
        const float *b = mesh->vertices[mesh->triangles[i][1]];
        const float *c = mesh->vertices[mesh->triangles[i][2]];
        double u = area(b, c, p), v = area(c, a, p), w = area(a, b, p);
        if (u >= -1e-3 && v >= -1e-3 && w >= -1e-3)
            return (u * (double)a[1] + v * (double)b[1] + w * (double)c[1]) / (u + v + w);
    }
    return NAN;
}

/* Returns the size of a length where a patch of the level is drawn nearest [pixel]; the deepest
 * level may be nearer. */
static double pixels(double metres, int32_t level)
{
    return metres * FOCAL_PIXELS / (TERRAIN_QUADTREE_SPLIT * terrain_quadtree_patch_side(level));
}

static void dig_some(uint64_t *state, double x, double z, double within_m)
{
    uint32_t count = relief->index.count;
    for (uint32_t i = 0; i < 4; i++, count++) {
        double radius = fixture_uniform(state, 1.5, 5.0);
        relief->craters[count] =
            (struct crater){.x = fixture_uniform(state, x - within_m, x + within_m),
                            .z = fixture_uniform(state, z - within_m, z + within_m),
                            .radius_m = (float)radius,
                            .depth_m = (float)(0.4 * radius)};
    }
    crater_index_update(&relief->index, count);
}

static void forget_craters(void)
{
    crater_index_update(&relief->index, 0);
}

static void test_mesh_covers_its_patch_and_faces_up(void **context)
{
    (void)context;
    uint64_t state = fixture_seed(SEED);
    for (int32_t i = 0; i < 100; i++) {
        struct terrain_quadtree_patch patch =
            some_patch(&state, i % (TERRAIN_QUADTREE_LEVEL_MAX + 1));
        double side = terrain_quadtree_patch_side(patch.level), sum = 0.0;
        struct terrain_mesh *mesh = &relief->mesh;
        terrain_mesh(&relief->terrain, NULL, &patch, mesh);
        assert_true(mesh->vertex_count <= GROUND_VERTICES_MAX);
        assert_true(mesh->triangle_count <= GROUND_TRIANGLES_MAX);
        for (uint32_t t = 0; t < mesh->top_triangles; t++) {
            double twice =
                area(mesh->vertices[mesh->triangles[t][0]], mesh->vertices[mesh->triangles[t][1]],
                     mesh->vertices[mesh->triangles[t][2]]);
            assert_true(twice > 0.0);
            sum += 0.5 * twice;
        }
        assert_true(fabs(sum / (side * side) - 1.0) < 1e-9);
    }
}

/* Each triangle of the skirt stands on an edge and faces away from the patch. */
static void test_skirt_faces_outside(void **context)
{
    (void)context;
    uint64_t state = fixture_seed(SEED);
    struct terrain_quadtree_patch patch = some_patch(&state, 6);
    float side = (float)terrain_quadtree_patch_side(6), middle = 0.5f * side;
    struct terrain_mesh *mesh = &relief->mesh;
    terrain_mesh(&relief->terrain, NULL, &patch, mesh);
    for (uint32_t t = mesh->top_triangles; t < mesh->triangle_count; t++) {
        const float *a = mesh->vertices[mesh->triangles[t][0]];
        const float *b = mesh->vertices[mesh->triangles[t][1]];
        const float *c = mesh->vertices[mesh->triangles[t][2]];
        float ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
        float vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
        float nx = uy * vz - uz * vy, nz = ux * vy - uy * vx;
        assert_true(nx * (a[0] - middle) + nz * (a[2] - middle) > 0.0f);
        bool west = a[0] == 0.0f && b[0] == 0.0f && c[0] == 0.0f;
        bool east = a[0] == side && b[0] == side && c[0] == side;
        bool north = a[2] == 0.0f && b[2] == 0.0f && c[2] == 0.0f;
        bool south = a[2] == side && b[2] == side && c[2] == side;
        assert_int_equal(west + east + north + south, 1);
    }
}

/* The drawn ground is within a pixel of the true ground. */
static void test_mesh_is_the_terrain_to_a_pixel(void **context)
{
    (void)context;
    uint64_t state = fixture_seed(SEED);
    for (int32_t level = 2; level <= TERRAIN_QUADTREE_LEVEL_MAX; level++) {
        double worst = 0.0, side = terrain_quadtree_patch_side(level);
        for (uint32_t i = 0; i < 10; i++) {
            struct terrain_quadtree_patch patch = some_patch(&state, level);
            terrain_mesh(&relief->terrain, NULL, &patch, &relief->mesh);
            for (uint32_t j = 0; j < 100; j++) {
                double x = fixture_uniform(&state, 0.0, side);
                double z = fixture_uniform(&state, 0.0, side);
                double at_x = patch.column * side + x, at_z = patch.row * side + z;
                terrain_quadtree_beyond(&relief->terrain, &at_x, &at_z);
                double truth = terrain_base_height(&relief->terrain, at_x, at_z);
                worst = maths_max(worst, fabs(mesh_height(&relief->mesh, x, z) - truth));
            }
        }
        print_message("level %d: off by %.2f m at most, %.2f pixels\n", level, worst,
                      pixels(worst, level));
        assert_true(pixels(worst, level) <= (level < TERRAIN_QUADTREE_HAZY_LEVEL ? 2.0 : 1.0));
        /* Near the eye it is exactly the true ground. */
        assert_true(level < TERRAIN_QUADTREE_LEVEL_MAX || worst < 1e-3);
    }
}

/* A camera that nears the ground sees it move by less than a pixel when patches are divided. */
static void test_ground_does_not_jump_when_a_patch_is_divided(void **context)
{
    (void)context;
    uint64_t state = fixture_seed(SEED);
    for (int32_t level = 3; level < TERRAIN_QUADTREE_LEVEL_MAX; level++) {
        double worst = 0.0, side = terrain_quadtree_patch_side(level), half = 0.5 * side;
        for (uint32_t i = 0; i < 8; i++) {
            struct terrain_quadtree_patch whole = some_patch(&state, level);
            terrain_mesh(&relief->terrain, NULL, &whole, &relief->mesh);
            for (int32_t part = 0; part < 4; part++) {
                struct terrain_quadtree_patch quarter = {.column = 2 * whole.column + (part & 1),
                                                         .row = 2 * whole.row + (part >> 1),
                                                         .level = level + 1};
                terrain_mesh(&relief->terrain, NULL, &quarter, &relief->other);
                for (uint32_t j = 0; j < 50; j++) {
                    double x = fixture_uniform(&state, 0.0, half);
                    double z = fixture_uniform(&state, 0.0, half);
                    double before =
                        mesh_height(&relief->mesh, x + (part & 1) * half, z + (part >> 1) * half);
                    worst = maths_max(worst, fabs(before - mesh_height(&relief->other, x, z)));
                }
            }
        }
        print_message("level %d: jumps by %.2f pixels at most\n", level, pixels(worst, level));
        assert_true(pixels(worst, level) <= (level < TERRAIN_QUADTREE_HAZY_LEVEL ? 2.0 : 1.0));
    }
}

/* Fills in the heights of a mesh's northern edge in steps. */
static void edge_heights(const struct terrain_mesh *mesh, double side, uint32_t steps,
                         double *heights)
{
    for (uint32_t i = 0; i <= steps; i++)
        heights[i] = mesh_height(mesh, side * i / steps, 0.0);
}

/* Where two patches meet, the higher one's skirt reaches below the lower one's edge. Levels of
 * neighbours differ by at most two. */
static void test_skirts_close_every_gap(void **context)
{
    (void)context;
    enum { STEPS = 64 };
    uint64_t state = fixture_seed(SEED);
    double here[STEPS + 1], there[STEPS + 1], worst = 0.0;
    for (uint32_t i = 0; i < 120; i++) {
        int32_t level = 3 + (int32_t)(i % 8), finer = level + (int32_t)(i / 8 % 3);
        finer = finer > TERRAIN_QUADTREE_LEVEL_MAX ? TERRAIN_QUADTREE_LEVEL_MAX : finer;
        struct terrain_quadtree_patch patch = some_patch(&state, finer);
        double side = terrain_quadtree_patch_side(finer), wide = terrain_quadtree_patch_side(level);
        /* Its northern edge against the southern edge of a coarser one. */
        patch.row = patch.row >> (finer - level) << (finer - level);
        double x = patch.column * side, z = patch.row * side;
        dig_some(&state, x + 0.5 * side, z, maths_min(10.0, 0.5 * side));
        struct terrain_quadtree_patch north = patch_at(level, x + 0.5 * side, z - 0.5 * wide);
        terrain_mesh(&relief->terrain, &relief->index, &patch, &relief->mesh);
        terrain_mesh(&relief->terrain, &relief->index, &north, &relief->other);
        edge_heights(&relief->mesh, side, STEPS, here);
        for (uint32_t j = 0; j <= STEPS; j++)
            there[j] =
                mesh_height(&relief->other, x - north.column * wide + side * j / STEPS, wide);
        for (uint32_t j = 0; j <= STEPS; j++) {
            double gap = here[j] - there[j];
            double skirt = terrain_quadtree_skirt(gap > 0.0 ? finer : level);
            worst = maths_max(worst, fabs(gap) / skirt);
            assert_true(fabs(gap) < skirt);
        }
        forget_craters();
    }
    print_message("gaps take up to %.0f %% of a skirt\n", 100.0 * worst);
}

static void test_near_meshes_have_craters(void **context)
{
    (void)context;
    uint64_t state = fixture_seed(SEED);
    for (int32_t level = TERRAIN_QUADTREE_DIG_LEVEL; level <= TERRAIN_QUADTREE_LEVEL_MAX; level++) {
        struct terrain_quadtree_patch patch = some_patch(&state, level);
        double side = terrain_quadtree_patch_side(level), x = (patch.column + 0.4) * side;
        double z = (patch.row + 0.6) * side, worst = 0.0;
        dig_some(&state, x, z, 0.2 * side);
        terrain_mesh(&relief->terrain, &relief->index, &patch, &relief->mesh);
        for (uint32_t j = 0; j < 1000; j++) {
            double dx = fixture_uniform(&state, 0.0, side), dz = fixture_uniform(&state, 0.0, side);
            double truth = terrain_height(&relief->terrain, &relief->index,
                                          patch.column * side + dx, patch.row * side + dz);
            worst = maths_max(worst, fabs(mesh_height(&relief->mesh, dx, dz) - truth));
        }
        print_message("level %d: craters off by %.2f m, %.2f pixels\n", level, worst,
                      pixels(worst, level));
        /* Cells cannot follow a sharp rim or the step between two bowls exactly. */
        assert_true(worst < 0.4 * side / GROUND_CELLS_MAX + 0.2);
        forget_craters();
    }
}

/* Near meshes have the shape of a ramp to within a cell's width of its edges, and a ford's water.
 */
static void test_near_meshes_have_earthworks(void **context)
{
    (void)context;
    uint64_t state = fixture_seed(SEED);
    struct terrain_quadtree_patch patch = some_patch(&state, TERRAIN_QUADTREE_LEVEL_MAX);
    double side = terrain_quadtree_patch_side(patch.level), worst = 0.0, highest = 0.0;
    struct earthwork work = {.x = (patch.column + 0.5) * side,
                             .z = (patch.row + 0.5) * side,
                             .cosine = 1.0,
                             .half_length = 10.0,
                             .half_width = 6.0,
                             .height_m = 3.0,
                             .back_m = 18.0,
                             .front_m = 2.0,
                             .side_m = 2.0,
                             .shape = EARTHWORK_RAMP};
    relief->terrain.earthworks = works_index(&work, 1);
    terrain_mesh(&relief->terrain, NULL, &patch, &relief->mesh);
    for (uint32_t j = 0; j < 2000; j++) {
        double dx = fixture_uniform(&state, 0.0, side), dz = fixture_uniform(&state, 0.0, side);
        double x = patch.column * side + dx, z = patch.row * side + dz;
        double truth = terrain_height(&relief->terrain, NULL, x, z);
        worst = maths_max(worst, fabs(mesh_height(&relief->mesh, dx, dz) - truth));
        highest = maths_max(highest, earthwork_height(&work, x, z));
    }
    assert_true(highest > 2.5 && worst < 1.5 * side / GROUND_CELLS_MAX);
    work.shape = EARTHWORK_FORD;
    work.height_m = -1.0;
    work.freeboard_m = 0.25;
    terrain_mesh(&relief->terrain, NULL, &patch, &relief->mesh);
    works_free(&relief->terrain.earthworks);
    double dry = terrain_height(&relief->terrain, NULL, work.x, work.z - 6.0);
    assert_true(fabs(mesh_height(&relief->mesh, 0.5 * side, 0.5 * side - 6.0) - dry + 0.25) < 0.1);
}

static void test_meshes_are_small(void **context)
{
    (void)context;
    uint64_t state = fixture_seed(SEED);
    uint32_t triangles = 0, cells = 0;
    for (uint32_t i = 0; i < 60; i++) {
        struct terrain_quadtree_patch patch = some_patch(&state, 4 + (int32_t)(i % 3));
        terrain_mesh(&relief->terrain, NULL, &patch, &relief->mesh);
        triangles += relief->mesh.top_triangles;
        cells += 2 * GROUND_CELLS * GROUND_CELLS;
    }
    print_message("%u triangles of %u\n", triangles, cells);
    assert_true(triangles < cells / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mesh_covers_its_patch_and_faces_up),
        cmocka_unit_test(test_skirt_faces_outside),
        cmocka_unit_test(test_mesh_is_the_terrain_to_a_pixel),
        cmocka_unit_test(test_ground_does_not_jump_when_a_patch_is_divided),
        cmocka_unit_test(test_skirts_close_every_gap),
        cmocka_unit_test(test_near_meshes_have_craters),
        cmocka_unit_test(test_near_meshes_have_earthworks),
        cmocka_unit_test(test_meshes_are_small),
    };
    return cmocka_run_group_tests(tests, open_relief, close_relief);
}
