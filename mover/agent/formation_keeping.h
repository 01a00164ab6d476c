/* Desired motion of vehicles in a formation and on a route. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_FORMATION_KEEPING_H
#define JOLON_MOVER_AGENT_FORMATION_KEEPING_H

#include "mover/context/step_context.h"

/* BEHAVIOUR_FOLLOW: row i keeps its place in the formation. Places move up when a member is lost.
 *
 * The leader is the member whose order is not BEHAVIOUR_FOLLOW, also while a player drives it;
 * among several such members, the one with the highest row. A leader that flees, withdraws, is
 * resupplied, has no fuel or is destroyed does not lead: the first able follower then takes over
 * its order (REASON_LEADER_LOST) and keeps it. The old leader later goes on alone. */
void formation_keeping_follow(const struct step_context *context, uint32_t i,
                              struct desired_motion *desired);

/* BEHAVIOUR_ROUTE: row i keeps to the right of the present leg of its route. */
void formation_keeping_route(const struct step_context *context, uint32_t i,
                             struct desired_motion *desired);

#endif
