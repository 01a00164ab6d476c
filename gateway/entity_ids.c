/* Identifiers by division. */
#include "gateway/entity_ids.h"

bool entity_ids_of(const struct entity_ids *ids, uint32_t id, struct pdu_id *to)
{
    *to = (struct pdu_id){0, 0, 0};
    if (id == 0 || (id - 1) / ENTITY_IDS_PER_APPLICATION >= ids->applications)
        return false;
    *to = (struct pdu_id){.site = ids->site,
                          .application =
                              (uint16_t)(ids->application + (id - 1) / ENTITY_IDS_PER_APPLICATION),
                          .entity = (uint16_t)(1 + (id - 1) % ENTITY_IDS_PER_APPLICATION)};
    return true;
}

uint32_t entity_ids_back(const struct entity_ids *ids, struct pdu_id from)
{
    if (from.site != ids->site || from.application < ids->application ||
        from.application - ids->application >= ids->applications || from.entity == 0 ||
        from.entity > ENTITY_IDS_PER_APPLICATION)
        return 0;
    return (uint32_t)(from.application - ids->application) * ENTITY_IDS_PER_APPLICATION +
           from.entity;
}
