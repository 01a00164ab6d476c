/* Routes along roads: the points that a scenario gives, joined by the shortest ways. */
#ifndef JOLON_WORLD_MAKING_ROAD_ROUTING_H
#define JOLON_WORLD_MAKING_ROAD_ROUTING_H

#include "world/runtime/error_text.h"

#include <stdint.h>

struct route;
struct world_build;

/* How far from a road a point of a route along roads may be [m]. */
#define ROAD_ROUTE_OFF_M 250.0

/* Fills the built world's routes and their points from the scenario's; its roads must be there. 0,
 * or -1 with the complaint: a point too far from any road, no way between two, out of memory. */
int road_routing_build(struct world_build *built, struct error_text *error);

/* Place on a closed route this far along it [m] (modulo its length), the heading of the way there,
 * and the point that comes next. */
struct route_place {
    double x, z, heading;
    uint32_t next;
};
struct route_place road_routing_place(const struct world_build *built, const struct route *route,
                                      double along_m);
double road_routing_length(const struct world_build *built, const struct route *route);

#endif
