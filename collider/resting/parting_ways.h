/* The ways on which bodies leave what they overlap deeply: walls, and another body if neither is
 * deep in a third. They are the shortest ways out of all hulls, and stay the same until the bodies
 * have parted. Pairs of crowds have the normals that resting_gaps.c gives them. One caller. */
#ifndef JOLON_COLLIDER_RESTING_PARTING_WAYS_H
#define JOLON_COLLIDER_RESTING_PARTING_WAYS_H

struct response_context;
struct resting;

/* Replaces the gaps of such pairs of the groups by one: along the way, and as deep as it is long.
 */
void parting_ways_find(struct resting *resting, struct response_context *context);

#endif
