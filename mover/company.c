/* Gathering: a row of cells at a time. */
#include "mover/company.h"

#include "mover/avoid.h"

#include <stdlib.h>

#define ROOM 2u /* entries of a row of cells, over its vehicles */

int company_init(struct company *company, uint32_t capacity)
{
    *company = (struct company){.capacity = capacity};
    company->entries = malloc(ROOM * capacity * sizeof *company->entries);
    company->list = malloc(capacity * sizeof *company->list);
    if (company->entries && company->list)
        return 0;
    company_free(company);
    return -1;
}

void company_free(struct company *company)
{
    free(company->entries);
    free(company->list);
    *company = (struct company){0};
}

struct gathering {
    struct company *company;
    const struct near *near;
    const struct world *world;
    const struct avoid *avoid;
};

/* Whom one meets that looks as far as its kind ever does, into entries first .. end - 1; how many,
 * or COMPANY_NONE when there may be too many. Without branches: who is near enough and about as
 * high nobody can guess. */
static uint32_t gather(const struct gathering *g, const struct near_entry *looker, uint32_t first,
                       uint32_t end)
{
    struct near_entry *entries = g->company->entries;
    const float *high = g->avoid->high_m;
    double radius = g->avoid->around_m[looker->kind] + AVOID_ROUNDED_M;
    float x = looker->x, z = looker->z, y = looker->y, square = (float)(radius * radius);
    float apart = high[looker->kind] + g->avoid->gap_m[looker->kind];
    struct near_walk walk =
        near_begin(g->near, NEAR_ALL, (double)looker->x, (double)looker->z, radius);
    uint32_t at = first, self = looker->row;
    while (near_turn(&walk)) {
        if ((size_t)(walk.end - walk.at) > end - at)
            return COMPANY_NONE;
        for (const struct near_entry *entry = walk.at; entry < walk.end; entry++) {
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
            const struct near_entry *looker = &g->near->entries[n];
            if (!looker->due)
                continue;
            uint32_t count = gather(g, looker, first, ROOM * past);
            g->company->list[looker->row] = (struct company_list){first, count};
            first += count == COMPANY_NONE ? 0 : count;
        }
    }
}

void company_gather(struct company *company, const struct near *near, const struct world *world,
                    const struct avoid *avoid, struct workers *workers)
{
    struct gathering gathering = {company, near, world, avoid};
    workers_run(workers, gather_bands, &gathering, near->side, 1);
}
