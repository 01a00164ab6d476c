/* Bodies that are certainly deep in each other need no exact normals and depths, only to part: they
 * do so as capsules along their headings. Pure; any thread. */
#ifndef JOLON_COLLIDER_RESTING_DEEP_PAIR_H
#define JOLON_COLLIDER_RESTING_DEEP_PAIR_H

#include "collider/response/response.h"

#include <stdbool.h>

struct resting_gap;

/* Finds the gap of the capsules of a pair of rows. Returns false if they are not deep in each
 * other, or if a body does not cover its capsule: aircraft, ships, wrecks on a side. */
bool deep_pair_measure(const struct response_context *context, const struct pair *pair,
                       struct resting_gap *found);

/* Sets a place near the row's position, another one for each id [m]. The places of all ids are
 * spread evenly over a disc, so that bodies at one place part in all directions. */
void deep_pair_place(const struct response_context *context, uint32_t row, double *x, double *z);

#endif
