/* Look-ups in a world. */
#include "world/world.h"

#include "world/entity/entity.h"
#include "world/entity/remote.h"
#include "world/params.h"

#include <string.h>

double world_dt_s(const struct world *world)
{
    return world->params->dt_s;
}

const char *world_entity_name(const struct world *world, uint32_t id)
{
    return id > 0 && id <= world->counts.names ? world->names[id - 1].text : "";
}

const char *world_row_name(const struct world *world, const struct entities *e, uint32_t row,
                           char *marking)
{
    if (!remote_is(e, row))
        return world_entity_name(world, e->row[row].id);
    remote_marking(e, row, marking);
    return marking;
}

uint32_t world_entity_named(const struct world *world, const char *name)
{
    for (uint32_t id = 1; id <= world->counts.names && name[0] != '\0'; id++)
        if (strncmp(world->names[id - 1].text, name, sizeof world->names[0].text) == 0)
            return id;
    return 0;
}
