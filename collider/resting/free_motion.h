/* The motion of free bodies after the solver: which of them come to rest, and where the others go.
 * Pure; one thread. */
#ifndef JOLON_COLLIDER_RESTING_FREE_MOTION_H
#define JOLON_COLLIDER_RESTING_FREE_MOTION_H

#include "collider/resting/free_bodies.h"

/* Writes the rows of the bodies that have been solved. Wrecks that touch each other come to rest
 * when all of them have been slow for half a second, and then stay as they were committed. Lists
 * the rows that have moved. */
void free_motion_run(struct free_bodies *bodies, struct response_context *context);

#endif
