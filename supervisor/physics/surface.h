/* The ground as the physics check computes it: from the posts, the rule of the diagonal
 * (world/terrain/terrain.h) and the lists of earthworks and craters, without the functions that
 * mover and collider use. One thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_SURFACE_H
#define JOLON_SUPERVISOR_PHYSICS_SURFACE_H

#include "world/maths/maths.h"

#include <stdbool.h>
#include <stdint.h>

struct crater;
struct terrain;

struct surface {
    const struct terrain *terrain;
    struct crater *crater; /* copies, from west to east */
    uint32_t count, capacity;
    double reach_m; /* of the widest crater, its rim included */
    double rim_m;   /* height of the highest rim over the ground */
};

/* A part of the ground. */
struct surface_part {
    bool flat;   /* it is one plane */
    double at_m; /* the height in the middle */
    double east_m,
        south_m;  /* a plane: what it rises by a metre to the east and to the south; any
                     part: the most that it rises or falls so, without craters and works */
    double rim_m; /* no crater or work rises higher over the rest; a plane: 0 */
};

/* Takes the first count craters of the world's list. Returns 0, or -1 with errno ENOMEM. */
int surface_update(struct surface *surface, const struct crater *craters, uint32_t count);
void surface_free(struct surface *surface);

/* Height of the ground with its earthworks and craters [m]. */
double surface_height(const struct surface *surface, double x, double z);

/* A rectangle on the map. */
struct surface_rectangle {
    struct vec3 middle;
    struct vec3 forward, right; /* on the map, to the middles of its front and right side [m] */
};

/* Returns how high a vehicle stands over the ground under its middle because of craters and
 * earthworks [m]. Its underside, whose slopes are those between the middles of its sides, clears
 * the craters at the middles of its sides and at its corners. */
double surface_clearance(const struct surface *surface, const struct surface_rectangle *under);

/* Returns the depth of a ford's water [m], 0 where there is none. */
double surface_ford(const struct surface *surface, double x, double z);

/* Returns true if there is water at the nearest post. */
bool surface_is_water(const struct surface *surface, double x, double z);

/* Describes the ground within a distance of a point on the map [m]. */
struct surface_part surface_around(const struct surface *surface, double x, double z,
                                   double distance);

/* Returns a height that no point of the part so far from its middle passes [m]. */
static inline double surface_part_most(const struct surface_part *part, double east, double south)
{
    return part->at_m + part->rim_m + fabs(part->east_m * east) + fabs(part->south_m * south);
}

#endif
