/* Routes of missions, which a vehicle goes along once. Any thread, each its own row. */
#ifndef JOLON_MOVER_AGENT_MISSION_ROUTE_H
#define JOLON_MOVER_AGENT_MISSION_ROUTE_H

#include "mover/context/step_context.h"

struct route;

/* Makes the next point of the route row i's goal, and counts it in the field leg. Each vehicle has
 * a place of its own at each point. At the end the goal stays. */
void mission_route_next(const struct step_context *context, uint32_t i, const struct route *route);

/* Goes back to the point to which the row was going. */
void mission_route_resume(const struct step_context *context, uint32_t i,
                          const struct route *route);

/* The path to the goal is blocked: takes the next point, or stays if there is none. */
void mission_route_blocked(const struct step_context *context, uint32_t i,
                           const struct route *route);

/* Halts a row that is at the end or that watches while another one of its pair moves. */
void mission_route_pace(const struct step_context *context, uint32_t i, const struct route *route,
                        struct desired_motion *desired);

#endif
