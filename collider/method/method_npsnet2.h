/* NPSNET-2's way to find collisions (Osborne 1991, ch. III.C), as published: its constants, and
 * what its first level keeps. The method itself is method_npsnet2_pairs (method.h). */
#ifndef JOLON_COLLIDER_METHOD_METHOD_NPSNET2_H
#define JOLON_COLLIDER_METHOD_METHOD_NPSNET2_H

#include "collider/method/method.h"

#include <stdint.h>

/* Level 1: this near in X or in Z, or in both [m] (p. 11). */
#define METHOD_NPSNET2_NEAR_M 100.0

/* Level 2: radii are "a slightly smaller value than the actual radius" (p. 13), which is the
 * greatest extent. How much smaller is not said. */
#define METHOD_NPSNET2_RADIUS_SHARE 0.95

/* How many pairs of bodies level 1 keeps of all, by each reading of it. O(n^2). */
struct method_npsnet2_level1 {
    uint64_t pairs, kept[NEARNESS_COUNT];
};

struct method_npsnet2_level1 method_npsnet2_level1(const struct method_input *input);

#endif
