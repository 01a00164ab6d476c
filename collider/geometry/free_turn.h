/* How a body turns within a frame if it spins freely: its free rotation, however many turns that
 * is, and on top of it what a driver, a pilot or the ground turned it by. Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_FREE_TURN_H
#define JOLON_COLLIDER_GEOMETRY_FREE_TURN_H

#include "world/entity/free_rotation.h"

#include <stdbool.h>

struct free_turn {
    struct free_rotation rotation; /* over the whole path; steps 0: the body does not spin freely */
    struct quat steered; /* the rest, about the world's axes, from 0 to this on the path */
    bool steers;         /* there is a rest */
};

/* Returns the turn by a free rotation that ends in this orientation. */
struct free_turn free_turn_to(const struct free_rotation *rotation, struct quat to);

/* Finds the orientation at a share 0..1 of the path, and the angular velocity there [rad for the
 * whole path, world axes]. */
void free_turn_at(const struct free_turn *turn, double share, struct quat *turned,
                  struct vec3 *spin);

/* Returns the greatest angular speed on the path [rad for the whole of it]. No point at r from the
 * axes' origin is accelerated by more than *bend times r [1 for the square of the whole path]. */
double free_turn_rate(const struct free_turn *turn, double *bend);

/* Orders two turns for a result that does not depend on the order of bodies: -1, 0, 1. */
int free_turn_order(const struct free_turn *a, const struct free_turn *b);

#endif
