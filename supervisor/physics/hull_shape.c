/* A plane through three vertices is a face if all others are on one side of it. An edge is where
 * two faces share two vertices. Sides are computed exactly, in whole steps of 60 nm. */
#include "supervisor/physics/hull_shape.h"

#include "world/entity/hull.h"
#include "world/world.h"

#include <stdbool.h>
#include <stdlib.h>

#define STEPS 16777216.0 /* a metre; within 1,000 m a volume has 110 bits */

__extension__ typedef __int128 wide;

struct steps {
    int64_t x, y, z;
};

/* The vertices on a face. */
struct corners {
    uint64_t bit[HULL_VERTICES_MAX / 64];
};

/* What the search for faces works with. */
struct making {
    struct hull_shape *shape;
    struct steps at[HULL_VERTICES_MAX];
    struct corners *corners; /* of each face */
    uint32_t most;           /* faces */
};

static struct steps difference(const struct making *making, uint32_t from, uint32_t to)
{
    const struct steps *a = &making->at[from], *b = &making->at[to];
    return (struct steps){b->x - a->x, b->y - a->y, b->z - a->z};
}

/* The normal of the plane through three vertices, exact. */
struct normal {
    wide x, y, z;
};

static struct normal normal_of(const struct making *making, uint32_t i, uint32_t j, uint32_t k)
{
    struct steps p = difference(making, i, j), q = difference(making, i, k);
    return (struct normal){(wide)p.y * q.z - (wide)p.z * q.y, (wide)p.z * q.x - (wide)p.x * q.z,
                           (wide)p.x * q.y - (wide)p.y * q.x};
}

/* Returns 1, 0 or -1 for a vertex above, on or below the plane. */
static int side_of(const struct making *making, const struct normal *normal, uint32_t on,
                   uint32_t vertex)
{
    struct steps d = difference(making, on, vertex);
    wide above = normal->x * d.x + normal->y * d.y + normal->z * d.z;
    return (above > 0) - (above < 0);
}

/* Returns the side on which all vertices are that are not on the plane, or 0 if there are vertices
 * on both sides. Marks those on the plane. */
static int common_side(const struct making *making, const struct normal *normal, uint32_t on,
                       struct corners *corners)
{
    int common = 0;
    *corners = (struct corners){{0}};
    for (uint32_t i = 0; i < making->shape->vertices; i++) {
        int side = side_of(making, normal, on, i);
        if (side == 0)
            corners->bit[i / 64] |= (uint64_t)1 << i % 64;
        else if (common == -side)
            return 0;
        else
            common = side;
    }
    return common;
}

static bool has(const struct corners *corners, uint32_t vertex)
{
    return corners->bit[vertex / 64] >> vertex % 64 & 1;
}

/* Returns true if an earlier face has these three vertices, which are not on one line. */
static bool known(const struct making *making, uint32_t i, uint32_t j, uint32_t k)
{
    for (uint32_t f = 0; f < making->shape->faces; f++) {
        const struct corners *corners = &making->corners[f];
        if (has(corners, i) && has(corners, j) && has(corners, k))
            return true;
    }
    return false;
}

/* Adds the plane through three vertices if it is a face. */
static void try_face(struct making *making, uint32_t i, uint32_t j, uint32_t k)
{
    struct hull_shape *shape = making->shape;
    struct corners corners;
    const struct normal exact = normal_of(making, i, j, k);
    if (exact.x == 0 && exact.y == 0 && exact.z == 0)
        return;
    int side = common_side(making, &exact, i, &corners);
    if (side == 0 || known(making, i, j, k) || shape->faces == making->most)
        return;
    struct vec3 normal = {(double)exact.x, (double)exact.y, (double)exact.z};
    normal = vec3_scale(normal, -side / vec3_length(normal));
    making->corners[shape->faces] = corners;
    shape->face[shape->faces++] = (struct hull_face){normal, hull_shape_reach(shape, normal)};
}

static void find_faces(struct making *making)
{
    uint32_t count = making->shape->vertices;
    for (uint32_t i = 0; i < count; i++) {
        const struct vec3 *vertex = &making->shape->vertex[i];
        making->at[i] = (struct steps){(int64_t)floor(vertex->x * STEPS + 0.5),
                                       (int64_t)floor(vertex->y * STEPS + 0.5),
                                       (int64_t)floor(vertex->z * STEPS + 0.5)};
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++) {
            for (uint32_t k = j + 1; k < count; k++)
                try_face(making, i, j, k);
        }
    }
}

static void find_edge(struct making *making, uint32_t a, uint32_t b, uint32_t most)
{
    struct hull_shape *shape = making->shape;
    struct hull_edge edge = {.vertex = {(uint16_t)a, (uint16_t)b}};
    uint32_t found = 0;
    for (uint32_t f = 0; f < shape->faces && found < 2; f++) {
        if (has(&making->corners[f], a) && has(&making->corners[f], b))
            edge.face[found++] = (uint16_t)f;
    }
    if (found == 2 && shape->edges < most)
        shape->edge[shape->edges++] = edge;
}

int hull_shape_find(struct hull_shape *shape, const struct world *world, const struct hull *hull)
{
    *shape = (struct hull_shape){.vertex = world->hull_vertices + hull->first_vertex,
                                 .vertices = hull->vertex_count,
                                 .centre = hull->centre,
                                 .radius_m = hull->radius_m};
    /* Euler: with triangles there are 2 faces and 3 edges a vertex, less 4 and 6. */
    uint32_t faces = 2 * shape->vertices, edges = 3 * shape->vertices;
    struct making *making = calloc(1, sizeof *making);
    struct corners *corners = calloc(faces, sizeof *corners);
    shape->face = calloc(faces, sizeof *shape->face);
    shape->edge = calloc(edges, sizeof *shape->edge);
    bool done = making && corners && shape->face && shape->edge;
    if (done) {
        *making = (struct making){.shape = shape, .corners = corners, .most = faces};
        find_faces(making);
        for (uint32_t a = 0; a < shape->vertices; a++) {
            for (uint32_t b = a + 1; b < shape->vertices; b++)
                find_edge(making, a, b, edges);
        }
    } else {
        hull_shape_free(shape);
    }
    free(making);
    free(corners);
    return done ? 0 : -1;
}

void hull_shape_free(struct hull_shape *shape)
{
    free(shape->face);
    free(shape->edge);
    shape->face = NULL;
    shape->edge = NULL;
}

double hull_shape_reach(const struct hull_shape *shape, struct vec3 direction)
{
    double reach = -HUGE_VAL;
    for (uint32_t i = 0; i < shape->vertices; i++)
        reach = maths_max(reach, vec3_dot(direction, shape->vertex[i]));
    return reach;
}
