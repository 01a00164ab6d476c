/* The height of land vehicles that hold their course over craters and earthworks. They have no
 * springs there, so the ground lifts them by geometry. Pure; any thread. */
#ifndef JOLON_WORLD_COURSE_LIFT_H
#define JOLON_WORLD_COURSE_LIFT_H

#include "world/terrain/rest_pose.h"

#include <stdint.h>

struct crater_index;
struct world;

/* Parts in which the underside is looked at, from end to end and from side to side. */
#define COURSE_LIFT_ALONG  16
#define COURSE_LIFT_ACROSS 8

/* Returns by how much a vehicle that stands in this pose has to be lifted until no corner of its
 * hulls and no place of its underside is deeper in the ground than it would be without works and
 * craters [m], 0 where no crater (NULL: none) and no work is near. So a crater lifts no vehicle
 * that is beside it. at_x, at_z: its position; heading clockwise from north [rad]. */
double course_lift(const struct world *world, const struct crater_index *craters, uint16_t kind,
                   double at_x, double at_z, double heading_rad, const struct rest_pose *pose);

/* Returns how a vehicle that holds its course stands on the ground: as rest_pose_of() says, and
 * lifted. */
struct rest_pose course_lift_pose(const struct world *world, const struct crater_index *craters,
                                  uint16_t kind, double at_x, double at_z, double heading_rad);

#endif
