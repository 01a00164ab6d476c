/* Whether one point sees another, over the ground with its craters and past the fixed objects. Any
 * thread. */
#ifndef JOLON_MOVER_QUERY_LINE_OF_SIGHT_H
#define JOLON_MOVER_QUERY_LINE_OF_SIGHT_H

#include "world/entity/entity.h"
#include "world/maths/maths.h"
#include "world/terrain/square_bounds.h"

#include <stdbool.h>
#include <stdint.h>

struct crater_index;
struct world;

struct line_of_sight {
    const struct world *world;
    const struct crater_index *craters;
    const uint8_t *fixed_damage; /* of the committed world; set before each frame */
    /* As the world's, but with the visible size of an object: the crown of a tree reaches further
     * than its trunk. */
    uint32_t *reach_start, *reach;
    /* Heights of the ground without craters, and of the undamaged objects in the square. */
    struct square_bounds skyline;
};

/* 0, or -1 with errno ENOMEM. */
int line_of_sight_init(struct line_of_sight *sight, const struct world *world,
                       const struct crater_index *craters);
void line_of_sight_free(struct line_of_sight *sight);

/* Returns true if nothing is between two points [m, world]. A fixed object hides as a box of its
 * kind's length, width and height with the object's scale and heading; damage makes the box lower.
 * Poles hide nothing, and neither does an object that holds one of the two points. */
bool line_of_sight_clear(const struct line_of_sight *sight, struct vec3 from, struct vec3 to);

/* Share of its height that a fixed object keeps. */
double line_of_sight_kept(enum damage damage);

#endif
