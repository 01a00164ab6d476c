/* Makes meshes: coarser ones by simplification, finer ones by halving long edges. */
#include "renderer/scene/model/mesh.h"

#include "renderer/scene/model/track_outline.h"
#include "renderer/scene/model/mesh_facets.h"
#include "renderer/scene/model/mesh_simplify.h"
#include "world/world.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* The finest level halves edges longer than FINE_EDGE_M. If a model would then have many more than
 * FINE_TRIANGLES, only longer edges are halved: a triangle covers about FINE_SHARE of the square of
 * such an edge. */
#define FINE_EDGE_M    0.5f
#define FINE_TRIANGLES 5000.0f
#define FINE_SHARE     0.12f
#define FOOT_M         0.02f /* corners this near to the lowest are part of the foot */

static float squared(const float a[3], const float b[3])
{
    float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

/* Adds the facet. Halves it until no edge is longer than edge_m. */
static int add_fine(struct mesh_facets *facets, const struct facet *facet, float edge_m)
{
    uint32_t longest = 0;
    float length = 0.0f;
    for (uint32_t i = 0; i < 3; i++) {
        float edge = squared(facet->corner[i], facet->corner[(i + 1) % 3]);
        if (edge > length) {
            length = edge;
            longest = i;
        }
    }
    if (length < edge_m * edge_m)
        return mesh_facets_add(facets, facet);
    uint32_t a = longest, b = (longest + 1) % 3;
    struct facet first = *facet, second = *facet;
    for (uint32_t axis = 0; axis < 3; axis++)
        first.corner[b][axis] = second.corner[a][axis] =
            0.5f * (facet->corner[a][axis] + facet->corner[b][axis]);
    /* Each half is smaller, so the depth grows with the logarithm of the size. */
    if (add_fine(facets, &first, edge_m) != 0)
        return -1;
    return add_fine(facets, &second, edge_m);
}

static struct facet facet_of(const struct world *world, const struct model *m, uint32_t triangle)
{
    const struct model_vertex *v = world->model_vertices + m->first_vertex;
    struct facet facet = {.from = &world->model_triangles[m->first_triangle + triangle]};
    for (uint32_t i = 0; i < 3; i++) {
        const struct model_vertex *at = &v[facet.from->vertex[i]];
        facet.corner[i][0] = at->x;
        facet.corner[i][1] = at->y;
        facet.corner[i][2] = at->z;
    }
    return facet;
}

/* Returns the n-th visible triangle. */
static struct facet seen_facet(const struct world *world, const struct model *m, uint32_t n)
{
    return facet_of(world, m, m->solid_triangles + n);
}

static uint32_t seen_count(const struct model *m)
{
    return m->triangle_count - m->solid_triangles;
}

static float fine_edge(const struct world *world, const struct model *m)
{
    float area = 0.0f, across[3];
    for (uint32_t t = 0; t < seen_count(m); t++) {
        struct facet facet = seen_facet(world, m, t);
        area += 0.5f * facet_across(&facet, across);
    }
    return fmaxf(FINE_EDGE_M, sqrtf(area / (FINE_SHARE * FINE_TRIANGLES)));
}

static void model_box(const struct world *world, const struct model *m, float low[3], float high[3])
{
    for (uint32_t axis = 0; axis < 3; axis++) {
        low[axis] = INFINITY;
        high[axis] = -INFINITY;
    }
    for (uint32_t t = 0; t < seen_count(m); t++) {
        struct facet facet = seen_facet(world, m, t);
        for (uint32_t i = 0; i < 9; i++) {
            low[i % 3] = fminf(low[i % 3], facet.corner[i / 3][i % 3]);
            high[i % 3] = fmaxf(high[i % 3], facet.corner[i / 3][i % 3]);
        }
    }
}

/* Collects the visible triangles of the model at this level of detail. */
static int collect(struct mesh_facets *facets, const struct world *world, const struct model *m,
                   enum mesh_detail detail)
{
    static const double pixels[MESH_DETAIL_COUNT] = {[MESH_MIDDLE] = MESH_FULL_PIXELS,
                                                     [MESH_COARSE] = MESH_MIDDLE_PIXELS,
                                                     [MESH_COARSEST] = MESH_COARSE_PIXELS};
    static const uint32_t most[MESH_DETAIL_COUNT] = {[MESH_MIDDLE] = MESH_MIDDLE_MAX,
                                                     [MESH_COARSE] = MESH_COARSE_MAX,
                                                     [MESH_COARSEST] = MESH_COARSEST_MAX};
    float low[3], high[3], edge_m = fine_edge(world, m), across[3];
    bool solid = detail == MESH_COARSEST && m->solid_triangles > 0;
    uint32_t end = solid ? m->solid_triangles : m->triangle_count;
    for (uint32_t t = solid ? 0 : m->solid_triangles; t < end; t++) {
        struct facet facet = facet_of(world, m, t);
        if (facet_across(&facet, across) < 1e-9f)
            continue; /* no area */
        if (detail == MESH_FINE ? add_fine(facets, &facet, edge_m)
                                : mesh_facets_add(facets, &facet))
            return -1;
    }
    if (detail < MESH_MIDDLE)
        return 0;
    model_box(world, m, low, high);
    float longest = fmaxf(high[0] - low[0], fmaxf(high[1] - low[1], high[2] - low[2]));
    double pixel_m = (double)longest / pixels[detail];
    return mesh_simplify(facets, MESH_DROP_PIXELS * pixel_m, MESH_ERROR_PIXELS * pixel_m,
                         most[detail]);
}

static void put_vertices(struct mesh *mesh, const struct mesh_facets *facets,
                         const float (*normals)[3])
{
    for (uint32_t i = 0; i < 3 * facets->count; i++) {
        const struct facet *facet = &facets->facet[i / 3];
        struct mesh_vertex *vertex = &mesh->vertices[mesh->count++];
        *vertex = (struct mesh_vertex){.red = facet->from->red,
                                       .green = facet->from->green,
                                       .blue = facet->from->blue,
                                       .force_tint = facet->from->force_tint,
                                       .part = facet->from->part,
                                       .joint = facet->from->joint};
        memcpy(vertex->position, facet->corner[i % 3], sizeof vertex->position);
        memcpy(vertex->normal, normals[i], sizeof vertex->normal);
    }
}

/* Sets the position of each corner on its track's outline. The corners of a triangle get positions
 * near each other. */
static int set_track_positions(struct mesh *mesh, const struct world *world, uint32_t model)
{
    for (uint32_t joint = 1; joint < MODEL_JOINTS_MAX; joint++) {
        struct track_outline outline = {.corner = NULL};
        for (uint32_t i = 0; i < mesh->count; i++) {
            struct mesh_vertex *vertex = &mesh->vertices[i];
            if (vertex->part != PART_TRACK || vertex->joint != joint)
                continue;
            if (outline.corner == NULL && track_outline_find(&outline, world, model, joint) != 0)
                return -1;
            float near = i % 3 == 0 ? 0.0f : mesh->vertices[i - i % 3].along;
            vertex->along = track_outline_along(&outline, vertex->position, near);
        }
        track_outline_free(&outline);
    }
    return 0;
}

int mesh_build(struct mesh *mesh, const struct world *world, uint32_t model,
               enum mesh_detail detail)
{
    struct mesh_facets facets = {NULL, 0, 0};
    float(*normals)[3] = NULL;
    *mesh = (struct mesh){NULL, 0};
    if (collect(&facets, world, &world->models[model], detail) != 0)
        goto err;
    mesh->vertices = calloc(3 * (size_t)facets.count + 1, sizeof *mesh->vertices);
    normals = malloc((3 * (size_t)facets.count + 1) * sizeof *normals);
    if (mesh->vertices == NULL || normals == NULL || mesh_facets_normals(&facets, normals) != 0)
        goto err;
    put_vertices(mesh, &facets, (const float(*)[3])normals);
    if (set_track_positions(mesh, world, model) != 0)
        goto err;
    free(normals);
    mesh_facets_free(&facets);
    return 0;

err:
    free(normals);
    mesh_facets_free(&facets);
    mesh_free(mesh);
    return -1;
}

void mesh_free(struct mesh *mesh)
{
    free(mesh->vertices);
    *mesh = (struct mesh){NULL, 0};
}

/* --- what turns about what -------------------------------------------------------------------- */

/* The box around the corners of a joint. */
struct joint {
    uint32_t part; /* enum model_part; PART_BODY: the joint has no corners */
    float low[3], high[3];
};

/* Computes the box around the joint's corners whose coordinate along the axis is at most `from`. */
static void grow(struct joint *box, const struct world *world, const struct model *m,
                 uint32_t joint, uint32_t axis, float from)
{
    for (uint32_t i = 0; i < 3; i++) {
        box->low[i] = INFINITY;
        box->high[i] = -INFINITY;
    }
    for (uint32_t t = 0; t < seen_count(m); t++) {
        struct facet facet = seen_facet(world, m, t);
        if (facet.from->joint != joint || facet.from->part == PART_BODY)
            continue;
        box->part = facet.from->part;
        for (uint32_t c = 0; c < 3; c++)
            for (uint32_t i = 0; facet.corner[c][axis] <= from && i < 3; i++) {
                box->low[i] = fminf(box->low[i], facet.corner[c][i]);
                box->high[i] = fmaxf(box->high[i], facet.corner[c][i]);
            }
    }
}

/* Returns the largest distance of the joint's corners from its axle. */
static float reach(const struct world *world, const struct model *m, uint32_t joint,
                   const float pivot[3], uint32_t axle)
{
    float most = 0.0f;
    for (uint32_t t = 0; t < seen_count(m); t++) {
        struct facet facet = seen_facet(world, m, t);
        for (uint32_t c = 0; facet.from->joint == joint && c < 3; c++) {
            float u = facet.corner[c][0] - pivot[0];
            float v = facet.corner[c][3 - axle] - pivot[3 - axle];
            most = fmaxf(most, sqrtf(u * u + v * v));
        }
    }
    return most;
}

/* Finds the pivot of a joint. A turret turns about the middle of its round foot, a gun about its
 * rear end. Rotors and wheels are symmetrical about their axes; the foot of a rotor is its mast. */
static int find_pivot(struct mesh_skeleton *skeleton, const struct world *world, uint32_t model,
                      uint32_t joint)
{
    const struct model *m = &world->models[model];
    struct joint box = {.part = PART_BODY};
    float *pivot = skeleton->pivot[joint];
    grow(&box, world, m, joint, 0, INFINITY);
    skeleton->part[joint] = (uint8_t)box.part;
    if (box.part == PART_BODY)
        return 0;
    if (box.part == PART_TRACK) {
        struct track_outline outline;
        if (track_outline_find(&outline, world, model, joint) != 0)
            return -1;
        pivot[3] = outline.link_m;
        track_outline_free(&outline);
    }
    if (box.part == PART_TURRET || box.part == PART_ROTOR)
        grow(&box, world, m, joint, 1, box.low[1] + FOOT_M);
    else if (box.part == PART_GUN)
        grow(&box, world, m, joint, 0, box.low[0] + FOOT_M);
    for (uint32_t i = 0; i < 3; i++)
        pivot[i] = 0.5f * (box.low[i] + box.high[i]);
    if (box.part == PART_ROTOR)
        pivot[3] = reach(world, m, joint, pivot, 1);
    else if (box.part == PART_WHEEL || box.part == PART_FRONT_WHEEL || box.part == PART_TAIL_ROTOR)
        pivot[3] = reach(world, m, joint, pivot, 2);
    return 0;
}

int mesh_skeleton(struct mesh_skeleton *skeleton, const struct world *world, uint32_t model)
{
    const struct model *m = &world->models[model];
    *skeleton = (struct mesh_skeleton){.turret = false};
    model_box(world, m, skeleton->low, skeleton->high);
    for (uint32_t joint = 0; joint < MODEL_JOINTS_MAX; joint++)
        if (find_pivot(skeleton, world, model, joint) != 0)
            return -1;
    for (uint32_t t = 0; t < seen_count(m); t++)
        skeleton->turret = skeleton->turret || seen_facet(world, m, t).from->part == PART_TURRET;
    return 0;
}
