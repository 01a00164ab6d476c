/* Aircraft that touch the ground gently: they stand or slide on it as rigid bodies
 * (mover/motion/ground/ground_body.h) while they have ENTITY_FLAG_LANDED. The collider destroys
 * those that strike it too hard.
 *
 * A helicopter lands on its skids. It takes off when its driver, or its agent, wants to climb and
 * its engine gives more than its weight: the rotor's lift grows with the engine, and the flag goes
 * away when it is clear of the ground. An aeroplane lands on its belly. It slides until friction
 * and ploughing stop it, and does not fly again.
 *
 * Touching down up to LANDING_SOFT_MPS does no harm: landing gear takes 3.7 m/s (12 ft/s, AH-64A).
 * From there the harm grows with the square of the sink rate, up to destruction at
 * LANDING_HARD_MPS, 12.8 m/s (42 ft/s), the most in which MIL-STD-1290A asks a helicopter to save
 * its crew. */
#ifndef JOLON_MOVER_MOTION_LANDING_H
#define JOLON_MOVER_MOTION_LANDING_H

#include "mover/context/serial_context.h"
#include "mover/context/step_context.h"

#define LANDING_SOFT_MPS 3.7
#define LANDING_HARD_MPS 12.8

/* Returns true if row i, an active aircraft, is on the ground. */
static inline bool landing_is_down(const struct step_context *context, uint32_t i)
{
    return (context->m->row[i].flags & ENTITY_FLAG_LANDED) != 0;
}

/* Row i has just flown for a frame and is near the ground. If it has touched it, gently enough, it
 * goes back to where it was and moves as a body from there. Returns true if so: flags, harm_j, spin
 * and trigger may have changed. */
bool landing_touch(const struct step_context *context, uint32_t i,
                   const struct desired_motion *desired);

/* Moves row i, which is on the ground, for a frame. desired: NULL if it holds its course. */
void landing_move(const struct step_context *context, uint32_t i,
                  const struct desired_motion *desired);

/* Tells in an event that row i has touched down hard in this frame. Serial. */
void landing_tell_hard(struct serial_context *context, uint32_t i);

#endif
