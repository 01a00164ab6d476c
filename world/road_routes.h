/* Routes along roads: the points that a scenario gives, joined by the shortest ways. */
#ifndef JOLON_WORLD_ROAD_ROUTES_H
#define JOLON_WORLD_ROAD_ROUTES_H

#include "world/complaint.h"
#include "world/genesis.h"

/* How far from a road a point of a route along roads may be [m]. */
#define ROAD_ROUTE_OFF_M 250.0

/* Fills the genesis's routes and their points from the scenario's; its roads must be there. 0, or
 * -1 with the complaint: a point too far from any road, no way between two, out of memory. */
int road_routes_build(struct genesis *genesis, const struct complaint *to);

/* Place on a closed route this far along it [m] (modulo its length), the heading of the way there,
 * and the point that comes next. */
struct route_place {
    double x, z, heading;
    uint32_t next;
};
struct route_place road_routes_place(const struct genesis *genesis, const struct route *route,
                                     double along_m);
double road_routes_length(const struct genesis *genesis, const struct route *route);

#endif
