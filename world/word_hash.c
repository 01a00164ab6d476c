/* The sum of the hashes of words, many at a time. */
#include "world/word_hash.h"

#include "world/maths/cpu_dispatch.h"

WIDE_VECTOR_CLONES
uint64_t word_hash(const uint64_t *words, size_t count)
{
    uint64_t hash = WORD_HASH_BLANK, key = word_hash_key(0);
    for (size_t place = 0; place < count; place++, key += WORD_HASH_BLANK) /* no product */
        hash += word_hash_one(words[place], key);
    return hash;
}

WIDE_VECTOR_CLONES
uint64_t word_hash_change(const uint64_t *now, const uint64_t *before, size_t count, uint64_t place)
{
    uint64_t change = 0, key = word_hash_key(place);
    for (size_t n = 0; n < count; n++, key += WORD_HASH_BLANK)
        change += word_hash_one(now[n], key) - word_hash_one(before[n], key);
    return change;
}
