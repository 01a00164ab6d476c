/* The sum of the hashes of words, many at a time. */
#include "world/column_hash.h"

#include "world/maths/cpu_dispatch.h"

#include <string.h>

WIDE_VECTOR_CLONES
uint64_t column_hash(const void *column, size_t bytes)
{
    const uint64_t *word = column;
    uint64_t hash = COLUMN_HASH_BLANK, rest = 0;
    size_t words = bytes / sizeof *word;
    uint64_t key = column_hash_key(0);
    for (size_t place = 0; place < words; place++, key += COLUMN_HASH_BLANK) /* no product */
        hash += column_hash_word(word[place], key);
    memcpy(&rest, word + words, bytes % sizeof *word);
    return hash + column_hash_word(rest, key);
}
