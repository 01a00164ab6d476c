/* Keeping formation, and to the right of a route: wishes of behaviours that others' motion is part
 * of. Pure; any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_FORMATION_KEEPING_H
#define JOLON_MOVER_AGENT_FORMATION_KEEPING_H

#include "mover/context/step_context.h"

/* BEHAVIOUR_FOLLOW: row i's place beside its leader's motion, gaps closed.
 *
 * Whoever of a formation has another order than to follow leads it, also when a player drives him;
 * of several, the last to have taken the lead. He does not while he flees, withdraws, is supplied
 * or has no fuel: then, and when he is lost, the first follower who can takes over his order
 * (REASON_LEADER_LOST) and keeps it; the old one, should he come back, goes on alone. */
void formation_keeping_follow(const struct step_context *context, uint32_t i,
                              struct desired_motion *desired);

/* BEHAVIOUR_ROUTE: along the present leg, a vehicle's width to the right of it. */
void formation_keeping_route(const struct step_context *context, uint32_t i,
                             struct desired_motion *desired);

#endif
