/* Goals: where a behaviour takes row i, in its goal columns. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_GOAL_H
#define JOLON_MOVER_AGENT_GOAL_H

#include "mover/context/step_context.h"

/* The next one of its patrol or route, the same one again after an interruption, or what else its
 * order asks for. */
void goal_next(const struct step_context *context, uint32_t i);
void goal_resume(const struct step_context *context, uint32_t i);

/* Some way off in a direction. */
void goal_away(const struct step_context *context, uint32_t i, double heading, double distance);

/* Away from an enemy's row: to where that does not see it, if such a place is near; else far. */
void goal_cover(const struct step_context *context, uint32_t i, uint32_t enemy);

/* At that row, which becomes its target. */
void goal_target(const struct step_context *context, uint32_t i, uint32_t row, uint32_t id);

/* Its force's base; is it there? A ship is where the water ends on its way. */
void goal_base(const struct step_context *context, uint32_t i);
bool goal_at_base(const struct step_context *context, uint32_t i);

/* Near enough to its goal for a body of its kind? */
bool goal_arrived(const struct step_context *context, uint32_t i);

/* Its way is blocked. */
void goal_blocked(const struct step_context *context, uint32_t i);

#endif
