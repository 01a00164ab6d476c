/* Guided flight. The motor burns for the kind's burn_s and brings the missile to its top speed;
 * then drag slows it. It steers by proportional navigation at what its seeker sees, with a lag and
 * within its load and its rate of turn. Without a target it flies straight on.
 *
 * A missile loses its target for good when the target leaves the seeker's cone, when something in
 * it fails (reliability), or when a decoy takes the seeker: flares of an alert aircraft or ship,
 * smoke of an alert land vehicle. These two are drawn once for each missile. One that fails
 * swerves.
 *
 * Fields of a missile: steer and climb are its fins, -1..1 of the load limit to the right and up;
 * target_id becomes 0 when it has lost its target. */
#ifndef JOLON_MOVER_MOTION_MISSILE_H
#define JOLON_MOVER_MOTION_MISSILE_H

#include "mover/context/step_context.h"

struct kind;

/* A missile leaves the launcher with this share of its top speed. */
#define MISSILE_LAUNCH_SHARE 0.3

/* It bursts where it passes the body of an aircraft by no more than this [m]. */
#define MISSILE_FUZE_M 4.0

void missile_move(const struct step_context *context, uint32_t i, const struct kind *kind);

#endif
