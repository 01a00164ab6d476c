/* The desired motion of a row on a script. Any thread, each its own row.
 *
 * The field leg is the step: pass * count + step, where passes are counted if the script repeats.
 * The field until_tick is when a wait, held controls or the attempt to fire ends; 0: the step has
 * just begun. */
#ifndef JOLON_MOVER_AGENT_SCRIPT_PLAYER_H
#define JOLON_MOVER_AGENT_SCRIPT_PLAYER_H

#include "mover/context/step_context.h"

/* Carries out the steps whose time has come, and sets the desired motion of the present one. A step
 * may change the behaviour, and after the last step the row is idle. */
void script_player_motion(const struct step_context *context, uint32_t i,
                          struct desired_motion *desired);

/* After an interruption the row goes on with the step for the present time. A wait or controls
 * without a time of their own are over. */
void script_player_resume(const struct step_context *context, uint32_t i);

/* The percepts to which a row on a script reacts: all if the script reacts, else only those that
 * stop its body. */
uint32_t script_player_percepts(const struct step_context *context, uint32_t i);

#endif
