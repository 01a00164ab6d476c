/* The mesh of a patch of ground: as few triangles as keep within the patch's tolerance of the true
 * ground, in a hierarchy of right triangles (W. Evans, D. Kirkpatrick, G. Townsend,
 * "Right-triangulated irregular networks", 2001). Skirts around it hide the seams to patches of
 * other levels. Pure. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_MESH_H
#define JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_MESH_H

#include "renderer/scene/terrain/terrain_quadtree.h"

#include <stdint.h>

#define GROUND_CELLS     32u /* cells a side of a patch; a power of two */
#define GROUND_CELLS_MAX 64u /* of a patch with craters or earthworks */

/* On the ground, and below its edges. */
#define GROUND_VERTICES_MAX                                                                        \
    ((GROUND_CELLS_MAX + 1u) * (GROUND_CELLS_MAX + 1u) + 4u * (GROUND_CELLS_MAX + 1u))
#define GROUND_TRIANGLES_MAX (2u * GROUND_CELLS_MAX * GROUND_CELLS_MAX + 8u * GROUND_CELLS_MAX)

struct terrain_mesh {
    uint32_t vertex_count, triangle_count;
    uint32_t top_vertices,
        top_triangles;        /* those of the ground, which come first; the rest are the skirt */
    float (*vertices)[3];     /* [GROUND_VERTICES_MAX] x and z from the patch's north-west corner, y
                                 above sea level [m] */
    uint16_t (*triangles)[3]; /* [GROUND_TRIANGLES_MAX] counter-clockwise from above and outside */
};

/* Fills the mesh, whose arrays belong to the caller. craters may be NULL. */
void terrain_mesh(const struct terrain *terrain, const struct crater_index *craters,
                  const struct terrain_quadtree_patch *patch, struct terrain_mesh *mesh);

#endif
