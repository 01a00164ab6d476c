/* Tables that grow while files are read. The owner of the pointer frees them. */
#ifndef JOLON_CONFIG_SYNTAX_TABLE_H
#define JOLON_CONFIG_SYNTAX_TABLE_H

#include <stdint.h>
#include <stdlib.h>

/* Adds count items of size bytes to a table of *used items. Returns the first new item, not set;
 * NULL, with the table as it was: no memory. */
static inline void *table_extend(void **table, uint32_t *used, uint32_t count, size_t size)
{
    void *larger = realloc(*table, ((size_t)*used + count) * size);

    if (larger == NULL)
        return NULL;
    *table = larger;
    *used += count;
    return (char *)larger + ((size_t)*used - count) * size;
}

#endif
