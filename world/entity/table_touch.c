/* The pages of rows. */
#include "world/entity/table_touch.h"

#include "world/entity/entity.h"
#include "world/runtime/prefault.h"

#define MORE_ROWS 4096u

void table_touch(const struct entities *entities, uint32_t rows, bool writes)
{
    if (writes)
        prefault_shared(entities->row, rows * sizeof *entities->row);
    else
        prefault_readable(entities->row, rows * sizeof *entities->row);
}

uint32_t table_touch_rows(uint32_t used, uint32_t capacity)
{
    uint64_t rows = (uint64_t)used + used / 4 + MORE_ROWS;
    return rows < capacity ? (uint32_t)rows : capacity;
}
