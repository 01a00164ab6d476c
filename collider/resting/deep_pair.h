/* Bodies that are certainly deep in each other need no exact normals and depths, only to part: they
 * do so as capsules along their headings. Pure; any thread. */
#ifndef JOLON_COLLIDER_RESTING_DEEP_PAIR_H
#define JOLON_COLLIDER_RESTING_DEEP_PAIR_H

#include "collider/response/response.h"

#include <stdbool.h>

struct begun_body;
struct resting_gap;

/* Bodies that are no deeper in each other by their hulls do not part as capsules, unless these are
 * twice as deep [m]. */
#define DEEP_PAIR_M 0.3

/* A body's inner shape on the map: all points that are nearer to a line than the radius. */
struct capsule {
    double x, z;             /* [m] its middle */
    double along_x, along_z; /* [m] from there to one end of the line */
    double radius_m;         /* 0: the body does not cover its capsule */
};

/* Returns which part of a way along the ground is level where the row leans with it: 0.5 to 1. */
double deep_pair_level(const struct response_context *context, uint32_t row);

/* Returns the capsule of a row as it stands when the frame begins: a body that turns fast points
 * elsewhere at its end. Aircraft, ships and wrecks on a side do not cover theirs. */
struct capsule deep_pair_capsule(const struct response_context *context, uint32_t row);

/* Finds the gap of the capsules of two rows. Returns false if they are not deep in each other, or
 * if a body does not cover its capsule. */
bool deep_pair_measure(const struct response_context *context, const struct pair *pair,
                       const struct begun_body *a, const struct begun_body *b,
                       struct resting_gap *found);

/* Returns true if the capsules of two bodies are so near that the bodies may well overlap. */
bool deep_pair_is_near(const struct begun_body *a, const struct begun_body *b);

/* Sets a place near the row's position, another one for each id [m]. The places of all ids are
 * spread evenly over a disc, so that bodies at one place part in all directions. */
void deep_pair_place(const struct response_context *context, uint32_t row, double *x, double *z);

#endif
