/* Bins: the contents of each strip of the map in this frame, as 16-byte records. A strip reaches
 * from the west edge of the world to the east. It is 125 m deep in a world of up to 50 km, and in
 * larger ones 250 m, 500 m and so on, so that a world has STRIP_COUNT strips at most.
 *
 * Every worker fills bins of its own, so that no worker waits; a strip is the sum of its workers'
 * bins. Records lie in chunks of 1 KB, taken one after the other, so that the memory in use follows
 * the number of bodies. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_STRIP_BINS_H
#define JOLON_COLLIDER_BROAD_PHASE_STRIP_BINS_H

#include "collider/motion/pair_filter.h"
#include "world/entity/entity.h"
#include "world/terrain/gridsquare.h"

#include <stdbool.h>
#include <stdint.h>

#define STRIP_COUNT   400u
#define STRIP_LEAST_M 125.0 /* depth */

/* A record's tag: the row or the fixed object, and the bits that comparisons need. */
#define BIN_ROW   (CAPACITY_MAX - 1u)
#define BIN_RESTS 0x00100000u /* its path has no length */
#define BIN_ROUND 0x00200000u /* a munition: pair_never_meets must be asked */
#define BIN_AIR                                                                                    \
    0x00400000u /* an aircraft, or a remote munition: pair_filter_tests_fixed must be asked */
#define BIN_LONG   0x00800000u /* a long path: in each strip it is narrower than its box */
#define BIN_WIDE   0x01000000u /* wider than BIN_WIDE_STEPS, or long */
#define BIN_REMOTE 0x02000000u /* a remote entity: no other one meets it */
#define BIN_OBJECT 0x7fffffffu /* of a fixed object's tag: its index */
#define BIN_SPANS  0x80000000u /* the body is in several strips */

/* A box within one strip, in whole steps of 1/512 m in a world of up to 50 km, and of 1/256 m,
 * 1/128 m and so on in larger ones: x from the world's west edge, z from the strip's north edge and
 * clipped to the strip. All bounds are rounded down, which keeps the order of any two bounds and so
 * every overlap. */
struct bin_record {
    int32_t min_x,
        max_x;  /* Computes the half-planes that bound an outline, widened by the slack. */
    uint32_t z; /* low | high << 16 */
    uint32_t tag;
};

#define BIN_STEPS_PER_M 512      /* at most */
#define BIN_STRIP_STEPS 64000    /* the depth of a strip */
#define BIN_LAST        25599998 /* the last one within the world that a float can hold */
#define BIN_BITS        25       /* bits of any number of steps */
#define BIN_WIDE_STEPS  (16 * BIN_STEPS_PER_M)

_Static_assert(BIN_STRIP_STEPS == (int)STRIP_LEAST_M * BIN_STEPS_PER_M, "a strip's depth");
_Static_assert(BIN_LAST / BIN_STRIP_STEPS == STRIP_COUNT - 1, "all of the world, no strip more");

_Static_assert(sizeof(struct bin_record) == 16, "four to a cache line");

#define BIN_CHUNK_BYTES   1024u
#define BIN_CHUNK_RECORDS (BIN_CHUNK_BYTES / sizeof(struct bin_record) - 1)

struct bin_chunk {
    /* The two full chunks of the same strip before this one; NULL: none. */
    struct bin_chunk *before, *before_that;
    struct bin_record record[BIN_CHUNK_RECORDS];
};

_Static_assert(sizeof(struct bin_chunk) == BIN_CHUNK_BYTES, "chunks lie on borders of their size");

#define BIN_SLABS        24 /* the first of one chunk; room for CAPACITY_MAX rows in all strips */
#define BIN_STRIPS_A_ROW 8u

/* One worker's bins. */
struct strip_bins {
    struct bin_record *next[STRIP_COUNT]; /* where the next record goes; at a multiple of
                                             BIN_CHUNK_BYTES the chunk is full */
    /* Chunks lie in slabs that are kept from frame to frame; slab i has first << i chunks. When a
     * frame needs more, another slab is added. Nothing moves, since chunks point at each other. */
    struct bin_chunk *slab[BIN_SLABS]; /* NULL: no frame has needed it yet */
    uint32_t first;
    uint32_t at, chunks; /* the slab in use, and how many of its chunks this frame has taken */
};

/* Reserves chunks for this many rows in BIN_STRIPS_A_ROW strips each. Returns 0, or -1 with errno
 * ENOMEM. */
int strip_bins_init(struct strip_bins *bins, uint32_t rows);
void strip_bins_free(struct strip_bins *bins);

/* Takes the memory of the chunks for this many rows, spread over the map, before a step needs it.
 */
void strip_bins_touch(const struct strip_bins *bins, uint32_t rows);

/* Empties the bins and keeps their memory. */
void strip_bins_clear(struct strip_bins *bins);

/* Gives the strip a new chunk and returns the place of its first record. If the kernel refuses
 * memory for another slab, the process ends. */
struct bin_record *strip_bins_chunk(struct strip_bins *bins, uint32_t strip);

static inline void strip_bins_add(struct strip_bins *bins, uint32_t strip, struct bin_record record)
{
    struct bin_record *at = bins->next[strip];
    if (((uintptr_t)at & (BIN_CHUNK_BYTES - 1)) == 0)
        at = strip_bins_chunk(bins, strip);
    *at = record;
    bins->next[strip] = at + 1;
}

/* Returns the strip's newest chunk and how many records it holds; those before it are full. NULL:
 * none. */
static inline const struct bin_chunk *strip_bins_last(const struct strip_bins *bins, uint32_t strip,
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

/* Returns how many steps a metre has in a world of this side: a power of two. */
static inline float bin_steps_per_m(double world_m)
{
    float steps = BIN_STEPS_PER_M;
    while (world_m * (double)steps > (double)STRIP_COUNT * BIN_STRIP_STEPS)
        steps *= 0.5f;
    return steps;
}

/* Returns metres as steps, still a float, clamped to the strips. Monotonic. */
static inline float bin_scaled(float steps_per_m, float metres)
{
    float steps = metres * steps_per_m;
    steps = steps > 0.0f ? steps : 0.0f; /* NaN becomes 0 */
    return steps < (float)BIN_LAST ? steps : (float)BIN_LAST;
}

static inline int32_t bin_steps(float steps_per_m, float metres)
{
    return (int32_t)bin_scaled(steps_per_m, metres);
}

static inline uint32_t bin_strip(float steps_per_m, float z)
{
    return (uint32_t)bin_steps(steps_per_m, z) / BIN_STRIP_STEPS;
}

/* Returns a record's z within the strip. */
static inline uint32_t bin_z(float steps_per_m, float min_z, float max_z, uint32_t strip)
{
    int32_t edge = (int32_t)strip * BIN_STRIP_STEPS;
    int32_t low = bin_steps(steps_per_m, min_z) - edge;
    int32_t high = bin_steps(steps_per_m, max_z) - edge;
    low = low > 0 ? low : 0;
    high = high < BIN_STRIP_STEPS ? high : BIN_STRIP_STEPS;
    return (uint32_t)low | (uint32_t)high << 16;
}

/* Returns true if the boxes overlap. Without branches, which could not be predicted for unsorted
 * records. */
static inline bool bin_meet(const struct bin_record *p, const struct bin_record *q)
{
    return (p->min_x <= q->max_x) & (q->min_x <= p->max_x) & ((p->z & 0xffffu) <= q->z >> 16) &
           ((q->z & 0xffffu) <= p->z >> 16);
}

#endif
