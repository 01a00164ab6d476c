/* The points at which a free body touches another, or nearly does, at the beginning of a frame,
 * with the gap at each of them. Pure; any thread. */
#ifndef JOLON_COLLIDER_RESTING_FREE_POINTS_H
#define JOLON_COLLIDER_RESTING_FREE_POINTS_H

#include "collider/geometry/time_of_impact.h"
#include "world/body_points.h"

#include <stdint.h>

struct world;

/* Most points of a pair, and of a body and the ground. Of more points the nearest ones count. */
#define FREE_POINTS_MAX 32u

struct free_point {
    struct vec3 at;     /* [m, world] */
    struct vec3 normal; /* unit, from a to b; from the ground to the body */
    double gap_m;       /* along the normal; below 0: a depth */
};

/* Finds the points where the hulls of two bodies are within margin_m [m, >= 0] of each other when
 * the frame begins. Returns how many there are. Several pairs of hulls have points with normals of
 * their own. Hulls that overlap have that of the shallowest of their faces. */
uint32_t free_points_find(const struct swept_body *a, const struct swept_body *b, double margin_m,
                          struct free_point point[FREE_POINTS_MAX]);

/* Finds the points of a body in this place within margin_m of the ground. */
uint32_t free_points_on_ground(const struct world *world, const struct crater_index *craters,
                               const struct body_points *points, struct vec3 at, struct quat turn,
                               double margin_m, struct free_point point[FREE_POINTS_MAX]);

#endif
