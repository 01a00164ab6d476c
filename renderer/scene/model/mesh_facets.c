/* The list of facets, their common vertices and their normals. */
#include "renderer/scene/model/mesh_facets.h"

#include "world/model.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define EDGE_COSINE 0.84f /* facets at more than 33 degrees have a sharp edge between them */

int mesh_facets_add(struct mesh_facets *facets, const struct facet *facet)
{
    if (facets->count == facets->capacity) {
        uint32_t more = facets->capacity * 2 + 64;
        struct facet *grown = realloc(facets->facet, more * sizeof *grown);
        if (grown == NULL)
            return -1;
        facets->facet = grown;
        facets->capacity = more;
    }
    facets->facet[facets->count++] = *facet;
    return 0;
}

void mesh_facets_free(struct mesh_facets *facets)
{
    free(facets->facet);
    *facets = (struct mesh_facets){NULL, 0, 0};
}

float facet_across(const struct facet *facet, float across[3])
{
    float u[3], v[3];
    for (uint32_t i = 0; i < 3; i++) {
        u[i] = facet->corner[1][i] - facet->corner[0][i];
        v[i] = facet->corner[2][i] - facet->corner[0][i];
    }
    across[0] = u[1] * v[2] - u[2] * v[1];
    across[1] = u[2] * v[0] - u[0] * v[2];
    across[2] = u[0] * v[1] - u[1] * v[0];
    return sqrtf(across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
}

/* An entry of the hash table of vertices. */
struct slot {
    float at[3];
    uint32_t part, vertex; /* 1 + number of the vertex; 0: free */
};

static uint32_t hash_of(const struct slot *slot)
{
    uint32_t bits[3], hash = slot->part;
    memcpy(bits, slot->at, sizeof bits);
    for (uint32_t i = 0; i < 3; i++) {
        hash = (hash ^ bits[i]) * 0x9e3779b1u;
        hash ^= hash >> 15;
    }
    return hash;
}

static bool same_vertex(const struct slot *a, const struct slot *b)
{
    return a->part == b->part && a->at[0] == b->at[0] && a->at[1] == b->at[1] &&
           a->at[2] == b->at[2];
}

static struct slot *find_slot(struct slot *table, uint32_t mask, const struct slot *wanted)
{
    uint32_t i = hash_of(wanted) & mask;
    while (table[i].vertex != 0 && !same_vertex(&table[i], wanted))
        i = (i + 1) & mask;
    return &table[i];
}

uint32_t *mesh_facets_weld(const struct mesh_facets *facets, uint32_t *vertices)
{
    uint32_t corners = 3 * facets->count, size = 16;
    while (size < 2 * corners) /* at most half full */
        size *= 2;
    struct slot *table = calloc(size, sizeof *table);
    uint32_t *vertex = malloc((corners + 1) * sizeof *vertex);
    *vertices = 0;
    if (table == NULL || vertex == NULL) {
        free(table);
        free(vertex);
        return NULL;
    }
    for (uint32_t i = 0; i < corners; i++) {
        const struct facet *facet = &facets->facet[i / 3];
        struct slot wanted = {.part =
                                  (uint32_t)facet->from->joint * PART_COUNT + facet->from->part};
        for (uint32_t axis = 0; axis < 3; axis++)
            wanted.at[axis] = facet->corner[i % 3][axis] + 0.0f; /* no negative zero */
        struct slot *slot = find_slot(table, size - 1, &wanted);
        if (slot->vertex == 0) {
            *slot = wanted;
            slot->vertex = ++*vertices;
        }
        vertex[i] = slot->vertex - 1;
    }
    free(table);
    return vertex;
}

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The corners at each vertex. */
struct vertex_corners {
    uint32_t *first;  /* [vertices + 1] into corner */
    uint32_t *corner; /* [3 * count] */
};

static int find_vertex_corners(const struct mesh_facets *facets, struct vertex_corners *corners_at,
                               uint32_t **vertex)
{
    uint32_t vertices, corners = 3 * facets->count;
    *vertex = mesh_facets_weld(facets, &vertices);
    corners_at->first = calloc((size_t)vertices + 2, sizeof *corners_at->first);
    corners_at->corner = malloc((corners + 1) * sizeof *corners_at->corner);
    if (*vertex == NULL || corners_at->first == NULL || corners_at->corner == NULL)
        return -1;
    for (uint32_t i = 0; i < corners; i++)
        corners_at->first[(*vertex)[i] + 2]++;
    for (uint32_t i = 2; i < vertices + 2; i++)
        corners_at->first[i] += corners_at->first[i - 1];
    for (uint32_t i = 0; i < corners; i++)
        corners_at->corner[corners_at->first[(*vertex)[i] + 1]++] = i;
    return 0;
}

static void corner_normal(const struct mesh_facets *facets, const struct vertex_corners *corners_at,
                          uint32_t vertex, uint32_t facet, float normal[3])
{
    float own[3], sum[3] = {0.0f, 0.0f, 0.0f};
    float size = facet_across(&facets->facet[facet], own);
    for (uint32_t i = corners_at->first[vertex]; i < corners_at->first[vertex + 1]; i++) {
        float other[3];
        float length = facet_across(&facets->facet[corners_at->corner[i] / 3], other);
        if (dot(own, other) >= EDGE_COSINE * size * length)
            for (uint32_t axis = 0; axis < 3; axis++)
                sum[axis] += other[axis];
    }
    float length = sqrtf(dot(sum, sum));
    for (uint32_t axis = 0; axis < 3; axis++)
        normal[axis] = length > 0.0f ? sum[axis] / length : axis == 1 ? 1.0f : 0.0f;
}

int mesh_facets_normals(const struct mesh_facets *facets, float (*normals)[3])
{
    struct vertex_corners corners_at;
    uint32_t *vertex;
    int result = find_vertex_corners(facets, &corners_at, &vertex);
    for (uint32_t i = 0; result == 0 && i < 3 * facets->count; i++)
        corner_normal(facets, &corners_at, vertex[i], i / 3, normals[i]);
    free(vertex);
    free(corners_at.first);
    free(corners_at.corner);
    return result;
}
