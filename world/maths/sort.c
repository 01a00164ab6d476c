/* An in-place radix sort, byte by byte from the highest ("American flag sort", McIlroy, Bostic and
 * McIlroy 1993), with an insertion sort for small buckets. */
#include "world/maths/sort.h"

#include <string.h>

#define FEW     32u /* at most so many records are sorted by insertion */
#define BUCKETS 256u

/* The caller's records have a type of their own. */
struct __attribute__((may_alias)) record {
    uint32_t first, second;
};

static uint64_t key_of(const struct record *record)
{
    return (uint64_t)record->first << 32 | record->second;
}

static void sort_few(struct record *record, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        struct record one = record[i];
        uint64_t key = key_of(&one);
        uint32_t at = i;
        for (; at > 0 && key_of(&record[at - 1]) > key; at--)
            record[at] = record[at - 1];
        record[at] = one;
    }
}

static uint32_t bucket_of(const struct record *record, uint32_t shift)
{
    return (uint32_t)(key_of(record) >> shift) & (BUCKETS - 1);
}

/* The highest byte in which the records differ, as a shift; they must not all be equal. */
static uint32_t shift_of(uint64_t differs)
{
    return (63u - (uint32_t)__builtin_clzll(differs)) / 8 * 8;
}

/* The bits in which any two of the records differ. */
static uint64_t differing(const struct record *record, uint32_t count)
{
    uint64_t first = key_of(record), differs = 0;
    for (uint32_t i = 1; i < count; i++)
        differs |= key_of(&record[i]) ^ first;
    return differs;
}

/* Moves every record into the bucket of its byte; end[b] is where bucket b ends. */
static void distribute(struct record *record, uint32_t count, uint32_t shift, uint32_t *end)
{
    uint32_t next[BUCKETS], begin = 0;
    memset(end, 0, BUCKETS * sizeof *end);
    for (uint32_t i = 0; i < count; i++)
        end[bucket_of(&record[i], shift)]++;
    for (uint32_t b = 0; b < BUCKETS; b++) {
        next[b] = begin;
        begin = end[b] += begin;
    }
    for (uint32_t b = 0; b < BUCKETS; b++) {
        while (next[b] < end[b]) {
            struct record one = record[next[b]];
            for (uint32_t to = bucket_of(&one, shift); to != b; to = bucket_of(&one, shift)) {
                struct record other = record[next[to]];
                record[next[to]++] = one;
                one = other;
            }
            record[next[b]++] = one;
        }
    }
}

/* Each level looks at a lower byte than the one before: there are at most eight. */
static void sort_bytes(struct record *record, uint32_t count)
{
    uint32_t end[BUCKETS], begin = 0;
    if (count <= FEW) {
        sort_few(record, count);
        return;
    }
    uint64_t differs = differing(record, count);
    if (differs == 0)
        return;
    distribute(record, count, shift_of(differs), end);
    for (uint32_t b = 0; b < BUCKETS; b++) {
        sort_bytes(record + begin, end[b] - begin);
        begin = end[b];
    }
}

void sort_words(void *records, uint32_t count)
{
    sort_bytes(records, count);
}
