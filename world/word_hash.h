/* The hash of many words of 64 bits: WORD_HASH_BLANK and the sum of the hashes of the words, by
 * their values and their places, modulo 2^64. A word of zeros has the hash 0. So the hash of zeros
 * is known, words that are zero may be added at the end, and who changed a few words subtracts the
 * hashes that they had and adds those that they have (docs/decisions/052-written-rows.md). Pure;
 * any thread; the same on any machine. */
#ifndef JOLON_WORLD_WORD_HASH_H
#define JOLON_WORLD_WORD_HASH_H

#include <stddef.h>
#include <stdint.h>

#define WORD_HASH_BLANK UINT64_C(0x9e3779b97f4a7c15)

/* Returns the key of a place; that of the next place is more by WORD_HASH_BLANK. */
static inline uint64_t word_hash_key(uint64_t place)
{
    return (place + 1) * WORD_HASH_BLANK;
}

/* Returns the hash of a word at the place of a key: the mixer of two multiplications of
 * D. Stafford, "Better Bit Mixing - Improving on MurmurHash3's 64-bit Finalizer" (2011), variant
 * 13, with shifts of 32 bits, which vectors do at once. */
static inline uint64_t word_hash_one(uint64_t word, uint64_t key)
{
    uint64_t hash = (word ^ key) * UINT64_C(0xbf58476d1ce4e5b9);
    hash = (hash ^ hash >> 32) * UINT64_C(0x94d049bb133111eb);
    return word != 0 ? hash ^ hash >> 32 : 0;
}

/* Returns the hash of so many words. */
uint64_t word_hash(const uint64_t *words, size_t count);

/* Returns by how much the hash of many words changes if so many of them, from a place on, were
 * those before and are these now. */
uint64_t word_hash_change(const uint64_t *now, const uint64_t *before, size_t count,
                          uint64_t place);

#endif
