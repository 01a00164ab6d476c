/* The buildings of a ground, from outlines. */
#ifndef JOLON_SUPERVISOR_GROUND_BUILDINGS_H
#define JOLON_SUPERVISOR_GROUND_BUILDINGS_H

#include "supervisor/ground/convex_parts.h"

#include <stdbool.h>
#include <stdint.h>

struct terrain;

/* Buildings before they stand on the ground. */
struct buildings {
    struct building_draft *draft; /* [used] */
    uint32_t used, room;
    uint32_t left_out;       /* for which there was no room: the smallest */
    double area_m2, lost_m2; /* of all outlines; of what lies in parts that are too narrow */
    struct ground_building *made;
    struct ground_corner *corner;
    uint32_t count, corners;
};

/* Smaller outlines are no buildings [m2]. */
#define BUILDINGS_LEAST_M2 2.0

/* Adds the parts of an outline within a square of this side: one building, or several of
 * GROUND_BUILDING_PARTS_MAX parts each. height_m: of the walls; rise_m: of a ridge over them, where
 * the building can have one. Returns how many were added; -1: no memory. */
int buildings_add(struct buildings *buildings, const struct convex_parts *parts, double height_m,
                  double rise_m, double side_m);

/* Puts the buildings on the ground: made and corner have them in the order of their places, without
 * those that two maps both have, and without the smallest where there are more than
 * GROUND_BUILDINGS_MAX. Walls reach half a metre under the lowest ground at their corners, and
 * their height counts from the highest. 0; -1: no memory. */
int buildings_found(struct buildings *buildings, const struct terrain *terrain);
void buildings_free(struct buildings *buildings);

#endif
