/* Where the ground ends the way of a land vehicle or a ship: the edge of the world, water or land,
 * steep slopes, and earthworks that it cannot cross. Reads row i of the moved table. Any thread,
 * each its own row. */
#ifndef JOLON_MOVER_AGENT_DRIVING_GROUND_OBSTACLES_H
#define JOLON_MOVER_AGENT_DRIVING_GROUND_OBSTACLES_H

#include "mover/context/step_context.h"

/* A way straight on, from where the vehicle is. */
struct ground_way {
    double ux, uz;   /* its direction, unit */
    double length_m; /* above 0 */
    double beside_m; /* room that the vehicle needs to each side of its middle */
    double ahead_m;  /* the same in front of its middle */
    double slope;    /* tangent of the slope that is too steep for it (ground_obstacles_slope()) */
};

/* Returns the tangent of the slope that is too steep for a kind: it does not climb it, or would
 * slide or lean over across it. */
double ground_obstacles_slope(const struct kind *kind);

/* Returns how far earthworks allow row i to go, 0..length_m. */
double ground_obstacles_works(const struct step_context *context, uint32_t i,
                              const struct ground_way *way);

/* Returns how far the ground allows row i to go, 0..length_m, earthworks included. Where it is not
 * surely passable, some points of the way are tested. */
double ground_obstacles_free(const struct step_context *context, uint32_t i,
                             const struct ground_way *way);

/* Returns what the ground costs a patrol on the way, in shares of the way's length: on steep ground
 * it would slide if it turned or braked hard. */
double ground_obstacles_cost(const struct step_context *context, uint32_t i,
                             const struct ground_way *way);

#endif
