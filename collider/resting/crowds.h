/* Crowds: bodies that are deep in each other, directly or through others. One whose bodies need
 * more room than the disc about them has is dense and spreads about its centre of mass. Pure; one
 * thread. */
#ifndef JOLON_COLLIDER_RESTING_CROWDS_H
#define JOLON_COLLIDER_RESTING_CROWDS_H

#include "collider/response/response.h"

#include <stdbool.h>
#include <stdint.h>

struct world;

/* A row in a crowd. */
struct crowds_body {
    uint32_t parent; /* row */
    bool dense;      /* of a root, as all below */
    uint32_t members;
    double deepest_m; /* of its pairs */
    double mass_kg, area_m2, centre_x, centre_z, reach_m;
    double along_m; /* its reach along the ground, if that slopes towards the farthest body */
};

/* The collider's own memory. */
struct crowds {
    struct crowds_body *body; /* [capacity of the world] */
    uint8_t *listed;          /* [capacity of the world] 1: in row */
    uint32_t *row;
    uint32_t count;
};

/* Returns 0, or -1 with errno ENOMEM. */
int crowds_init(struct crowds *crowds, const struct world *world);
void crowds_free(struct crowds *crowds);

/* Forgets all crowds. */
void crowds_forget(struct crowds *crowds);

/* Joins the bodies of a pair that is so deep [m]. A fixed object is in no crowd. */
void crowds_join(struct crowds *crowds, const struct pair *pair, double depth_m);

/* Finds out which crowds are dense. */
void crowds_measure(struct crowds *crowds, const struct response_context *context);

/* Returns true if the row is in a crowd that was dense when it was measured. */
bool crowds_spreads(struct crowds *crowds, uint32_t row);

/* Returns true if both sides of a pair are in the same crowd, and it spreads. */
bool crowds_spread_together(struct crowds *crowds, const struct pair *pair);

/* Sets how a row of a crowd that spreads goes [m/s]: the farther from its centre, the faster, but
 * by no more than parts its deepest pair. */
void crowds_spread(struct crowds *crowds, const struct response_context *context, uint32_t row,
                   double *x_mps, double *z_mps);

#endif
