/* Names in ascending order, and a binary search. */
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

int name_index_init(struct name_index *index, const struct entity_name *names, uint32_t count)
{
    *index = (struct name_index){.names = names, .count = count};
    index->sorted = calloc(count + 1, sizeof(void *));
    if (!index->sorted)
        return -1;
    for (uint32_t i = 0; i < count; i++)
        index->sorted[i] = &names[i];
    qsort(index->sorted, count, sizeof(void *), by_name);
    return 0;
}

void name_index_free(struct name_index *index)
{
    free(index->sorted);
    *index = (struct name_index){0};
}

int name_index_find(const struct name_index *index, const char *name, uint32_t *slot)
{
    uint32_t low = 0, high = index->count;
    *slot = SLOT_NONE;
    if (name[0] == '\0')
        return 0;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (strncmp(index->sorted[middle]->text, name, ENTITY_NAME_MAX) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == index->count || strncmp(index->sorted[low]->text, name, ENTITY_NAME_MAX) != 0)
        return -1;
    *slot = (uint32_t)(index->sorted[low] - index->names);
    return 0;
}
