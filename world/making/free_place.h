/* Places where vehicles start: random points of an area on ground that suits the kind, clear of
 * other vehicles and of fixed objects within the reach of either (world/terrain/fixed_index.h). */
#ifndef JOLON_WORLD_MAKING_FREE_PLACE_H
#define JOLON_WORLD_MAKING_FREE_PLACE_H

#include "world/terrain/fixed.h"
#include "world/entity/kind.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/terrain.h"

#include <stdbool.h>
#include <stdint.h>

struct area;

/* Taken places are found by cells finer than gridsquares: with a million vehicles in one part of
 * the map a gridsquare holds thousands, and a cell at most some fifteen. */
#define FREE_PLACE_CELL_M    25.0
#define FREE_PLACE_CELLS_MAX 4000u /* along an edge; in large worlds cells are larger */

struct free_place_taken {
    double x, z, reach_m;
    uint32_t next; /* index + 1 in the same cell, 0 ends */
};

struct free_place {
    struct terrain terrain;
    const struct fixed_object *fixed;
    const struct kind *kinds; /* of the fixed objects */
    const uint32_t *reach_start, *reach;
    uint64_t seed;
    double cell_m;
    uint32_t cells; /* along an edge */
    uint32_t *head; /* [cells * cells] taken + 1 */
    struct free_place_taken *taken;
    uint32_t count, capacity;
    double largest_m; /* greatest reach taken so far */
};

/* 0, or -1 with errno ENOMEM. */
int free_place_init(struct free_place *place, const struct terrain *terrain,
                    const struct fixed_object *fixed, const struct kind *kinds,
                    const uint32_t *reach_start, const uint32_t *reach, uint64_t seed);
void free_place_free(struct free_place *place);

/* Returns true if the ground is right for the kind: water for ships, dry land for land vehicles.
 * Aircraft can be anywhere. */
bool free_place_carries(const struct terrain *terrain, const struct kind *kind, double x, double z);

/* Returns true if a vehicle of this kind may stand here. */
bool free_place_suits(const struct free_place *place, const struct kind *kind, double x, double z);

/* Finds a place for entity number slot. Returns 0, or -1 after 1,000 tries. */
int free_place_find(struct free_place *place, const struct area *area, const struct kind *kind,
                    uint32_t slot, double *x, double *z);

/* Marks a place as taken, for a body of fixed_index_of_kind() reach_m; 0, or -1 with errno ENOMEM.
 */
int free_place_take(struct free_place *place, double x, double z, double reach_m);

#endif
