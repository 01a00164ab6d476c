/* Wheeled vehicles turn in little room by driving to and fro.
 *
 * Wheels turn no vehicle that stands, and none in a tighter circle than they can. An agent that has
 * to turn therefore drives forwards with its wheels turned. Where that does not do, it drives back
 * with its wheels turned the other way, and forwards again: when it stands and its way is blocked
 * but for another direction, when its goal is within its turning circle, and when it is to turn
 * where it is. Such a stroke ends at a walk or before an obstacle, so that each turns the vehicle
 * by 20 to 50 degrees and it stays within some metres of its place. The sign of the throttle says
 * which way a stroke goes, also that of a throttle of 0; agents choose it when they decide. */
#ifndef JOLON_MOVER_AGENT_SHUNTING_H
#define JOLON_MOVER_AGENT_SHUNTING_H

#include "mover/context/step_context.h"

/* Returns true if row i is a land vehicle with wheels. */
bool shunting_has_wheels(const struct step_context *context, uint32_t i);

/* Returns true if the kind has to turn its hull to aim its gun, and cannot do so where it stands.
 */
bool shunting_aims_hull(const struct kind *kind);

/* Lets row i turn to a heading about where it is, and stand when it has it within exact_rad:
 * vehicles on wheels to and fro, others on the spot. Returns true if it has it. */
bool shunting_face(const struct step_context *context, uint32_t i, double heading_rad,
                   double exact_rad, struct desired_motion *desired);

/* Lets row i drive to a place near by, which is this far east and south of it: on wheels backwards
 * where the place is behind it, nearer than it could turn. */
void shunting_drive(const struct step_context *context, uint32_t i, double east_m, double south_m,
                    double speed_mps, struct desired_motion *desired);

/* Changes the desired motion of row i, which drives forwards, where it must drive back first. */
void shunting_steer(const struct step_context *context, uint32_t i, struct desired_motion *desired);

#endif
