/* Turrets and guns. The fields turret and gun are angles relative to the hull. They change at the
 * kind's rates: by a driver's traverse and elevate, else towards the row's target, else an agent's
 * gun returns to rest. A gun that is laid on a target is stabilised, because the solution is found
 * from the present hull; a gun that a driver moves turns and tilts with the hull. A kind without
 * turret_rate_dps aims with its hull. */
#ifndef JOLON_MOVER_WEAPON_TURRET_H
#define JOLON_MOVER_WEAPON_TURRET_H

#include "mover/context/step_context.h"
#include "world/entity/table_write.h"
#include "world/maths/rotation.h"

/* The firing solution by which a gun was laid in this frame. */
struct turret_solution {
    bool found;
    struct mat3 body; /* body to world */
    struct vec3 lead; /* unit: where the gun must point */
};

/* Turns turret and gun of row i for the frame. Call after the row has moved. */
void turret_turn(const struct step_context *context, uint32_t i, struct turret_solution *solution);

/* Removes TRIGGER_FIRE from row i unless it can fire: the target is in range, a round is loaded,
 * the gun bears, and no friend is in front of it. Removes TRIGGER_FIRE_AT unless the gun bears.
 * solution: from turret_turn() in this frame. */
void turret_hold_fire(const struct step_context *context, uint32_t i,
                      const struct turret_solution *solution);

/* Turns turret and gun of row i towards a direction (unit), in the serial part of the step. Returns
 * true if the gun bears. */
bool turret_lay(const struct step_context *context, const struct table_writer *writer, uint32_t i,
                struct vec3 direction);

/* Where the rounds of row i leave [m, world], and the direction of its barrel (unit). */
struct vec3 turret_muzzle(const struct step_context *context, const struct entities *e, uint32_t i);
struct vec3 turret_barrel(const struct entities *e, uint32_t i);

/* The direction (unit) in which a round of the kind `munition` meets row target if that keeps its
 * velocity. Flight time and drop are those of the firing table. A howitzer's shell leaves along
 * about this direction, towards where the target is. */
struct vec3 turret_lead(const struct step_context *context, struct vec3 muzzle, uint16_t munition,
                        const struct entities *e, uint32_t target);

/* The same for a point [m, world]. */
struct vec3 turret_lead_point(const struct step_context *context, struct vec3 muzzle,
                              uint16_t munition, struct vec3 point);

/* Returns true if a shot of row i would hit the committed row target. For missiles: if the seeker
 * sees it. */
bool turret_bears(const struct step_context *context, const struct entities *rows, uint32_t i,
                  uint32_t target);

#endif
