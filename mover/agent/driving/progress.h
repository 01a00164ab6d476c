/* Whether a vehicle gets on. Writes the field stalled of row i. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_DRIVING_PROGRESS_H
#define JOLON_MOVER_AGENT_DRIVING_PROGRESS_H

#include "mover/context/step_context.h"

/* Counts the decisions of row i's agent in which the vehicle drives and does not get on: it is
 * nearly at rest, or on land scrapes along what it touches at less than a quarter of the speed that
 * it wants. Returns true when that has lasted for 3 s, or for 6 s where a land vehicle stands
 * since no way before it is free, and counts from 0 again. For each decision once. */
bool progress_stalled(const struct step_context *context, uint32_t i);

/* Returns true if it was stuck and has not got on since then. One on a script does not get on while
 * it backs off. */
bool progress_backed_off(const struct step_context *context, uint32_t i);

/* Returns true if it was stuck twice or more without getting on in between. */
bool progress_stuck(const struct step_context *context, uint32_t i);

/* Returns true if it has tried to get on for about two minutes in vain: after each try of one that
 * is stuck a random draw decides, so that those of a crowd do not give up together. */
bool progress_gives_up(const struct step_context *context, uint32_t i);

/* Returns true if it is stuck so, and stands: it tries to get on for 3 s in every 12 s, whatever it
 * wants. */
bool progress_rests(const struct step_context *context, uint32_t i);

/* Returns the heading in which a vehicle that is stuck backs off [rad]: away from where it drove,
 * up to 60 degrees to a random side. tried: it is backing off already; then any heading. */
double progress_way_out(const struct step_context *context, uint32_t i, bool tried);

#endif
