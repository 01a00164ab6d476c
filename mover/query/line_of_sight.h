/* Outlook: whether one point sees another, over the ground with its craters and past the fixed
 * objects. Pure but for the skyline, which follows from the static world alone; any thread. */
#ifndef JOLON_MOVER_QUERY_LINE_OF_SIGHT_H
#define JOLON_MOVER_QUERY_LINE_OF_SIGHT_H

#include "world/terrain/square_bounds.h"
#include "world/world.h"

#include <stdbool.h>
#include <stdint.h>

struct line_of_sight {
    const struct world *world;
    const struct crater_index *craters;
    const uint8_t *fixed_damage; /* of the committed world; set before each frame */
    uint32_t *reach_start;       /* as the world's, but by what is seen of an object: the crown of a
                                    tree reaches further than its trunk */
    uint32_t *reach;
    struct square_bounds skyline; /* height of the uncratered ground and of what stands in the
                                     square, undamaged */
};

/* 0, or -1 with errno ENOMEM. */
int line_of_sight_init(struct line_of_sight *sight, const struct world *world,
                       const struct crater_index *craters);
void line_of_sight_free(struct line_of_sight *sight);

/* Is nothing between two points [m, world]? The ground hides whatever is below it; a fixed object
 * hides as a box of its kind's length, width and height, turned and sized as it stands, lower the
 * more it is damaged. Poles hide nothing, nor does what an end of the line stands in or under. */
bool line_of_sight_clear(const struct line_of_sight *sight, struct vec3 from, struct vec3 to);

/* Share of its height that a fixed object keeps. */
double line_of_sight_kept(enum damage damage);

#endif
