/* Narrow phase: when and where two bodies touch, by spheres or by their models' hulls. Pure; any
 * thread. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_NARROW_PHASE_H
#define JOLON_COLLIDER_NARROW_PHASE_NARROW_PHASE_H

#include "collider/geometry/time_of_impact.h"
#include "collider/motion/pair_filter.h"
#include "collider/motion/body_motion.h"

#include <stdbool.h>

/* A fixed object of less rigidity than this bends aside, and bodies pass through it. */
#define YIELDING_RIGIDITY 0.1

/* Returns true if bodies may be inside this fixed object: any object with through_fixed, else one
 * that yields. */
bool narrow_phase_lets_in(const struct world *world, bool through_fixed, uint32_t object);

/* Finds the first contact of the pair in [from, 1]; from is not before either's path.since. By the
 * methods that test only the frame's end the contact is there. through_fixed: bodies may be inside
 * any fixed object, and only entering it is a contact. Inside a yielding object they always may
 * be. */
bool narrow_phase_find(const struct method_input *input, const struct body_motion *motion,
                       bool through_fixed, const struct pair *pair, double from,
                       struct hull_contact *impact);

#endif
