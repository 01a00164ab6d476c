/* The triangles of a mesh while it is being made. They refer to the model's triangles, and can be
 * divided, simplified and smoothed. Pure. */
#ifndef JOLON_RENDERER_SCENE_MODEL_MESH_FACETS_H
#define JOLON_RENDERER_SCENE_MODEL_MESH_FACETS_H

#include <stdint.h>

struct model_triangle;

struct facet {
    float corner[3][3]; /* [m, body axes] */
    const struct model_triangle *from;
};

struct mesh_facets {
    struct facet *facet; /* owned */
    uint32_t count, capacity;
};

/* Returns 0, or -1 with errno ENOMEM. */
int mesh_facets_add(struct mesh_facets *facets, const struct facet *facet);
void mesh_facets_free(struct mesh_facets *facets);

/* Sets across to the facet's normal, whose length is twice the area. Returns the length. */
float facet_across(const struct facet *facet, float across[3]);

/* Returns the number of each corner's vertex, [3 * count], owned by the caller. Corners of one part
 * at one position share a vertex. Numbers are given in the order of the corners; vertices: how
 * many. Returns NULL with errno ENOMEM. */
uint32_t *mesh_facets_weld(const struct mesh_facets *facets, uint32_t *vertices);

/* Computes the unit normals of all corners, [3 * count][3]: the mean of the facets at the vertex
 * that do not have a sharp edge to the corner's own. Returns 0, or -1 with errno ENOMEM. */
int mesh_facets_normals(const struct mesh_facets *facets, float (*normals)[3]);

#endif
