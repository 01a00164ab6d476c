/* Turrets and guns. The columns turret and gun are angles off the hull; they turn at their kind's
 * rates and no faster: by the driver's traverse and elevate, else towards the row's target (its
 * gunner's, a driver's as well), else an agent's back to rest. An agent's gunner looks at hull and
 * target anew in each frame, so his gun is stabilised; one that is driven by hand turns and tilts
 * with its hull. A kind without turret_rate_dps aims with the hull. */
#ifndef JOLON_MOVER_WEAPON_TURRET_H
#define JOLON_MOVER_WEAPON_TURRET_H

#include "mover/context/step_context.h"
#include "world/maths/rotation.h"

/* What a gun was laid by in this frame, for whoever asks after it. */
struct turret_solution {
    bool found;
    struct mat3 body; /* body to world */
    struct vec3 lead; /* unit: where the gun must point */
};

/* Turns turret and gun of row i for the frame; after it has moved. */
void turret_turn(const struct step_context *context, uint32_t i, struct turret_solution *solution);

/* Takes TRIGGER_FIRE from row i again unless it can: a target in range, a round and the gun ready,
 * the gun bearing, no friend in front of it; and TRIGGER_FIRE_AT unless the gun bears. What
 * turret_turn() left in this frame. */
void turret_hold_fire(const struct step_context *context, uint32_t i,
                      const struct turret_solution *solution);

/* Where the rounds of row i of e leave from [m, world], and its barrel's direction (unit). */
struct vec3 turret_muzzle(const struct step_context *context, const struct entities *e, uint32_t i);
struct vec3 turret_barrel(const struct entities *e, uint32_t i);

/* Direction (unit) in which a round that leaves the muzzle meets row target of e, which goes on as
 * it goes: flight time and drop. */
struct vec3 turret_lead(const struct step_context *context, struct vec3 muzzle,
                        const struct kind *munition, const struct entities *e, uint32_t target);

/* The same towards a point [m, world] that stands still, seen from the muzzle. */
struct vec3 turret_lead_point(struct vec3 muzzle, const struct kind *munition, struct vec3 point);

/* Does the gun of row i of rows point where it must to hit the committed row target? Of missiles:
 * does the seeker see it? */
bool turret_bears(const struct step_context *context, const struct entities *rows, uint32_t i,
                  uint32_t target);

#endif
