/* A list, and where each row is in it. */
#include "collider/parting/parting_rows.h"

#include "world/maths/sort.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

int parting_rows_init(struct parting_rows *rows, const struct world *world)
{
    uint32_t capacity = world->params->capacity;
    *rows = (struct parting_rows){.pair_capacity = pair_filter_pairs_first(world)};
    rows->row = reserve_take(capacity, sizeof *rows->row);
    rows->place = calloc(capacity, sizeof *rows->place);
    if (pair_list_init(&rows->list, rows->pair_capacity) == 0 && rows->row && rows->place)
        return 0;
    parting_rows_free(rows);
    errno = ENOMEM;
    return -1;
}

void parting_rows_free(struct parting_rows *rows)
{
    pair_list_free(&rows->list);
    reserve_free(rows->row);
    free(rows->place);
    *rows = (struct parting_rows){.count = 0};
}

bool parting_rows_add(struct parting_rows *rows, uint32_t row)
{
    if (rows->place[row] != 0)
        return false;
    rows->row[rows->count++] = row;
    rows->place[row] = rows->count;
    return true;
}

void parting_rows_forget(struct parting_rows *rows)
{
    for (uint32_t i = 0; i < rows->count; i++)
        rows->place[rows->row[i]] = 0;
    rows->count = rows->list.count = 0;
}

void *parting_rows_sort(struct parting_rows *rows, void *of_pairs, size_t size)
{
    sort_words(rows->list.pair, rows->list.count);
    if (rows->list.count <= rows->pair_capacity)
        return of_pairs;
    rows->pair_capacity = 2 * (uint64_t)rows->list.count;
    return reserve_grow(of_pairs, 0, rows->pair_capacity, size);
}
