/* Ships that are aground, and aircraft that stand or slide on the ground. Pure; any thread. */
#ifndef JOLON_WORLD_ENTITY_GROUNDED_H
#define JOLON_WORLD_ENTITY_GROUNDED_H

#include "world/entity/entity.h"
#include "world/entity/kind.h"

/* Returns true if row i, an active ship or aircraft, is on the ground. */
static inline bool grounded_of(const struct entities *entities, const struct kind *kind, uint32_t i)
{
    return entities->row[i].state == ENTITY_ACTIVE &&
           (kind->domain == DOMAIN_SEA || kind->domain == DOMAIN_AIR) &&
           (entities->row[i].flags & ENTITY_FLAG_AGROUND) != 0;
}

/* Returns the word for its state: aground, landed, or NULL if it is not on the ground. */
static inline const char *grounded_word(const struct entities *entities, const struct kind *kind,
                                        uint32_t i)
{
    if (!grounded_of(entities, kind, i))
        return NULL;
    return kind->domain == DOMAIN_SEA ? "aground" : "landed";
}

#endif
