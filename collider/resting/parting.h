/* How bodies part that overlap deeply, for instance because they began in each other. Pure; any
 * thread. */
#ifndef JOLON_COLLIDER_RESTING_PARTING_H
#define JOLON_COLLIDER_RESTING_PARTING_H

#include "collider/response/response.h"
#include "collider/resting/resting.h"

/* Bodies whose positions are within each other need no exact normals and depths, only to part: they
 * do so along the line between their positions, as discs. Returns false if the pair lies
 * otherwise. */
bool parting_measure(const struct response_context *context, const struct pair *pair,
                     struct resting_gap *found);

/* Limits what moves an overlapping body apart. The sweeps do not converge in a crowd at one place.
 */
void parting_limit(struct level_motion *pushed);

#endif
