/* Lists of what touches each band of the picture. */
#ifndef JOLON_RENDERER_SOFT_BAND_LISTS_H
#define JOLON_RENDERER_SOFT_BAND_LISTS_H

#include "renderer/soft/soft_internal.h"

#include <stddef.h>
#include <stdint.h>

struct band_rows {
    int16_t first, end; /* rows of the picture, within it; first < end */
};

struct band_lists {
    uint32_t *item; /* owned; of band b: item[start[b]] .. item[start[b + 1] - 1], rising */
    size_t room;
    uint32_t start[SOFT_BANDS_MAX + 1];
};

/* Sorts count items, whose rows are given, into the bands. 0, or -1 with errno ENOMEM. */
int band_lists_sort(struct band_lists *lists, const struct band_rows *rows, uint32_t count,
                    uint32_t bands);
void band_lists_free(struct band_lists *lists);

/* Makes room for count things of a size; what was there is kept. 0, or -1 with errno ENOMEM. */
int band_lists_room(void **list, size_t *room, size_t count, size_t size);

#endif
