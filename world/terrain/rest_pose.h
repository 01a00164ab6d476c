/* How a body stands on the ground: its height, pitch and roll follow from where it is and where it
 * heads. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_REST_POSE_H
#define JOLON_WORLD_TERRAIN_REST_POSE_H

#include "world/entity/kind.h"
#include "world/terrain/terrain.h"

struct rest_pose {
    double y_m;
    double pitch_rad, roll_rad;
};

/* Returns how a land vehicle stands on the ground as the mover has it (mover/motion/ground_pose.h):
 * the height under its middle and the lift by craters, and the slopes between the heights under
 * front and back and under its sides. The roll is about the body's own axis, which pitches, so its
 * corners lie on a plane that it crosses slantwise. heading clockwise from north [rad]; craters
 * NULL: there are none. */
struct rest_pose rest_pose_of(const struct terrain *terrain, const struct crater_index *craters,
                              const struct kind *kind, double x, double z, double heading_rad);

/* Works that bend by more under a land vehicle do not bear it as five heights do [m]. */
#define REST_POSE_BEND_M 0.06

/* Returns true if earthworks bend so much under a land vehicle that comes there. *clear_y_m: the
 * height at which it is over all of them when it is level. */
bool rest_pose_bends(const struct terrain *terrain, const struct kind *kind, double x, double z,
                     double heading_rad, double *clear_y_m);

#endif
