/* The pages of all columns. */
#include "world/entity/table_touch.h"

#include "world/entity/entity.h"
#include "world/runtime/prefault.h"

#define MORE_ROWS 4096u

static void take_pages(void *pages, size_t bytes, bool writes)
{
    if (writes)
        prefault_shared(pages, bytes);
    else
        prefault_readable(pages, bytes);
}

void table_touch(const struct entities *entities, uint32_t rows, bool writes)
{
#define X(type, name) take_pages(entities->name, rows * sizeof(type), writes);
    ENTITY_COLUMNS(X)
#undef X
}

uint32_t table_touch_rows(uint32_t used, uint32_t capacity)
{
    uint64_t rows = (uint64_t)used + used / 4 + MORE_ROWS;
    return rows < capacity ? (uint32_t)rows : capacity;
}
