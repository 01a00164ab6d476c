/* Gathering: a row of cells at a time. */
#include "mover/agent/neighbour_lists.h"

#include "mover/agent/avoidance.h"

#include <stdlib.h>

#define ROOM 2u /* entries of a row of cells, over its vehicles */

int neighbour_lists_init(struct neighbour_lists *company, uint32_t capacity)
{
    *company = (struct neighbour_lists){.capacity = capacity};
    company->entries = malloc(ROOM * capacity * sizeof *company->entries);
    company->list = malloc(capacity * sizeof *company->list);
    if (company->entries && company->list)
        return 0;
    neighbour_lists_free(company);
    return -1;
}

void neighbour_lists_free(struct neighbour_lists *company)
{
    free(company->entries);
    free(company->list);
    *company = (struct neighbour_lists){0};
}

struct gathering {
    struct neighbour_lists *company;
    const struct neighbour_index *near;
    const struct world *world;
    const struct avoidance *avoid;
};

/* Whom one meets that looks as far as its kind ever does, into entries first .. end - 1; how many,
 * or NEIGHBOUR_LISTS_NONE when there may be too many. Without branches: who is near enough and
 * about as high nobody can guess. */
static uint32_t gather(const struct gathering *g, const struct neighbour_index_entry *looker,
                       uint32_t first, uint32_t end)
{
    struct neighbour_index_entry *entries = g->company->entries;
    const float *high = g->avoid->high_m;
    double radius = g->avoid->around_m[looker->kind] + AVOIDANCE_ROUNDED_M;
    float x = looker->x, z = looker->z, y = looker->y, square = (float)(radius * radius);
    float apart = high[looker->kind] + g->avoid->gap_m[looker->kind];
    struct neighbour_query walk = neighbour_index_begin(
        g->near, NEIGHBOUR_INDEX_ALL, (double)looker->x, (double)looker->z, radius);
    uint32_t at = first, self = looker->row;
    while (neighbour_index_turn(&walk)) {
        if ((size_t)(walk.end - walk.at) > end - at)
            return NEIGHBOUR_LISTS_NONE;
        for (const struct neighbour_index_entry *entry = walk.at; entry < walk.end; entry++) {
            float dx = entry->x - x, dz = entry->z - z, up = fabsf(entry->y - y);
            entries[at] = *entry;
            at += (uint32_t)((dx * dx + dz * dz <= square) & (up <= apart + high[entry->kind]) &
                             (entry->row != self));
        }
    }
    return at - first;
}

static void gather_bands(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const struct gathering *g = context;
    (void)worker;
    for (uint32_t band = begin; band < end; band++) {
        uint32_t from = g->near->band[band], past = g->near->band[band + 1];
        uint32_t first = ROOM * from;
        for (uint32_t n = from; n < past; n++) {
            const struct neighbour_index_entry *looker = &g->near->entries[n];
            if (!looker->due)
                continue;
            uint32_t count = gather(g, looker, first, ROOM * past);
            g->company->list[looker->row] = (struct neighbour_lists_list){first, count};
            first += count == NEIGHBOUR_LISTS_NONE ? 0 : count;
        }
    }
}

void neighbour_lists_gather(struct neighbour_lists *company, const struct neighbour_index *near,
                            const struct world *world, const struct avoidance *avoid,
                            struct thread_pool *workers)
{
    struct gathering gathering = {company, near, world, avoid};
    thread_pool_run(workers, gather_bands, &gathering, near->side, 1);
}
