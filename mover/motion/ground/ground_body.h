/* A rigid body that falls, slides and lies on the ground, sub-step by sub-step: wrecks, and
 * aircraft that have landed. Pure; any thread. */
#ifndef JOLON_MOVER_MOTION_GROUND_BODY_H
#define JOLON_MOVER_MOTION_GROUND_BODY_H

#include "mover/motion/ground_contacts.h"

/* Returns into how many sub-steps a frame is cut: each is at most 1/120 s, and no point moves
 * further than 0.5 m in one. Their number is bounded. */
double ground_body_steps(const struct rigid_body *body, const struct body_points *points,
                         double dt_s);

/* Moves the body for a sub-step, with the contacts that were found for it. lift_mps2: an upward
 * thrust against its weight. Free motion is exact in the height; with contacts the velocity at the
 * end counts, which never adds energy but that of the thrust. Returns the energy that the ground
 * took along its normals [J]. */
double ground_body_step(struct ground_contacts *contacts, struct rigid_body *body, double lift_mps2,
                        double dt_s);

#endif
