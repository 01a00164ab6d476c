/* Near: which vehicles are near a point, from an index over the committed world's rows.
 *
 * Built anew each frame by a counting sort into square cells of the map, the living apart by force
 * and the wrecks apart from them, so that looking for enemies passes over nobody else. Within a
 * cell rows ascend. The order in which near_next() gives them follows from the world alone: not
 * from the number of threads, nor from what was asked before. Read by all threads at once. */
#ifndef JOLON_MOVER_NEAR_H
#define JOLON_MOVER_NEAR_H

#include "world/world.h"

#include <stdbool.h>
#include <stdint.h>

/* A layer for the living of each force, and one for all wrecks. Munitions are in none. */
#define NEAR_WRECKS     FORCE_COUNT
#define NEAR_LAYERS     (FORCE_COUNT + 1)
#define NEAR_LAYER(n)   (1u << (n))
#define NEAR_THE_LIVING (NEAR_LAYER(FORCE_COUNT) - 1u)
#define NEAR_ALL        (NEAR_LAYER(NEAR_LAYERS) - 1u)

struct near_entry {
    float x, z; /* [m] to 2 mm; who needs it better reads the row */
    uint32_t row;
};

struct near {
    uint32_t side;     /* cells along an edge of the map */
    double cell_m;     /* length of a cell */
    uint32_t capacity; /* of entries */
    uint32_t *start;   /* [NEAR_LAYERS * side * side + 1] into entries, by layer, row of cells */
    uint32_t *place;   /* [capacity] while it is built: the cell of a row */
    struct near_entry *entries;
    uint32_t count[NEAR_LAYERS]; /* entries of each layer */
};

/* For tables of up to capacity rows. 0, or -1 with errno ENOMEM. */
int near_init(struct near *near, uint32_t capacity);
void near_free(struct near *near);

/* Indexes rows 0 .. used - 1: active vehicles by force, wrecks. */
void near_build(struct near *near, const struct entities *committed, uint32_t used);

/* The layers of a force's enemies; neither has the neutral any nor is it one. */
static inline uint32_t near_enemies(enum force force)
{
    return force == FORCE_BLUE  ? NEAR_LAYER(FORCE_RED)
           : force == FORCE_RED ? NEAR_LAYER(FORCE_BLUE)
                                : 0u;
}

/* A walk over all vehicles of some layers within radius_m of (x, z), on the map; the one that asks
 * is met too, where its layer is asked for:
 *
 *     struct near_walk walk = near_begin(near, NEAR_ALL, x, z, 50.0);
 *     while ((entry = near_next(&walk)))
 *         ... entry->row ...
 */
struct near_walk {
    const struct near *near;
    const struct near_entry *at, *end; /* of the present row of cells */
    double x, z, square;               /* radius squared */
    int32_t x0, x1, z0, z1;            /* cells, inclusive */
    int32_t row;                       /* of cells: that comes next */
    uint32_t layer, layers;
};

struct near_walk near_begin(const struct near *near, uint32_t layers, double x, double z,
                            double radius_m);

/* The next span of entries; false at the end. */
bool near_turn(struct near_walk *walk);

/* The next one, NULL at the end. */
static inline const struct near_entry *near_next(struct near_walk *walk)
{
    do {
        for (; walk->at < walk->end; walk->at++) {
            double dx = (double)walk->at->x - walk->x, dz = (double)walk->at->z - walk->z;
            if (dx * dx + dz * dz <= walk->square)
                return walk->at++;
        }
    } while (near_turn(walk));
    return NULL;
}

#endif
