/* Sorting of items into the bands of a picture, and arrays that grow. */
#include "renderer/soft/band_lists.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

int band_lists_reserve(void **list, size_t *room, size_t count, size_t size)
{
    if (count <= *room)
        return 0;
    size_t capacity = count + count / 2;
    /* aligned_alloc() needs a multiple of the alignment. */
    size_t bytes = (capacity * size + SOFT_ALIGN - 1) / SOFT_ALIGN * SOFT_ALIGN;
    void *grown = aligned_alloc(SOFT_ALIGN, bytes);
    if (grown == NULL) {
        errno = ENOMEM;
        return -1;
    }
    if (*room > 0)
        memcpy(grown, *list, *room * size);
    free(*list);
    *list = grown;
    *room = capacity;
    return 0;
}

int band_lists_sort(struct band_lists *lists, const struct band_rows *rows, uint32_t count,
                    uint32_t bands)
{
    uint32_t *start = lists->start, next[SOFT_BANDS_MAX];
    memset(start, 0, (bands + 1) * sizeof *start);
    for (uint32_t i = 0; i < count; i++)
        for (int32_t b = rows[i].first / SOFT_BAND_ROWS; b <= (rows[i].end - 1) / SOFT_BAND_ROWS;
             b++)
            start[b + 1]++;
    for (uint32_t b = 0; b < bands; b++) {
        start[b + 1] += start[b];
        next[b] = start[b];
    }
    void *item = lists->item;
    if (band_lists_reserve(&item, &lists->room, start[bands], sizeof *lists->item) != 0)
        return -1;
    lists->item = item;
    for (uint32_t i = 0; i < count; i++)
        for (int32_t b = rows[i].first / SOFT_BAND_ROWS; b <= (rows[i].end - 1) / SOFT_BAND_ROWS;
             b++)
            lists->item[next[b]++] = i;
    return 0;
}

void band_lists_free(struct band_lists *lists)
{
    free(lists->item);
    *lists = (struct band_lists){.item = NULL};
}
