/* Rows by words: a bit for each of 64 rows that follow each other. */
#ifndef JOLON_WORLD_ENTITY_ROW_WORDS_H
#define JOLON_WORLD_ENTITY_ROW_WORDS_H

#include <stdint.h>

/* Returns the bits of the rows of a word, whose first row is word * 64, that are below a number of
 * rows. */
static inline uint64_t row_words_below(uint32_t word, uint32_t rows)
{
    uint32_t first = word * 64;
    if (first >= rows)
        return 0;
    return UINT64_MAX >> (rows - first < 64 ? 64 - (rows - first) : 0);
}

#endif
