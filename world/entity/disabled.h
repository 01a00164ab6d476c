/* What a damaged vehicle can no longer do. Pure; any thread.
 *
 * A round that penetrates armour costs a vehicle its mobility, its gun, or itself
 * (world/entity/armour.h). Medium damage of an armoured land vehicle stops its tracks or wheels,
 * high damage stops its turret and gun as well. A round that strikes the gun alone sets
 * ENTITY_FLAG_DISARMED: the vehicle still drives. Thin skins have no such parts behind them that a
 * round could find; jeeps and trucks drive until they are destroyed. */
#ifndef JOLON_WORLD_ENTITY_DISABLED_H
#define JOLON_WORLD_ENTITY_DISABLED_H

#include "world/entity/armour.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"

#include <stdbool.h>

static inline bool disabled_is_armoured(const struct kind *kind)
{
    return kind->domain == DOMAIN_LAND && kind->armour_mm[ASPECT_SIDE] >= ARMOUR_LEAST_MM;
}

/* Returns true if the vehicle cannot drive. kind: the row's. */
static inline bool disabled_drive(const struct kind *kind, const struct entities *e, uint32_t row)
{
    return e->row[row].damage >= DAMAGE_MED && !(e->row[row].flags & ENTITY_FLAG_DISARMED) &&
           disabled_is_armoured(kind);
}

/* Returns true if the vehicle can neither lay its gun nor fire. */
static inline bool disabled_gun(const struct kind *kind, const struct entities *e, uint32_t row)
{
    return (e->row[row].damage >= DAMAGE_HIGH ||
            (e->row[row].damage >= DAMAGE_MED && e->row[row].flags & ENTITY_FLAG_DISARMED)) &&
           disabled_is_armoured(kind);
}

#endif
