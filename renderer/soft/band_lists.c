/* Lists of what touches each band, and lists that grow. */
#include "renderer/soft/soft.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

int soft_room(void **list, size_t *room, size_t count, size_t size)
{
    if (count <= *room)
        return 0;
    size_t wanted = count + count / 2;
    /* Aligned, for rows of pixels as for records. */
    size_t bytes = (wanted * size + SOFT_ALIGN - 1) / SOFT_ALIGN * SOFT_ALIGN;
    void *grown = aligned_alloc(SOFT_ALIGN, bytes);
    if (grown == NULL) {
        errno = ENOMEM;
        return -1;
    }
    if (*room > 0)
        memcpy(grown, *list, *room * size);
    free(*list);
    *list = grown;
    *room = wanted;
    return 0;
}

int band_lists_sort(struct soft_bins *bins, const struct soft_rows *rows, uint32_t count,
                    uint32_t bands)
{
    uint32_t *start = bins->start, next[SOFT_BANDS_MAX];
    memset(start, 0, (bands + 1) * sizeof *start);
    for (uint32_t i = 0; i < count; i++)
        for (int32_t b = rows[i].first / SOFT_BAND_ROWS; b <= (rows[i].end - 1) / SOFT_BAND_ROWS;
             b++)
            start[b + 1]++;
    for (uint32_t b = 0; b < bands; b++) {
        start[b + 1] += start[b];
        next[b] = start[b];
    }
    void *item = bins->item;
    if (soft_room(&item, &bins->room, start[bands], sizeof *bins->item) != 0)
        return -1;
    bins->item = item;
    for (uint32_t i = 0; i < count; i++)
        for (int32_t b = rows[i].first / SOFT_BAND_ROWS; b <= (rows[i].end - 1) / SOFT_BAND_ROWS;
             b++)
            bins->item[next[b]++] = i;
    return 0;
}

void band_lists_free(struct soft_bins *bins)
{
    free(bins->item);
    *bins = (struct soft_bins){.item = NULL};
}
