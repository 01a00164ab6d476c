/* Narrow phase: when and where two bodies touch, by spheres or by their models' hulls. Pure; any
 * thread. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_NARROW_PHASE_H
#define JOLON_COLLIDER_NARROW_PHASE_NARROW_PHASE_H

#include "collider/geometry/time_of_impact.h"
#include "collider/motion/pair_filter.h"
#include "collider/motion/body_motion.h"

#include <stdbool.h>

/* A fixed object of less rigidity than this bends aside and lets bodies through. */
#define YIELDING_RIGIDITY 0.1

/* May bodies be inside this fixed object? Under through_fixed in any, else in one that yields. */
bool narrow_phase_lets_in(const struct world *world, bool through_fixed, uint32_t object);

/* First touch of the pair in [from, 1]; from is not before either's path.since. By the methods that
 * look at the frame's end only, the touch is there. through_fixed: bodies may stand in any fixed
 * object and only entering one is a touch; in a yielding one they always may. */
bool narrow_phase_touch(const struct method_input *input, const struct body_motion *motion,
                        bool through_fixed, const struct pair *pair, double from,
                        struct hull_contact *touch);

#endif
