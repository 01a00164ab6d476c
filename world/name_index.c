/* Names in their order, and the search among them. */
#include "world/name_index.h"

#include "world/entity/entity.h"

#include <stdlib.h>
#include <string.h>

static int by_name(const void *a, const void *b)
{
    const struct entity_name *const *p = a, *const *q = b;
    int order = strncmp((*p)->text, (*q)->text, ENTITY_NAME_MAX);
    return order != 0 ? order : (*p > *q) - (*p < *q);
}

int name_index_init(struct callsigns *callsigns, const struct entity_name *names, uint32_t count)
{
    *callsigns = (struct callsigns){.names = names, .count = count};
    callsigns->sorted = calloc(count + 1, sizeof(void *));
    if (!callsigns->sorted)
        return -1;
    for (uint32_t i = 0; i < count; i++)
        callsigns->sorted[i] = &names[i];
    qsort(callsigns->sorted, count, sizeof(void *), by_name);
    return 0;
}

void name_index_free(struct callsigns *callsigns)
{
    free(callsigns->sorted);
    *callsigns = (struct callsigns){0};
}

int name_index_find(const struct callsigns *callsigns, const char *name, uint32_t *slot)
{
    uint32_t low = 0, high = callsigns->count;
    *slot = SLOT_NONE;
    if (name[0] == '\0')
        return 0;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (strncmp(callsigns->sorted[middle]->text, name, ENTITY_NAME_MAX) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == callsigns->count ||
        strncmp(callsigns->sorted[low]->text, name, ENTITY_NAME_MAX) != 0)
        return -1;
    *slot = (uint32_t)(callsigns->sorted[low] - callsigns->names);
    return 0;
}
