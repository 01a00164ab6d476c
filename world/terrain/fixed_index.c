/* Counting sort of (square, object) pairs. */
#include "world/terrain/fixed_index.h"

#include "world/terrain/gridsquare.h"

#include <stddef.h>
#include <stdlib.h>

static struct gridsquare_box box_of(const struct gridsquares *squares,
                                    const struct fixed_object *object, const struct kind *kinds)
{
    double r = fixed_index_of_fixed(object, kinds);
    return gridsquare_box_of(squares, object->x - r, object->z - r, object->x + r, object->z + r);
}

int fixed_index_build(const struct gridsquares *squares, const struct fixed_object *objects,
                      uint32_t count, const struct kind *kinds, uint32_t **start, uint32_t **items)
{
    uint32_t *first = calloc(squares->count + 1, sizeof *first);
    if (!first)
        return -1;
    for (uint32_t i = 0; i < count; i++) {
        struct gridsquare_box box = box_of(squares, &objects[i], kinds);
        for (int32_t row = box.z0; row <= box.z1; row++) {
            for (int32_t column = box.x0; column <= box.x1; column++)
                first[gridsquare_index(squares, column, row) + 1]++;
        }
    }
    for (uint32_t s = 0; s < squares->count; s++)
        first[s + 1] += first[s];
    uint32_t *list = malloc((first[squares->count] + 1) * sizeof *list);
    uint32_t *fill = calloc(squares->count + 1, sizeof *fill);
    if (!list || !fill) {
        free(first);
        free(list);
        free(fill);
        return -1;
    }
    for (uint32_t s = 0; s < squares->count; s++)
        fill[s] = first[s];
    for (uint32_t i = 0; i < count; i++) {
        struct gridsquare_box box = box_of(squares, &objects[i], kinds);
        for (int32_t row = box.z0; row <= box.z1; row++) {
            for (int32_t column = box.x0; column <= box.x1; column++)
                list[fill[gridsquare_index(squares, column, row)]++] = i;
        }
    }
    free(fill);
    *start = first;
    *items = list;
    return 0;
}
