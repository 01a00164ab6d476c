/* The entity table's memory: the places of columns, and copies of rows. */
#include "world/entity/entity.h"

#include <string.h>

static size_t column_bytes(uint32_t capacity, size_t cell)
{
    return ((size_t)capacity * cell + COLUMN_ALIGN - 1) / COLUMN_ALIGN * COLUMN_ALIGN;
}

size_t entities_bytes(uint32_t capacity)
{
    size_t total = 0;
#define X(type, name) total += column_bytes(capacity, sizeof(type));
    ENTITY_COLUMNS(X)
#undef X
    return total;
}

size_t entities_row_bytes(void)
{
    size_t total = 0;
#define X(type, name) total += sizeof(type);
    ENTITY_COLUMNS(X)
#undef X
    return total;
}

/* Returns the place of a column, and goes on to that of the next one. */
static void *take_column(unsigned char **at, uint32_t capacity, size_t cell)
{
    void *column = *at;
    *at += column_bytes(capacity, cell);
    return column;
}

void entities_bind(struct entities *entities, uint32_t capacity, void *base)
{
    unsigned char *at = base;
    entities->capacity = capacity;
#define X(type, name) entities->name = take_column(&at, capacity, sizeof(type));
    ENTITY_COLUMNS(X)
#undef X
}

void entities_copy(const struct entities *to, const struct entities *from, uint32_t first,
                   uint32_t count)
{
#define X(type, name) memcpy(to->name + first, from->name + first, count * sizeof(type));
    ENTITY_COLUMNS(X)
#undef X
}

void entities_clear(const struct entities *entities, uint32_t row)
{
#define X(type, name) entities->name[row] = 0;
    ENTITY_COLUMNS(X)
#undef X
}

uint32_t entities_find(const struct entities *entities, uint32_t used, uint32_t id)
{
    for (uint32_t i = 0; i < used && id != 0; i++) {
        if (entities->id[i] == id && entities->state[i] != ENTITY_FREE)
            return i;
    }
    return SLOT_NONE;
}
