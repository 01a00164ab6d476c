/* The faces and edges of the world's convex hulls, found anew from their vertices alone. One
 * thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_HULL_SHAPE_H
#define JOLON_SUPERVISOR_PHYSICS_HULL_SHAPE_H

#include "world/maths/maths.h"

#include <stdint.h>

struct hull;
struct world;

struct hull_face {
    struct vec3 normal; /* unit, outwards */
    double offset_m;    /* no vertex is farther along the normal */
};

/* Two faces meet at an edge. */
struct hull_edge {
    uint16_t vertex[2];
    uint16_t face[2];
};

struct hull_shape {
    const struct vec3 *vertex; /* body axes [m] */
    struct hull_face *face;
    struct hull_edge *edge;
    uint32_t vertices, faces, edges;
    struct vec3 centre; /* of a sphere around it */
    double radius_m;
};

/* Fills shape with a hull's. Returns 0, or -1 with errno ENOMEM. */
int hull_shape_find(struct hull_shape *shape, const struct world *world, const struct hull *hull);
void hull_shape_free(struct hull_shape *shape);

/* Returns how far the hull reaches in a direction, from the body's position [m]. */
double hull_shape_reach(const struct hull_shape *shape, struct vec3 direction);

#endif
