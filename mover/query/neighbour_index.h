/* Finds the vehicles near a point, by an index over the committed rows.
 *
 * The entries lie in square cells of the map. Within a cell the active vehicles of each force come
 * first and then the wrecks, so that a search for enemies reads only the entries of enemies, and a
 * search for all reads consecutive entries. Within a cell and a force rows ascend. The order of
 * neighbour_query_next() follows from the world alone, not from the number of threads, from earlier
 * queries or from earlier frames. All threads may query at once.
 *
 * The index is kept from frame to frame while most rows rest. Only the entries of the other rows
 * are written again; a row that enters another cell moves its entry. Else the index is built by a
 * counting sort, which reads and writes memory in its order. */
#ifndef JOLON_MOVER_QUERY_NEIGHBOUR_INDEX_H
#define JOLON_MOVER_QUERY_NEIGHBOUR_INDEX_H

#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/runtime/thread_pool.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* A layer for the active vehicles of each force, and one for all wrecks. Munitions are in none. */
#define NEIGHBOUR_INDEX_WRECKS   FORCE_COUNT
#define NEIGHBOUR_INDEX_LAYERS   (FORCE_COUNT + 1)
#define NEIGHBOUR_INDEX_LAYER(n) (1u << (n))
#define NEIGHBOUR_INDEX_LIVING   (NEIGHBOUR_INDEX_LAYER(FORCE_COUNT) - 1u)
#define NEIGHBOUR_INDEX_ALL      (NEIGHBOUR_INDEX_LAYER(NEIGHBOUR_INDEX_LAYERS) - 1u)

/* Up to this many rows one thread builds the index sooner than others would wake. */
#define NEIGHBOUR_INDEX_ALONE 2048u

#define NEIGHBOUR_INDEX_KINDS 0xfffu
struct neighbour_index_entry {
    float x, z;      /* [m] to 2 mm; the row has the exact position */
    float y, vx, vz; /* [m, m/s] */
    uint32_t row : 20;
    uint32_t kind : 12;
};

_Static_assert(CAPACITY_MAX <= 1u << 20 && KIND_COUNT_MAX <= NEIGHBOUR_INDEX_KINDS,
               "an entry holds both");

/* Returns a number of frames in the form that neighbour_index_divides() takes. */
static inline uint64_t neighbour_index_divisor(uint32_t frames)
{
    return UINT64_MAX / frames + 1;
}

/* Returns number % frames == 0 without a division (Lemire, Kaser, Kurz 2019). */
static inline bool neighbour_index_divides(uint64_t divisor, uint32_t number)
{
    return number * divisor <= divisor - 1;
}

#define NEIGHBOUR_INDEX_NO_KEY    UINT32_MAX
#define NEIGHBOUR_INDEX_SIDE_MOST 256u

struct neighbour_index {
    uint32_t side;      /* cells along an edge of the map */
    double cells_per_m; /* along an edge */
    uint32_t capacity;  /* rows */
    uint32_t stride;    /* words of start for a row of cells */
    uint32_t *start; /* [side][stride] index of entries: where each layer of each cell begins, and
                        where the row of cells ends; set only where held is not 0 */
    struct neighbour_index_entry *entries; /* each row of cells has room for some more */
    uint32_t *agent; /* beside entries: the id of an agent that decides in its turn; 0: none */
    uint32_t *room;  /* [side + 1] where the room of each row of cells begins, and the end */
    uint32_t *held;  /* [side] entries of each row of cells */
    _Atomic uint8_t decides[NEIGHBOUR_INDEX_SIDE_MOST]; /* 0: the row of cells has no agent that
                                                           decides */
    /* Entries of each layer: in each row of cells as it was built, and in all. */
    uint32_t band_count[NEIGHBOUR_INDEX_SIDE_MOST][NEIGHBOUR_INDEX_LAYERS];
    uint32_t count[NEIGHBOUR_INDEX_LAYERS];
    uint32_t present; /* the layers that have an entry */
    /* Of the rows, unless the index was built for one frame: */
    uint32_t *key;   /* [capacity] cell and layer, or NEIGHBOUR_INDEX_NO_KEY: in no cell */
    uint32_t *place; /* [capacity] index of entries */
    /* Of the frame: */
    const struct entities *committed;
    const uint64_t *resting; /* a bit for each row whose entry has not changed; NULL: none */
    const uint64_t *fresh;   /* but these rest only since the last frame; NULL: none */
    uint32_t used, tick;
    uint64_t think_divisor; /* neighbour_index_divisor() of think_frames */
    bool placed;            /* key and place are set */
    uint32_t *moved;        /* [capacity] rows that have entered another cell */
    _Atomic uint32_t moved_count;
    /* Used while the index is built: blocks of rows are sorted first, then each row of cells. */
    struct neighbour_index_entry *sorted; /* [capacity] by block and row of cells */
    uint32_t *sorted_agent;               /* [capacity] of sorted */
    uint16_t *slot;  /* [capacity] of sorted: column and layer within a row of cells */
    uint32_t *first; /* [blocks][side + 1] index of sorted: where a block's row of cells begins */
};

/* For tables of up to capacity rows. 0, or -1 with errno ENOMEM. */
int neighbour_index_init(struct neighbour_index *index, uint32_t capacity);
void neighbour_index_free(struct neighbour_index *index);

/* Takes the memory for this many rows before a step needs it. */
void neighbour_index_touch(const struct neighbour_index *index, uint32_t rows);

/* Returns how many entries the index of a table of so many rows has room for. */
uint32_t neighbour_index_room(uint32_t rows);

/* What the index is of. */
struct neighbour_index_frame {
    const struct entities *committed;
    double side_m;         /* of the world */
    uint32_t used;         /* rows */
    uint32_t tick;         /* of the frame that is made */
    uint32_t think_frames; /* from one decision of an agent to the next */
    /* Bits of the rows that rest: they have no agent that decides. NULL: no row rests. */
    const uint64_t *resting;
    const uint64_t *fresh; /* of these, those that moved in the last frame; NULL: none */
};

/* Indexes all rows. places: the index can be kept, which costs somewhat more. workers may be NULL.
 */
void neighbour_index_build(struct neighbour_index *index, const struct neighbour_index_frame *frame,
                           bool places, struct thread_pool *workers);

/* The same for the frame after the one that is indexed. The entries of rows that rest must not have
 * changed since. */
void neighbour_index_update(struct neighbour_index *index,
                            const struct neighbour_index_frame *frame, struct thread_pool *workers);

/* Notes that the row rests from now on. Any thread, each its own row. */
void neighbour_index_rests(struct neighbour_index *index, uint32_t row);

/* Returns true if entry n is of an agent that decides in this frame: tick + id is a multiple of
 * think_frames, and it does not rest. */
static inline bool neighbour_index_due(const struct neighbour_index *index, uint32_t n)
{
    return index->agent[n] != 0 &&
           neighbour_index_divides(index->think_divisor, index->tick + index->agent[n]);
}

/* Returns the layers of a force's enemies. Neutral vehicles have no enemies and are no
 * force's enemies. */
static inline uint32_t neighbour_index_enemies(enum force force)
{
    return force == FORCE_BLUE  ? NEIGHBOUR_INDEX_LAYER(FORCE_RED)
           : force == FORCE_RED ? NEIGHBOUR_INDEX_LAYER(FORCE_BLUE)
                                : 0u;
}

/* A query for all vehicles of some layers within radius_m of (x, z), which is on the map. A vehicle
 * that makes a query also finds itself if its layer is among them:
 *
 *     struct neighbour_query query = neighbour_query_begin(index, NEIGHBOUR_INDEX_ALL, x, z, 50.0);
 *     while ((entry = neighbour_query_next(&query)))
 *         ... entry->row ...
 */
struct neighbour_query {
    const struct neighbour_index *index;
    const struct neighbour_index_entry *at, *end; /* the present span */
    double x, z, square;                          /* square: of the radius */
    int32_t x0, x1, z0, z1;                       /* cells, inclusive */
    int32_t row, column;                          /* the next cell */
    bool all;                                     /* all layers at once; else low .. high - 1 */
    uint32_t low, high, left;                     /* left: the layers that follow */
};

struct neighbour_query neighbour_query_begin(const struct neighbour_index *index, uint32_t layers,
                                             double x, double z, double radius_m);

/* Returns true if an entry is within a distance of a point, given the square of the distance. */
static inline bool neighbour_index_within(const struct neighbour_index_entry *entry, double x,
                                          double z, double square)
{
    double dx = (double)entry->x - x, dz = (double)entry->z - z;
    return dx * dx + dz * dz <= square;
}

/* Advances to the next consecutive entries, at .. end. Returns false if there are none left. */
bool neighbour_query_next_span(struct neighbour_query *query);

/* Returns the next entry, or NULL if there are none left. */
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

/* Ask the processor for what a query around a place reads first: the cell, and when that has come,
 * its entries. */
void neighbour_index_prefetch_cell(const struct neighbour_index *index, double x, double z);
void neighbour_index_prefetch_entries(const struct neighbour_index *index, double x, double z);

#endif
