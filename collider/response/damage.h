/* Energy becomes damage (thesis rows 26, 27, 30). */
#ifndef JOLON_COLLIDER_RESPONSE_DAMAGE_H
#define JOLON_COLLIDER_RESPONSE_DAMAGE_H

#include "collider/response/response_context.h"
#include "world/entity/impact_harm.h"

/* A body's levels of damage as shares of resistance_j; those in between only show how much is
 * left. */
#define DAMAGE_SHARE_HIGH IMPACT_HARM_SHARE_HIGH
#define DAMAGE_SHARE_MED  0.3
#define DAMAGE_SHARE_LOW  0.1

/* Adds this energy to the row's damage. The row is destroyed when the sum reaches its kind's
 * resistance_j. */
void damage_row(struct response_context *context, uint32_t row, double joules, double time);
void damage_destroy(struct response_context *context, uint32_t row, double time);

/* Makes an overturned vehicle a wreck: it neither drives nor fights again. What it carries does not
 * explode. */
void damage_overturn(struct response_context *context, uint32_t row);

/* Does so with all vehicles that have rolled over on their springs (mover/motion/chassis.h), and
 * gives those that landed hard their damage. Looks at rows that were written in this frame: the
 * others are as they were. */
void damage_overturned(struct response_context *context);

/* These damage a fixed object, and two return its damage. It is never repaired: the hardest impact
 * counts.
 *
 * By the energy of the impact: the measure "energy". */
enum damage damage_fixed_object(struct response_context *context, uint32_t object, double joules);

/* By the energy too; a trunk that falls by it falls in this direction on the map. */
void damage_fell_object(struct response_context *context, uint32_t object, double joules,
                        struct vec3 away);

/* By the mass of the body that hits it, as figure 8 is printed: the measure "mass" (thesis row 27).
 * Damage is high from mass_c1_kg on, medium from mass_c2_kg, low from mass_c3_kg and none below.
 * The figure's fourth constant only repeats where "none" begins; the interval between the third and
 * the fourth, which it leaves open, is also "none". */
enum damage damage_fixed_mass(struct response_context *context, uint32_t object, double mass_kg);

/* Returns the share of a fixed kind's resistance_j from which its damage is high. */
double damage_high_share(const struct response_context *context, const struct kind *kind);

#endif
