/* The pages of all columns. */
#include "world/entity/table_touch.h"

#include "world/entity/entity.h"
#include "world/runtime/prefault.h"

#define MORE_ROWS 4096u

void table_touch(const struct entities *entities, uint32_t rows, bool writes)
{
#define X(type, name)                                                                              \
    if (writes)                                                                                    \
        prefault_shared(entities->name, rows * sizeof(type));                                      \
    else                                                                                           \
        prefault_readable(entities->name, rows * sizeof(type));
    ENTITY_COLUMNS(X)
#undef X
}

uint32_t table_touch_rows(uint32_t used, uint32_t capacity)
{
    uint64_t rows = (uint64_t)used + used / 4 + MORE_ROWS;
    return rows < capacity ? (uint32_t)rows : capacity;
}
