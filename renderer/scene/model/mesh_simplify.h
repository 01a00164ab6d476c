/* Simplification of a mesh for a coarser level of detail. Pure. */
#ifndef JOLON_RENDERER_SCENE_MODEL_MESH_SIMPLIFY_H
#define JOLON_RENDERER_SCENE_MODEL_MESH_SIMPLIFY_H

#include "renderer/scene/model/mesh_facets.h"

/* Reduces the mesh to at most `most` facets: drops the connected parts that cover least, and
 * collapses the edges that move the surface least. drop_m and error_m are the first limits of the
 * two; both are raised by the same factor until the mesh is small enough. Returns 0, or -1 with
 * errno ENOMEM. */
int mesh_simplify(struct mesh_facets *facets, double drop_m, double error_m, uint32_t most);

#endif
