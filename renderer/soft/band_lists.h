/* For each band of the picture the list of items that touch it. */
#ifndef JOLON_RENDERER_SOFT_BAND_LISTS_H
#define JOLON_RENDERER_SOFT_BAND_LISTS_H

#include "renderer/soft/soft_internal.h"

#include <stddef.h>
#include <stdint.h>

struct band_rows {
    int16_t first, end; /* rows first .. end - 1 of the picture; first < end */
};

struct band_lists {
    uint32_t
        *item; /* owned; band b has item[start[b]] .. item[start[b + 1] - 1], in rising order */
    size_t room;
    uint32_t start[SOFT_BANDS_MAX + 1];
};

/* Sorts items into the bands by the rows that each touches. Returns 0, or -1 with errno ENOMEM. */
int band_lists_sort(struct band_lists *lists, const struct band_rows *rows, uint32_t count,
                    uint32_t bands);
void band_lists_free(struct band_lists *lists);

/* Enlarges an array to hold count elements of a size [byte] and keeps its content. Returns 0, or -1
 * with errno ENOMEM. */
int band_lists_reserve(void **list, size_t *room, size_t count, size_t size);

#endif
