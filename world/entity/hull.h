/* Convex hulls: a kind's polygon model as the narrow phase sees it. Each connected piece of a model
 * (a trunk, a crown, a turret) gives one hull; near hulls are joined until at most HULLS_A_MODEL
 * are left. Written once at creation, read-only to all. */
#ifndef JOLON_WORLD_ENTITY_HULL_H
#define JOLON_WORLD_ENTITY_HULL_H

#include "world/maths/maths.h"

#include <stdint.h>

#define HULLS_A_MODEL     8
#define HULL_VERTICES_MAX 256

/* Body axes: x forward, y up, z right, origin at the entity's position [m]. */
struct hull {
    uint32_t first_vertex, vertex_count; /* extreme points, in the world's hull_vertices */
    uint32_t first_plane, plane_count;   /* faces, in the world's hull_planes */
    struct vec3 centre;                  /* of its box along the body axes and of its sphere */
    struct vec3 half;                    /* half the box's length, height and width [m] */
    double radius_m;                     /* of the sphere: no vertex is outside either */
};

/* A face's plane: points inside have normal . p <= offset. Coplanar faces are one plane. */
struct hull_plane {
    struct vec3 normal; /* unit, outwards */
    double offset_m;
};

#endif
