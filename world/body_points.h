/* The points of a body that can touch the ground. Pure; any thread. */
#ifndef JOLON_WORLD_BODY_POINTS_H
#define JOLON_WORLD_BODY_POINTS_H

#include "world/maths/rotation.h"
#include "world/terrain/crater.h"

#include <stdint.h>

struct world;

#define BODY_POINTS_BOX 8u /* corners of a box */

struct body_points {
    const struct vec3 *point; /* [m] body axes, relative to the position */
    uint32_t count;
    double reach_m;                   /* greatest distance of a point from the position */
    struct vec3 box[BODY_POINTS_BOX]; /* memory for the points of a kind without hulls */
};

/* Finds the points of a kind: the vertices of its outer hull where bodies collide by their models,
 * and the corners of its box where they collide as spheres. points must stay where it is while it
 * is used, because it may point into itself. */
void body_points_of(const struct world *world, uint16_t kind, struct body_points *points);

/* Returns the height [m] over the ground with its craters (NULL: none) of the lowest point of a
 * body at this position and in this rotation. Negative: the point is under the ground. */
double body_points_clearance(const struct world *world, const struct crater_index *craters,
                             const struct body_points *points, struct vec3 at, struct quat turn);

#endif
