/* Conversion of meshes. Sorting the vertices brings those together that share a corner. */
#include "renderer/soft/soft_mesh.h"

#include <stdlib.h>
#include <string.h>

/* A vertex of the source mesh and its index. */
struct source_vertex {
    const struct mesh_vertex *vertex;
    uint32_t index;
};

static int compare_floats(const float *a, const float *b, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (a[i] != b[i])
            return a[i] < b[i] ? -1 : 1;
    return 0;
}

static int compare_groups(const struct mesh_vertex *a, const struct mesh_vertex *b)
{
    if (a->joint != b->joint)
        return a->joint < b->joint ? -1 : 1;
    return (a->part > b->part) - (a->part < b->part);
}

static int compare_corners(const struct mesh_vertex *a, const struct mesh_vertex *b)
{
    int order = compare_groups(a, b);
    if (order == 0)
        order = compare_floats(a->position, b->position, 3);
    if (order == 0)
        order = compare_floats(a->normal, b->normal, 3);
    return order != 0 ? order : compare_floats(&a->along, &b->along, 1);
}

static int by_corner(const void *a, const void *b)
{
    const struct source_vertex *x = a, *y = b;
    int order = compare_corners(x->vertex, y->vertex);
    return order != 0 ? order : (x->index > y->index) - (x->index < y->index);
}

static uint32_t padded(uint32_t count)
{
    return (count + SOFT_MESH_PAD - 1) / SOFT_MESH_PAD * SOFT_MESH_PAD;
}

/* Numbers corners and groups, and sets each face's corners. */
static void number_corners(struct soft_mesh *mesh, const struct source_vertex *sorted,
                           uint32_t count)
{
    uint32_t next = 0;
    mesh->group_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct mesh_vertex *v = sorted[i].vertex;
        if (i == 0 || compare_groups(sorted[i - 1].vertex, v) != 0) {
            next = padded(next);
            mesh->groups[mesh->group_count++] =
                (struct soft_group){.first = next++, .part = v->part, .joint = v->joint};
        } else if (compare_corners(sorted[i - 1].vertex, v) != 0) {
            next++;
        }
        mesh->groups[mesh->group_count - 1].end = padded(next);
        mesh->faces[sorted[i].index / 3].corner[sorted[i].index % 3] = next - 1;
    }
    mesh->corner_count = padded(next);
}

static void set_corner(struct soft_mesh *mesh, uint32_t at, const struct mesh_vertex *v)
{
    for (uint32_t axis = 0; axis < 3; axis++) {
        mesh->column[MESH_PLACE_X + axis][at] = v->position[axis];
        mesh->column[MESH_NORMAL_X + axis][at] = v->normal[axis];
    }
    mesh->column[MESH_ALONG][at] = v->along;
}

static int fill_columns(struct soft_mesh *mesh, const struct source_vertex *sorted, uint32_t count)
{
    size_t column = mesh->corner_count, bytes = column * MESH_COLUMNS * sizeof(float);
    mesh->column[0] = aligned_alloc(64, (bytes + 64) / 64 * 64);
    if (mesh->column[0] == NULL)
        return -1;
    for (uint32_t i = 1; i < MESH_COLUMNS; i++)
        mesh->column[i] = mesh->column[0] + column * i;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = mesh->faces[sorted[i].index / 3].corner[sorted[i].index % 3];
        do
            set_corner(mesh, at, sorted[i].vertex);
        while (++at % SOFT_MESH_PAD !=
               0); /* these copies are overwritten by the corners that follow */
    }
    return 0;
}

/* --- closed meshes -----------------------------------------------------------------------------*/

struct edge {
    float from[3], to[3];
};

static int by_place(const void *a, const void *b)
{
    const struct edge *x = a, *y = b;
    int order = compare_floats(x->from, y->from, 3);
    return order != 0 ? order : compare_floats(x->to, y->to, 3);
}

/* Finds whether the mesh is closed: whether each edge of each face also belongs to another face, in
 * the opposite direction. Returns 0, or -1 when there is no memory. */
static int find_closed(bool *closed, const struct mesh *mesh)
{
    size_t count = mesh->count;
    struct edge *edges = malloc((2 * count + 1) * sizeof *edges), *back = edges + count;
    if (edges == NULL)
        return -1;
    for (uint32_t i = 0; i < count; i++) {
        const float *a = mesh->vertices[i].position;
        const float *b = mesh->vertices[i % 3 == 2 ? i - 2 : i + 1].position;
        memcpy(edges[i].from, a, sizeof edges[i].from);
        memcpy(edges[i].to, b, sizeof edges[i].to);
        memcpy(back[i].from, b, sizeof back[i].from);
        memcpy(back[i].to, a, sizeof back[i].to);
    }
    qsort(edges, count, sizeof *edges, by_place);
    qsort(back, count, sizeof *back, by_place);
    *closed = true;
    for (size_t i = 0; i < count && *closed; i++)
        *closed = by_place(&edges[i], &back[i]) == 0;
    free(edges);
    return 0;
}

/* --- a mesh ----------------------------------------------------------------------------------- */

static int convert(struct soft_mesh *mesh, const struct mesh *from)
{
    uint32_t count = from->count;
    struct source_vertex *sorted = malloc((count + 1) * sizeof *sorted);
    mesh->face_count = count / 3;
    mesh->faces = malloc((mesh->face_count + 1) * sizeof *mesh->faces);
    mesh->groups = malloc((size_t)(MODEL_JOINTS_MAX * PART_COUNT) * sizeof *mesh->groups);
    int failed = -1;
    if (sorted == NULL || mesh->faces == NULL || mesh->groups == NULL)
        goto err_seen;
    for (uint32_t i = 0; i < count; i++) {
        const struct mesh_vertex *v = &from->vertices[i];
        struct soft_face *face = &mesh->faces[i / 3];
        sorted[i] = (struct source_vertex){v, i};
        face->red = v->red;
        face->green = v->green;
        face->blue = v->blue;
        face->force_tint = v->force_tint;
        face->track = v->part == PART_TRACK;
    }
    qsort(sorted, count, sizeof *sorted, by_corner);
    number_corners(mesh, sorted, count);
    failed = fill_columns(mesh, sorted, count);

err_seen:
    free(sorted);
    return failed;
}

int soft_mesh_open(struct soft_mesh *mesh, const struct world *world, uint32_t model,
                   enum mesh_detail detail)
{
    struct mesh built;
    *mesh = (struct soft_mesh){.faces = NULL};
    if (mesh_build(&built, world, model, detail) != 0)
        return -1;
    int failed = convert(mesh, &built);
    if (failed == 0)
        failed = find_closed(&mesh->closed, &built);
    mesh_free(&built);
    if (failed == 0)
        return 0;
    soft_mesh_close(mesh);
    return -1;
}

void soft_mesh_close(struct soft_mesh *mesh)
{
    free(mesh->column[0]);
    free(mesh->faces);
    free(mesh->groups);
    *mesh = (struct soft_mesh){.faces = NULL};
}
