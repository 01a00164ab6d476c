/* Meshes: coarser ones by clustering vertices on a grid, finer ones by halving long edges. */
#include "renderer/scene/mesh.h"

#include <math.h>
#include <stdlib.h>

/* The finest level halves edges longer than FINE_EDGE_M; of a model that would get many more than
 * FINE_TRIANGLES by it, longer ones: a triangle covers about FINE_SHARE of such an edge's square.
 */
#define FINE_EDGE_M    0.5f
#define FINE_TRIANGLES 5000.0f
#define FINE_SHARE     0.12f
#define COARSE_CELLS   12.0f /* grid cells along a model's longest side */
#define COARSEST_CELLS 6.0f

struct corner {
    float p[3];
};

/* One triangle on its way into a mesh. */
struct facet {
    struct corner corner[3];
    const struct model_triangle *from;
};

static void subtract(float out[3], const float a[3], const float b[3])
{
    for (uint32_t i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

static float squared(const float a[3], const float b[3])
{
    float d[3];
    subtract(d, a, b);
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

/* 0, or -1: the triangle has no area and is left out. */
static int facet_normal(const struct facet *facet, float normal[3])
{
    float u[3], v[3];
    subtract(u, facet->corner[1].p, facet->corner[0].p);
    subtract(v, facet->corner[2].p, facet->corner[0].p);
    normal[0] = u[1] * v[2] - u[2] * v[1];
    normal[1] = u[2] * v[0] - u[0] * v[2];
    normal[2] = u[0] * v[1] - u[1] * v[0];
    float length = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    if (length < 1e-9f)
        return -1;
    for (uint32_t i = 0; i < 3; i++)
        normal[i] /= length;
    return 0;
}

/* Adds the facet; 0, or -1 with errno ENOMEM. capacity is of vertices. */
static int emit(struct mesh *mesh, uint32_t *capacity, const struct facet *facet)
{
    float normal[3];
    if (facet_normal(facet, normal) != 0)
        return 0;
    if (mesh->count + 3 > *capacity) {
        uint32_t more = *capacity * 2 + 192;
        struct mesh_vertex *grown = realloc(mesh->vertices, more * sizeof *grown);
        if (grown == NULL)
            return -1;
        mesh->vertices = grown;
        *capacity = more;
    }
    for (uint32_t i = 0; i < 3; i++) {
        struct mesh_vertex *vertex = &mesh->vertices[mesh->count++];
        for (uint32_t axis = 0; axis < 3; axis++) {
            vertex->position[axis] = facet->corner[i].p[axis];
            vertex->normal[axis] = normal[axis];
        }
        vertex->red = facet->from->red;
        vertex->green = facet->from->green;
        vertex->blue = facet->from->blue;
        vertex->force_tint = facet->from->force_tint ? 255 : 0;
        vertex->part = facet->from->part;
    }
    return 0;
}

/* edge_m: as long as one may be. */
static int emit_fine(struct mesh *mesh, uint32_t *capacity, const struct facet *facet, float edge_m)
{
    uint32_t longest = 0;
    float length = 0.0f;
    for (uint32_t i = 0; i < 3; i++) {
        float edge = squared(facet->corner[i].p, facet->corner[(i + 1) % 3].p);
        if (edge > length) {
            length = edge;
            longest = i;
        }
    }
    if (length < edge_m * edge_m)
        return emit(mesh, capacity, facet);
    uint32_t a = longest, b = (longest + 1) % 3;
    struct corner middle;
    for (uint32_t axis = 0; axis < 3; axis++)
        middle.p[axis] = 0.5f * (facet->corner[a].p[axis] + facet->corner[b].p[axis]);
    struct facet first = *facet, second = *facet;
    first.corner[b] = middle;
    second.corner[a] = middle;
    /* Each half is shorter; the depth is bounded by the logarithm of the size. */
    if (emit_fine(mesh, capacity, &first, edge_m) != 0)
        return -1;
    return emit_fine(mesh, capacity, &second, edge_m);
}

static float fine_edge(const struct world *world, uint32_t model)
{
    const struct model *m = &world->models[model];
    const struct model_vertex *v = world->model_vertices + m->first_vertex;
    float area = 0.0f;
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *corner = world->model_triangles[m->first_triangle + t].vertex;
        const struct model_vertex *a = &v[corner[0]], *b = &v[corner[1]], *c = &v[corner[2]];
        float ux = b->x - a->x, uy = b->y - a->y, uz = b->z - a->z;
        float wx = c->x - a->x, wy = c->y - a->y, wz = c->z - a->z;
        float nx = uy * wz - uz * wy, ny = uz * wx - ux * wz, nz = ux * wy - uy * wx;
        area += 0.5f * sqrtf(nx * nx + ny * ny + nz * nz);
    }
    return fmaxf(FINE_EDGE_M, sqrtf(area / (FINE_SHARE * FINE_TRIANGLES)));
}

static const struct model_vertex *model_vertices(const struct world *world, uint32_t model)
{
    return world->model_vertices + world->models[model].first_vertex;
}

static void model_box(const struct world *world, uint32_t model, float low[3], float high[3])
{
    const struct model_vertex *v = model_vertices(world, model);
    for (uint32_t axis = 0; axis < 3; axis++) {
        low[axis] = INFINITY;
        high[axis] = -INFINITY;
    }
    for (uint32_t i = 0; i < world->models[model].vertex_count; i++) {
        const float p[3] = {v[i].x, v[i].y, v[i].z};
        for (uint32_t axis = 0; axis < 3; axis++) {
            low[axis] = fminf(low[axis], p[axis]);
            high[axis] = fmaxf(high[axis], p[axis]);
        }
    }
}

static void snap(float p[3], const float low[3], float cell)
{
    for (uint32_t axis = 0; axis < 3; axis++)
        p[axis] = low[axis] + cell * roundf((p[axis] - low[axis]) / cell);
}

int mesh_build(struct mesh *mesh, const struct world *world, uint32_t model,
               enum mesh_detail detail)
{
    *mesh = (struct mesh){NULL, 0};
    const struct model *m = &world->models[model];
    const struct model_vertex *v = model_vertices(world, model);
    float low[3], high[3];
    model_box(world, model, low, high);
    float longest = fmaxf(high[0] - low[0], fmaxf(high[1] - low[1], high[2] - low[2]));
    float cell = longest / (detail == MESH_COARSE ? COARSE_CELLS : COARSEST_CELLS);
    bool clustered = detail >= MESH_COARSE && longest > 0.0f;
    float edge_m = fine_edge(world, model);
    uint32_t capacity = 0;
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        struct facet facet = {.from = &world->model_triangles[m->first_triangle + t]};
        for (uint32_t i = 0; i < 3; i++) {
            const struct model_vertex *at = &v[facet.from->vertex[i]];
            facet.corner[i] = (struct corner){{at->x, at->y, at->z}};
            if (clustered)
                snap(facet.corner[i].p, low, cell);
        }
        int failed = detail == MESH_FINE ? emit_fine(mesh, &capacity, &facet, edge_m)
                                         : emit(mesh, &capacity, &facet);
        if (failed) {
            mesh_free(mesh);
            return -1;
        }
    }
    return 0;
}

void mesh_free(struct mesh *mesh)
{
    free(mesh->vertices);
    *mesh = (struct mesh){NULL, 0};
}

void mesh_frame(struct mesh_frame *frame, const struct world *world, uint32_t model)
{
    const struct model *m = &world->models[model];
    const struct model_vertex *v = model_vertices(world, model);
    model_box(world, model, frame->low, frame->high);
    /* A turret turns about the middle of its widest reach that is not its gun: the mean of its
     * corners lies well inside the body of it. Rotors are even about their axis. */
    for (uint32_t part = 0; part < PART_COUNT; part++) {
        double sum[3] = {0.0, 0.0, 0.0};
        uint32_t corners = 0;
        for (uint32_t t = 0; t < m->triangle_count; t++) {
            const struct model_triangle *triangle = &world->model_triangles[m->first_triangle + t];
            if (triangle->part != part)
                continue;
            for (uint32_t i = 0; i < 3; i++) {
                const struct model_vertex *at = &v[triangle->vertex[i]];
                sum[0] += (double)at->x;
                sum[1] += (double)at->y;
                sum[2] += (double)at->z;
                corners++;
            }
        }
        for (uint32_t axis = 0; axis < 3; axis++)
            frame->pivot[part][axis] = corners > 0 ? (float)(sum[axis] / corners) : 0.0f;
    }
}
