/* Courses of ships over water that is deep enough. Pure; any thread, each its own row.
 *
 * The world does not know depths: the bed falls evenly from the shore (mover/motion/fording.h), so
 * a course keeps clear of the shore. */
#ifndef JOLON_MOVER_AGENT_SHIP_COURSE_H
#define JOLON_MOVER_AGENT_SHIP_COURSE_H

#include "mover/context/step_context.h"

/* Turns and slows the desired motion of row i, a ship of an agent, so that it comes to no land, no
 * shallows and not to the edge of the world. A ship that is aground backs off. */
void ship_course_keep(const struct step_context *context, uint32_t i,
                      struct desired_motion *desired);

/* Returns true if the straight course of row i to a point leads over deep water alone. */
bool ship_course_is_clear(const struct step_context *context, uint32_t i, double x, double z);

#endif
