/* An index of the list of dents: a hash table by body id, with a chain of dents for each body, the
 * newest first. */
#include "renderer/scene/frame/dent_index.h"

#include <stdlib.h>
#include <string.h>

#define MIN_DEPTH_M 0.004f /* shallower dents are not visible */

int dent_index_init(struct dent_index *dents, const struct dent *list, uint32_t capacity)
{
    uint32_t slots = 16;
    while (slots < 2 * capacity) /* at most half full */
        slots *= 2;
    *dents = (struct dent_index){.dent = list, .capacity = capacity, .mask = slots - 1};
    dents->older = calloc(capacity + 1, sizeof *dents->older);
    dents->newest = calloc(slots, sizeof *dents->newest);
    if (dents->older != NULL && dents->newest != NULL)
        return 0;
    dent_index_free(dents);
    return -1;
}

void dent_index_free(struct dent_index *dents)
{
    free(dents->older);
    free(dents->newest);
    *dents = (struct dent_index){.dent = NULL};
}

/* Returns the table entry of the body, which is 0 if the body has no dents. */
static uint32_t *chain(const struct dent_index *dents, uint32_t id)
{
    uint32_t slot = id * 2654435769u >> 7 & dents->mask;
    while (dents->newest[slot] != 0 && dents->dent[dents->newest[slot] - 1].id != id)
        slot = (slot + 1) & dents->mask;
    return &dents->newest[slot];
}

void dent_index_update(struct dent_index *dents, uint32_t count)
{
    if (count > dents->capacity)
        count = dents->capacity;
    if (count < dents->count) { /* the list of another world */
        memset(dents->newest, 0, (dents->mask + 1) * sizeof *dents->newest);
        dents->count = 0;
    }
    for (; dents->count < count; dents->count++) {
        uint32_t *newest = chain(dents, dents->dent[dents->count].id);
        dents->older[dents->count] = *newest;
        *newest = dents->count + 1;
    }
}

bool dent_index_any(const struct dent_index *dents, uint32_t id)
{
    return *chain(dents, id) != 0;
}

/* Inserts a dent into the deepest ones. Returns their new number. */
static uint32_t rank(struct dented of[DENT_INDEX_PER_BODY], uint32_t count,
                     const struct dented *dent)
{
    uint32_t place = count < DENT_INDEX_PER_BODY ? count : DENT_INDEX_PER_BODY;
    while (place > 0 && of[place - 1].depth_m < dent->depth_m) {
        if (place < DENT_INDEX_PER_BODY)
            of[place] = of[place - 1];
        place--;
    }
    if (place < DENT_INDEX_PER_BODY)
        of[place] = *dent;
    return count < DENT_INDEX_PER_BODY ? count + 1 : DENT_INDEX_PER_BODY;
}

uint32_t dent_index_of(const struct dent_index *dents, uint32_t id, uint64_t tick, double dt_s,
                       struct dented of[DENT_INDEX_PER_BODY])
{
    uint32_t count = 0;
    for (uint32_t next = *chain(dents, id); next != 0; next = dents->older[next - 1]) {
        const struct dent *dent = &dents->dent[next - 1];
        struct dented now = {.depth_m = dent->plastic_m};
        if (tick >= dent->tick)
            now.depth_m += (float)crush_elastic_left((double)dent->elastic_m,
                                                     (double)(tick - dent->tick) * dt_s);
        if (now.depth_m < MIN_DEPTH_M)
            continue;
        memcpy(now.point, dent->point, sizeof now.point);
        memcpy(now.direction, dent->direction, sizeof now.direction);
        count = rank(of, count, &now);
    }
    return count;
}
