/* Lists that grow as they are filled. */
#ifndef JOLON_SUPERVISOR_GROUND_GROWN_LIST_H
#define JOLON_SUPERVISOR_GROUND_GROWN_LIST_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* Returns memory with room for one more row than are used: the same, or twice as much and more, of
 * which *room then tells. NULL without memory; rows is then as it was. */
static inline void *grown_list(void *rows, uint32_t used, uint32_t *room, uint32_t more,
                               size_t row_bytes)
{
    if (used < *room)
        return rows;
    void *larger = realloc(rows, ((size_t)*room * 2 + more) * row_bytes);
    if (larger)
        *room = *room * 2 + more;
    return larger;
}

#endif
