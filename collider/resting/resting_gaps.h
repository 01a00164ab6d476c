/* How the bodies of resting contacts lie to each other when the frame begins. Pure; one caller, and
 * its workers. */
#ifndef JOLON_COLLIDER_RESTING_RESTING_GAPS_H
#define JOLON_COLLIDER_RESTING_RESTING_GAPS_H

#include "collider/resting/resting.h"

/* Measures the table's pairs, those of bodies that are new, and the neighbours of bodies that have
 * to part: fills resting->gap, which has room for all of them then. */
void resting_gaps_measure(struct resting *resting, struct response_context *context);

#endif
