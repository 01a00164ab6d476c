/* Bins: what each strip of gridsquares holds in this frame, as 16-byte records. A strip is a row of
 * 400 squares, 125 m from north to south and the world's 50 km from west to east.
 *
 * Every worker fills bins of its own, so that none waits; a strip is the sum of its workers' bins.
 * Records lie in chunks of 1 KB that are taken one after the other and kept from frame to frame, so
 * the memory follows the bodies. */
#ifndef JOLON_COLLIDER_BINS_H
#define JOLON_COLLIDER_BINS_H

#include "collider/detect.h"
#include "world/entity.h"
#include "world/square.h"

#include <stdbool.h>
#include <stdint.h>

#define STRIP_COUNT SQUARE_PER_SIDE

/* A record's tag: a row, or a fixed object, and what is asked so often that it must be at hand. */
#define BIN_ROW    (CAPACITY_MAX - 1u)
#define BIN_RESTS  0x00100000u /* its way has no length */
#define BIN_ROUND  0x00200000u /* a munition: detect_apart decides */
#define BIN_AIR    0x00400000u /* an aircraft: detect_tests_fixed decides */
#define BIN_LONG   0x00800000u /* a long way: narrower in each strip than its box is */
#define BIN_OBJECT 0x7fffffffu /* of a fixed object's tag: its index */
#define BIN_SPANS  0x80000000u /* in several strips */

/* A box in one strip, in whole steps of 1/512 m: x from the world's west edge, z from the strip's
 * north edge and cut off at the strip's edges. A bound is rounded down on both sides, which keeps
 * the order of any two and so every overlap. */
struct bin_record {
    int32_t min_x, max_x; /* 0 .. BIN_X_LAST */
    uint32_t z;           /* low | high << 16 */
    uint32_t tag;
};

#define BIN_STEPS_PER_M 512
#define BIN_X_BITS      25 /* 65 km */
#define BIN_X_LAST      ((1 << BIN_X_BITS) - 2)
#define BIN_Z_LAST      65535

_Static_assert(sizeof(struct bin_record) == 16, "four to a cache line");

#define BIN_CHUNK_BYTES   1024u
#define BIN_CHUNK_RECORDS (BIN_CHUNK_BYTES / sizeof(struct bin_record) - 1)

struct bin_chunk {
    struct bin_chunk *before; /* of the same strip, full; NULL: the first */
    uint64_t reserved;
    struct bin_record record[BIN_CHUNK_RECORDS];
};

_Static_assert(sizeof(struct bin_chunk) == BIN_CHUNK_BYTES, "chunks fill their slab");

struct bin_slab {
    struct bin_chunk *chunk; /* [chunks] */
    uint32_t chunks;
};

/* One worker's bins. */
struct bins {
    struct bin_record *next[STRIP_COUNT]; /* where the next record goes; on a multiple of
                                             BIN_CHUNK_BYTES there is no room for it */
    struct bin_slab *slab;                /* [slabs] kept from frame to frame */
    uint32_t slabs, slab_now, chunk_now;  /* where the next chunk comes from */
};

/* bins must be zero at first. Empties the bins and keeps their memory. */
void bins_clear(struct bins *bins);
void bins_free(struct bins *bins);

/* A new chunk for the strip: where its first record goes, NULL with errno ENOMEM. */
struct bin_record *bins_chunk(struct bins *bins, uint32_t strip);

/* 0, or -1 with errno ENOMEM. */
static inline int bins_add(struct bins *bins, uint32_t strip, struct bin_record record)
{
    struct bin_record *at = bins->next[strip];
    if (((uintptr_t)at & (BIN_CHUNK_BYTES - 1)) == 0) {
        at = bins_chunk(bins, strip);
        if (!at)
            return -1;
    }
    *at = record;
    bins->next[strip] = at + 1;
    return 0;
}

/* The strip's newest chunk and how many records it holds; those before it are full. NULL: none. */
static inline const struct bin_chunk *bins_last(const struct bins *bins, uint32_t strip,
                                                uint32_t *count)
{
    const struct bin_record *next = bins->next[strip];
    if (!next)
        return NULL;
    uintptr_t base = ((uintptr_t)next - 1) / BIN_CHUNK_BYTES * BIN_CHUNK_BYTES;
    const struct bin_chunk *chunk = (const struct bin_chunk *)base;
    *count = (uint32_t)(next - chunk->record);
    return chunk;
}

static inline float bin_clamp(float value, float last)
{
    value = value > 0.0f ? value : 0.0f; /* not a number gives 0 */
    return value < last ? value : last;
}

/* The strip of z [m]; what lies outside the world is in its first or last. Ascends with z. */
static inline uint32_t bin_strip(float z)
{
    return (uint32_t)(int32_t)bin_clamp(z * (float)(1.0 / SQUARE_SIDE_M), STRIP_COUNT - 1);
}

/* x, or z within a strip, in steps. Ascend with x and z. */
static inline int32_t bin_x(float x)
{
    return (int32_t)bin_clamp(x * BIN_STEPS_PER_M, BIN_X_LAST);
}

static inline float bin_depth(float z, int32_t strip)
{
    float edge = (float)strip * (float)(SQUARE_SIDE_M * BIN_STEPS_PER_M);
    return bin_clamp(z * BIN_STEPS_PER_M - edge, BIN_Z_LAST);
}

static inline uint32_t bin_z(float min_z, float max_z, uint32_t strip)
{
    return (uint32_t)(int32_t)bin_depth(min_z, (int32_t)strip) |
           (uint32_t)(int32_t)bin_depth(max_z, (int32_t)strip) << 16;
}

static inline bool bin_meet(const struct bin_record *p, const struct bin_record *q)
{
    return p->min_x <= q->max_x && q->min_x <= p->max_x && (p->z & 0xffffu) <= q->z >> 16 &&
           (q->z & 0xffffu) <= p->z >> 16;
}

#endif
