/* Near: which vehicles are near a point, from an index over the committed world's rows.
 *
 * Built anew each frame by a counting sort into square cells of the map: cell by cell, and within a
 * cell first the living by force, then the wrecks, so that looking for enemies passes over nobody
 * else and looking at everybody reads on and on. Of one sort in one cell rows ascend. The order in
 * which neighbour_query_next() gives them follows from the world alone: not from the number of
 * threads, nor from what was asked before. Read by all threads at once. */
#ifndef JOLON_MOVER_QUERY_NEIGHBOUR_INDEX_H
#define JOLON_MOVER_QUERY_NEIGHBOUR_INDEX_H

#include "world/runtime/thread_pool.h"
#include "world/world.h"

#include <stdbool.h>
#include <stdint.h>

/* A layer for the living of each force, and one for all wrecks. Munitions are in none. */
#define NEIGHBOUR_INDEX_WRECKS   FORCE_COUNT
#define NEIGHBOUR_INDEX_LAYERS   (FORCE_COUNT + 1)
#define NEIGHBOUR_INDEX_LAYER(n) (1u << (n))
#define NEIGHBOUR_INDEX_LIVING   (NEIGHBOUR_INDEX_LAYER(FORCE_COUNT) - 1u)
#define NEIGHBOUR_INDEX_ALL      (NEIGHBOUR_INDEX_LAYER(NEIGHBOUR_INDEX_LAYERS) - 1u)

#define NEIGHBOUR_INDEX_KINDS 0x7ffu
struct neighbour_index_entry {
    float x, z;      /* [m] to 2 mm; who needs it better reads the row */
    float y, vx, vz; /* [m, m/s] */
    uint32_t row : 20;
    uint32_t kind : 11;
    uint32_t due : 1; /* its agent thinks in this frame */
};

_Static_assert(CAPACITY_MAX <= 1u << 20 && KIND_COUNT_MAX <= NEIGHBOUR_INDEX_KINDS,
               "an entry holds both");

/* A step of so many frames, for neighbour_index_divides(). */
static inline uint64_t neighbour_index_divisor(uint32_t frames)
{
    return UINT64_MAX / frames + 1;
}

/* number % frames == 0 without a division (Lemire, Kaser, Kurz 2019). */
static inline bool neighbour_index_divides(uint64_t divisor, uint32_t number)
{
    return number * divisor <= divisor - 1;
}

struct neighbour_index {
    uint32_t side;      /* cells along an edge of the map */
    double cells_per_m; /* along it */
    uint32_t capacity;  /* of entries */
    uint32_t *start;    /* [side * side * NEIGHBOUR_INDEX_LAYERS + 1] into entries: by row of cells,
                           column,    layer */
    struct neighbour_index_entry *entries;
    uint32_t present; /* the layers that have an entry */
    /* While it is built: each piece of rows for itself by rows of cells, then each row of cells. */
    const struct entities *committed;
    uint32_t used, tick;
    uint64_t think_divisor;               /* neighbour_index_divisor() of a thought's frames */
    struct neighbour_index_entry *sorted; /* [capacity] */
    uint16_t *slot;   /* [capacity] of sorted: column and layer within a row of cells */
    uint32_t *first;  /* [pieces][side + 1] into a piece's part of sorted */
    uint32_t *band;   /* [side + 1] into entries: where each row of cells begins */
    uint32_t *layers; /* [side] the layers that a row of cells has */
};

/* For tables of up to capacity rows. 0, or -1 with errno ENOMEM. */
int neighbour_index_init(struct neighbour_index *index, uint32_t capacity);
void neighbour_index_free(struct neighbour_index *index);

/* Indexes rows 0 .. used - 1: active vehicles by force, wrecks; those are due whose id and tick add
 * up to a whole number of thoughts. workers may be NULL. */
void neighbour_index_build(struct neighbour_index *index, const struct entities *committed,
                           uint32_t used, uint32_t tick, uint32_t think_frames,
                           struct thread_pool *workers);

/* The layers of a force's enemies; neither has the neutral any nor is it one. */
static inline uint32_t neighbour_index_enemies(enum force force)
{
    return force == FORCE_BLUE  ? NEIGHBOUR_INDEX_LAYER(FORCE_RED)
           : force == FORCE_RED ? NEIGHBOUR_INDEX_LAYER(FORCE_BLUE)
                                : 0u;
}

/* A walk over all vehicles of some layers within radius_m of (x, z), on the map; the one that asks
 * is met too, where its layer is asked for:
 *
 *     struct neighbour_query walk = neighbour_query_begin(near, NEIGHBOUR_INDEX_ALL, x, z, 50.0);
 *     while ((entry = neighbour_query_next(&walk)))
 *         ... entry->row ...
 */
struct neighbour_query {
    const struct neighbour_index *index;
    const struct neighbour_index_entry *at, *end; /* of the present span */
    double x, z, square;                          /* radius squared */
    int32_t x0, x1, z0, z1;                       /* cells, inclusive */
    int32_t row, column;                          /* of the cell that comes next */
    bool all;                                     /* layers; else low .. high - 1 at a time */
    uint32_t low, high, left;                     /* left: layers that come after them */
};

struct neighbour_query neighbour_query_begin(const struct neighbour_index *index, uint32_t layers,
                                             double x, double z, double radius_m);

/* Is an entry within the radius of a point that is squared here? */
static inline bool neighbour_index_within(const struct neighbour_index_entry *entry, double x,
                                          double z, double square)
{
    double dx = (double)entry->x - x, dz = (double)entry->z - z;
    return dx * dx + dz * dz <= square;
}

/* The next span of entries; false at the end. */
bool neighbour_query_next_span(struct neighbour_query *query);

/* The next one, NULL at the end. */
static inline const struct neighbour_index_entry *
neighbour_query_next(struct neighbour_query *query)
{
    do {
        for (; query->at < query->end; query->at++) {
            if (neighbour_index_within(query->at, query->x, query->z, query->square))
                return query->at++;
        }
    } while (neighbour_query_next_span(query));
    return NULL;
}

#endif
