/* Convex hulls: a kind's polygon model as the narrow phase sees it. Each connected piece of a model
 * (a trunk, a crown, a turret) gives one hull; near hulls of one part are joined until at most
 * HULLS_A_MODEL are left. Written once at creation, read-only to all. */
#ifndef JOLON_WORLD_ENTITY_HULL_H
#define JOLON_WORLD_ENTITY_HULL_H

#include "world/maths/maths.h"

#include <stdint.h>

#define HULLS_A_MODEL     8
#define HULL_VERTICES_MAX 256

/* The parts of a model that collide and move relative to each other. The turret turns on the body,
 * and the gun is raised and lowered on the turret. A model without a turret is all body. */
enum hull_part { HULL_PART_BODY, HULL_PART_TURRET, HULL_PART_GUN, HULL_PART_COUNT };

/* Body axes: x forward, y up, z right, origin at the entity's position [m]. A turret points
 * forwards and a gun is level. */
struct hull {
    uint32_t first_vertex, vertex_count; /* extreme points, in the world's hull_vertices */
    uint32_t first_plane, plane_count;   /* faces, in the world's hull_planes */
    uint32_t part;                       /* enum hull_part */
    uint32_t unused;
    struct vec3 centre; /* of its box along the body axes and of its sphere */
    struct vec3 half;   /* half the box's length, height and width [m] */
    double radius_m;    /* of the sphere: no vertex is outside either */
};

/* A box along the body axes [m]. */
struct hull_box {
    struct vec3 middle, half;
};

/* A face's plane: points inside have normal . p <= offset. Coplanar faces are one plane. */
struct hull_plane {
    struct vec3 normal; /* unit, outwards */
    double offset_m;
};

#endif
