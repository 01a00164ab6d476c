/* Hulls: from a model's triangles to a few convex hulls, what the narrow phase collides with
 * (world/hull.h).
 *
 * Each connected piece of the model is wrapped, and a piece inside another taken into it. Then
 * those two whose common hull adds least to their own volumes are joined, again and again, until at
 * most HULLS_A_MODEL are left, and on for as long as that costs next to nothing. Every corner of
 * the model is within one of the hulls; a hull's vertices are corners of the model, but for flat
 * pieces (config/pieces.h). The same model gives the same hulls, to the bit, on every machine. */
#ifndef JOLON_CONFIG_HULLS_H
#define JOLON_CONFIG_HULLS_H

#include "config/keys.h"
#include "world/scenario.h"

#include <stdint.h>

/* Joining two hulls that adds no more than this [m3] is free, a can of fuel: fewer hulls make a
 * faster narrow phase. */
#define HULLS_FREE_M3 0.02

/* When some must be joined, others that cost as much to within this share are joined too, so that
 * what is the same on both sides of a model mostly stays so. */
#define HULLS_TIE_SHARE 0.01

/* Faces whose corners are this near to one plane are one [m]. */
#define HULLS_FLAT_M 2e-6

/* What a kind knows of its model's hulls. */
struct hulls {
    uint32_t first, count; /* in the scenario's hulls */
    uint32_t outer;        /* the hull around all of them, likewise */
    double bound_m;        /* all as in struct kind */
    double level_m;
    double low_m, high_m;
};

/* Adds a model's hulls to the scenario's tables. 0; -1 with the message, which place begins: too
 * many pieces, a hull of more than HULL_VERTICES_MAX vertices, no memory. */
int hulls_build(struct hulls *hulls, struct scenario *scenario, const struct model *model,
                struct key_place place, struct loader_message *message);

#endif
