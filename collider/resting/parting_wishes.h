/* How bodies that are deep in each other would go if nothing stood in their way. Pure; one thread.
 */
#ifndef JOLON_COLLIDER_RESTING_PARTING_WISHES_H
#define JOLON_COLLIDER_RESTING_PARTING_WISHES_H

#include "collider/solver/level_solver.h"
#include "collider/resting/parting.h"

#include <stdbool.h>

/* Groups the bodies. Returns true if any has to part. There must be room for all of them. */
bool parting_wishes_group(struct parting *parting, const struct parting_input *input);

/* Returns true if the body's group has bodies that have to part. */
bool parting_wishes_parts(struct parting *parting, uint32_t body);

/* Returns how fast the pair's deepest point has to part [m/s], 0 if none overlaps. */
double parting_wishes_speed(const struct parting_input *input, const struct resting_pair *pair);

/* Limits how far a body whose group has no bodies that have to part is moved aside in a frame, and
 * its spin. */
void parting_wishes_limit(const struct parting_input *input, struct level_motion *pushed);

/* Marks the crowds that are locked by what a frame ago stood still. Bodies must be grouped. */
void parting_wishes_find_locked(struct parting *parting, const struct parting_input *input);

/* Marks the crowds in which two bodies go apart by little of what they wish. Returns true if there
 * are any that were not marked before: then all have other wishes. */
bool parting_wishes_hindered(struct parting *parting, const struct parting_input *input);

/* Sets goes, spreads, opens and the wishes of all bodies that have been grouped. */
void parting_wishes_make(struct parting *parting, const struct parting_input *input);

#endif
