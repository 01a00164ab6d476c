/* NPSNET-2's method (Osborne 1991, ch. III.C), as published: its constants, and statistics of its
 * first level. The method itself is method_npsnet2_pairs (method.h). */
#ifndef JOLON_COLLIDER_METHOD_METHOD_NPSNET2_H
#define JOLON_COLLIDER_METHOD_METHOD_NPSNET2_H

#include "collider/method/method.h"
#include "world/param_values.h"

#include <stdint.h>

/* Level 1: no farther than this in X or in Z, or in both [m] (p. 11). */
#define METHOD_NPSNET2_NEAR_M 100.0

/* Level 2: radii are "a slightly smaller value than the actual radius" (p. 13), which is the
 * greatest extent. How much smaller the thesis does not say. */
#define METHOD_NPSNET2_RADIUS_SHARE 0.95

/* How many of all pairs of bodies level 1 keeps, by each reading of it. O(n^2). */
struct method_npsnet2_level1 {
    uint64_t pairs, kept[NEARNESS_COUNT];
};

struct method_npsnet2_level1 method_npsnet2_level1(const struct method_input *input);

#endif
