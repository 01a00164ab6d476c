/* Scripts: what the steps of row i's script want of its body. Any thread, each its own row.
 *
 * A row's leg is its step: pass * count + step, passes counted where its script repeats. Its
 * until_tick is the step's own: when a wait or held controls end, or since when a shot is wanted;
 * 0: the step has just begun. */
#ifndef JOLON_MOVER_AGENT_SCRIPT_PLAYER_H
#define JOLON_MOVER_AGENT_SCRIPT_PLAYER_H

#include "mover/context/step_context.h"

/* Does the steps whose time has come and wishes for the one at hand. May change the behaviour: at
 * a step that says so, and to idle after the last. */
void script_player_motion(const struct step_context *context, uint32_t i,
                          struct desired_motion *desired);

/* After an interruption it goes on with the step that the clock says; a wait or controls without a
 * time of their own are over. */
void script_player_resume(const struct step_context *context, uint32_t i);

/* The percepts that a vehicle under a script minds: all of them if the script reacts, else those
 * that its body cannot help. */
uint32_t script_player_percepts(const struct step_context *context, uint32_t i);

#endif
