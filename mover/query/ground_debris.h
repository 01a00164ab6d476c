/* The debris of fallen objects under land vehicles: it slows those that pass over it, and gives
 * less grip. What lies in the list of moving debris takes its momentum in the collider
 * (collider/response/debris_push.h). Pure; any thread. */
#ifndef JOLON_MOVER_QUERY_GROUND_DEBRIS_H
#define JOLON_MOVER_QUERY_GROUND_DEBRIS_H

#include <stdbool.h>

struct kind;
struct state;
struct world;

/* Returns the share of full speed, above 0, that the debris here leaves a vehicle which pushes it
 * along; 1: there is none. */
double ground_debris_share(const struct world *world, const struct state *committed,
                           const struct kind *vehicle, double x, double z);

/* Returns true if debris lies at the point. */
bool ground_debris_lies(const struct world *world, const struct state *committed, double x,
                        double z);

#endif
