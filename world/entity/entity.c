/* The entity table's memory, and copies of rows. */
#include "world/entity/entity.h"

#include <string.h>

size_t entities_bytes(uint32_t capacity)
{
    return (capacity * sizeof(struct entity) + TABLE_ALIGN - 1) / TABLE_ALIGN * TABLE_ALIGN;
}

void entities_bind(struct entities *entities, uint32_t capacity, void *base)
{
    *entities = (struct entities){capacity, base};
}

void entities_copy(const struct entities *to, const struct entities *from, uint32_t first,
                   uint32_t count)
{
    memcpy(to->row + first, from->row + first, count * sizeof *to->row);
}

void entities_clear(const struct entities *entities, uint32_t row)
{
    entities->row[row] = (struct entity){0};
}

uint32_t entities_find(const struct entities *entities, uint32_t used, uint32_t id)
{
    for (uint32_t i = 0; i < used && id != 0; i++) {
        if (entities->row[i].id == id && entities->row[i].state != ENTITY_FREE)
            return i;
    }
    return SLOT_NONE;
}
