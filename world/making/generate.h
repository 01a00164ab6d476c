/* Generated ground: Fort Hunter Liggett from its real places, with ridges and valleys between them
 * by seeded noise, and the fixed objects of Table 1 in clusters on it. Pure functions of their
 * arguments; the same bytes on every machine. Called at creation only. */
#ifndef JOLON_WORLD_MAKING_GENERATE_H
#define JOLON_WORLD_MAKING_GENERATE_H

#include "world/terrain/fixed.h"
#include "world/entity/kind.h"
#include "world/terrain/terrain.h"

#include <stdint.h>

struct road_point;

/* Converts a place on WGS 84 near the square to local metres; the square's centre is 35.95 N,
 * 121.25 W. Second-order series with the radii of curvature there; within 2 m of ECEF's tangent
 * plane over the square. */
void generate_place(double latitude_deg, double longitude_deg, double *x, double *z);

/* Fills posts [side * side, m] and cover [side * side] for side posts over WORLD_SIDE_DEFAULT_M,
 * and at most road_max points of the roads; *road_count points were written. The ground is the same
 * for every side to within a metre or two; cover shows roads where posts are 40 m apart or less. 0,
 * or -1 with errno ENOMEM, ENOBUFS (road_max too small; GENERATE_ROAD_MAX is enough), or
 * EHOSTUNREACH (water between two places that a road joins). */
#define GENERATE_ROAD_MAX 16384u
int generate_hunter_liggett(float *posts, uint8_t *cover, uint32_t side, uint64_t seed,
                            struct road_point *roads, uint32_t road_max, uint32_t *road_count);

/* Level ground of grass without roads. */
void generate_flat(float *posts, uint8_t *cover, uint32_t side, double height_m);

/* Counts of Table 1: 30,813 trees ... 40,303 in all. */
extern const uint32_t generate_table1[OBJECT_CLASS_COUNT];
#define GENERATE_TABLE1_TOTAL 40303u

/* Fills objects [GENERATE_TABLE1_TOTAL] in gridsquare order: exactly Table 1 by class, each of a
 * kind of that class (kinds of one class are mixed), at most 18 in a square, 3.9 on average in
 * occupied squares, none in water. Trees and bushes are in the hills, poles along a road (where
 * none has room on a straight line). No bounding spheres touch, and none but the poles'
 * is within 8 m of a road's middle. y is the ground's height; radius and height come from the kind
 * (trees and bushes vary by up to 20 %). Returns 0; -1 with errno ENOMEM, EINVAL if a class has no
 * kind, or ENOSPC if there is too little dry ground. */
int generate_table1_objects(struct fixed_object *objects, const struct terrain *terrain,
                            const struct kind *kinds, uint32_t kind_count,
                            const struct road_point *roads, uint32_t road_count, uint64_t seed);

#endif
