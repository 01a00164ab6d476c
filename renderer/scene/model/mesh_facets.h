/* Facets: a mesh on its way. Triangles with what they are made of, to be divided, thinned out and
 * smoothed. Pure. */
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

/* 0, or -1 with errno ENOMEM. */
int mesh_facets_add(struct mesh_facets *facets, const struct facet *facet);
void mesh_facets_free(struct mesh_facets *facets);

/* Across its corners, as long as twice its area; the length. */
float facet_across(const struct facet *facet, float across[3]);

/* The number of each corner's place, [3 * count], owned by the caller: the same for corners of one
 * part at one place, in the order in which they are met. NULL with errno ENOMEM. */
uint32_t *mesh_facets_places(const struct mesh_facets *facets, uint32_t *places);

/* Unit normals of all corners, [3 * count][3]: the mean of the facets that meet there at less than
 * an edge's angle. 0, or -1 with errno ENOMEM. */
int mesh_facets_normals(const struct mesh_facets *facets, float (*normals)[3]);

#endif
