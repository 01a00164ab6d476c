/* Gathers the lists, a row of cells at a time. */
#include "mover/agent/neighbour_lists.h"

#include "mover/agent/avoidance.h"
#include "world/runtime/prefault.h"

#include <stdlib.h>

#define ROOM 2u /* times the room of a row of cells: the entries of its lists */

int neighbour_lists_init(struct neighbour_lists *lists, uint32_t capacity)
{
    *lists = (struct neighbour_lists){.capacity = capacity};
    lists->entries = malloc((size_t)ROOM * neighbour_index_room(capacity) * sizeof *lists->entries);
    lists->list = malloc(capacity * sizeof *lists->list);
    if (lists->entries && lists->list)
        return 0;
    neighbour_lists_free(lists);
    return -1;
}

void neighbour_lists_free(struct neighbour_lists *lists)
{
    free(lists->entries);
    free(lists->list);
    *lists = (struct neighbour_lists){0};
}

void neighbour_lists_touch(const struct neighbour_lists *lists, uint32_t rows)
{
    prefault_own(lists->entries, (size_t)ROOM * rows * sizeof *lists->entries);
    prefault_own(lists->list, rows * sizeof *lists->list);
}

struct gathering {
    struct neighbour_lists *lists;
    struct neighbour_index *index;
    const struct world *world;
    const struct avoidance *avoidance;
    double ahead_m;
};

/* Gathers the vehicles within the farthest look of the looker's kind into entries first .. end - 1.
 * Returns how many, or NEIGHBOUR_LISTS_NONE when there may be no room. The inner loop has no
 * branch, because the processor could not predict it. */
static uint32_t gather(const struct gathering *g, const struct neighbour_index_entry *looker,
                       uint32_t first, uint32_t end)
{
    struct neighbour_index_entry *entries = g->lists->entries;
    const float *high = g->avoidance->high_m;
    double radius = g->avoidance->around_m[looker->kind] + g->ahead_m + AVOIDANCE_ROUNDED_M;
    float x = looker->x, z = looker->z, y = looker->y, square = (float)(radius * radius);
    float apart = high[looker->kind] + g->avoidance->gap_m[looker->kind];
    struct neighbour_query query = neighbour_query_begin(
        g->index, NEIGHBOUR_INDEX_ALL, (double)looker->x, (double)looker->z, radius);
    uint32_t at = first, self = looker->row;
    while (neighbour_query_next_span(&query)) {
        if ((size_t)(query.end - query.at) > end - at)
            return NEIGHBOUR_LISTS_NONE;
        for (const struct neighbour_index_entry *entry = query.at; entry < query.end; entry++) {
            float dx = entry->x - x, dz = entry->z - z, up = fabsf(entry->y - y);
            entries[at] = *entry;
            at += (uint32_t)((dx * dx + dz * dz <= square) & (up <= apart + high[entry->kind]) &
                             (entry->row != self));
        }
    }
    return at - first;
}

static void gather_band(const struct gathering *g, uint32_t band)
{
    uint32_t from = g->index->room[band], past = from + g->index->held[band];
    uint32_t first = ROOM * from, end = ROOM * g->index->room[band + 1];
    bool decides = false;
    for (uint32_t n = from; n < past; n++) {
        decides |= g->index->agent[n] != 0;
        if (!neighbour_index_due(g->index, n))
            continue;
        const struct neighbour_index_entry *looker = &g->index->entries[n];
        uint32_t count = gather(g, looker, first, end);
        g->lists->list[looker->row] = (struct neighbour_list){first, count};
        first += count == NEIGHBOUR_LISTS_NONE ? 0 : count;
    }
    if (!decides)
        atomic_store_explicit(&g->index->decides[band], 0, memory_order_relaxed);
}

static void gather_bands(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const struct gathering *g = context;
    (void)worker;
    for (uint32_t band = begin; band < end; band++) {
        if (atomic_load_explicit(&g->index->decides[band], memory_order_relaxed))
            gather_band(g, band);
    }
}

void neighbour_lists_gather(struct neighbour_lists *lists, struct neighbour_index *index,
                            const struct world *world, const struct avoidance *avoidance,
                            double ahead_m, struct thread_pool *workers)
{
    struct gathering gathering = {lists, index, world, avoidance, ahead_m};
    workers = index->used > NEIGHBOUR_INDEX_ALONE ? workers : NULL;
    thread_pool_run(workers, gather_bands, &gathering, index->side, 1);
}
