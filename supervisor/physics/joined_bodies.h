/* Groups of bodies that touch each other, directly or not: what happens to one of them is passed on
 * to the others in the same frame. One thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_JOINED_BODIES_H
#define JOLON_SUPERVISOR_PHYSICS_JOINED_BODIES_H

#include "supervisor/physics/body_look.h"
#include "supervisor/physics/neighbour_pairs.h"

/* Sets `together` of all bodies. touching: pairs of indices into looks->body. Everything else about
 * the bodies must be known. */
void joined_bodies_find(struct body_looks *looks, const struct neighbour_pairs *touching);

#endif
