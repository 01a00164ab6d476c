/* Routes along roads: the points of a scenario, joined by shortest paths. */
#ifndef JOLON_WORLD_MAKING_ROAD_ROUTING_H
#define JOLON_WORLD_MAKING_ROAD_ROUTING_H

#include "world/runtime/error_text.h"

#include <stdint.h>

struct route;
struct world_build;

/* Greatest distance from a road of a point of a route along roads [m]. */
#define ROAD_ROUTE_OFF_M 250.0

/* Fills the built world's routes and their points from the scenario's; its roads must be there.
 * Returns 0, or -1 with error set: a point too far from any road, no path between two points, out
 * of memory. */
int road_routing_build(struct world_build *built, struct error_text *error);

/* A place on a closed route at a distance along it [m] (modulo its length), the heading there, and
 * the next point. */
struct route_place {
    double x, z, heading;
    uint32_t next;
};
struct route_place road_routing_place(const struct world_build *built, const struct route *route,
                                      double along_m);
double road_routing_length(const struct world_build *built, const struct route *route);

#endif
