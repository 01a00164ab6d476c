/* Agents: autonomous vehicles. The percepts of an agent (perception.h) and its doctrine's table
 * (behaviour_table.h) give its behaviour. The behaviour gives its goal (goal.h) and its desired
 * motion. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_AGENT_H
#define JOLON_MOVER_AGENT_AGENT_H

#include "mover/context/step_context.h"

/* Row i's agent decides: it perceives, changes its behaviour, chooses its desired motion and steers
 * around obstacles. Unless a script or a driver has the controls it sets them, too. */
void agent_think(const struct step_context *context, uint32_t i, struct desired_motion *desired);

/* The desired motion of a row that is on a script or driven, or is returning to its script. It
 * decides and tries to fire when it is due. */
void agent_direct(const struct step_context *context, uint32_t i, struct desired_motion *desired);

/* The desired motion that row i's controls express, as its agent last set them. */
void agent_controls_motion(const struct step_context *context, uint32_t i,
                           struct desired_motion *desired);

/* Returns true if a script or a driver sets the controls, so that the row decides in every
 * frame. */
static inline bool agent_thinks_each_frame(enum behaviour behaviour)
{
    return behaviour == BEHAVIOUR_DRIVEN || behaviour == BEHAVIOUR_SCRIPT;
}

#endif
