/* A world as small as detection needs: kinds, level ground at 0 m, fixed objects and ways of bodies
 * as the test draws them. Nothing of it moves by itself. For tests that go through very many. */
#ifndef JOLON_TESTS_SUPPORT_SMALL_WORLD_H
#define JOLON_TESTS_SUPPORT_SMALL_WORLD_H

#include "collider/motion/pair_filter.h"
#include "world/entity/kind.h"
#include "world/world.h"

#include <stdint.h>

/* Small to huge on land, an aircraft, a munition, and what stands. */
enum small_kind {
    SMALL_GRAIN,
    SMALL_CAR,
    SMALL_TANK,
    SMALL_SHIP,
    SMALL_GIANT,
    SMALL_JET,
    SMALL_ROUND,
    SMALL_TREE,
    SMALL_KINDS
};

struct small_world {
    struct params *params; /* 60 Hz, spheres, threshold height 60 m */
    struct kind kinds[SMALL_KINDS];
    struct fixed_object *fixed;
    uint8_t *damage; /* of the fixed */
    float posts[4];
    uint8_t cover[4];
    uint32_t *reach_start, *reach;
    void *memory;
    struct entities e;
    struct path *path;
    uint32_t rows, fixed_most;
    struct world world;
};

/* Room for rows and fixed objects, none there yet. */
void small_world_begin(struct small_world *w, uint32_t rows, uint32_t fixed);
void small_world_end(struct small_world *w);

/* Takes away all rows and fixed objects. */
void small_world_empty(struct small_world *w);

/* Adds a row that goes from at along a whole frame; its columns have it at the end. Its id is row +
 * 1, it is active, a round in flight. */
uint32_t small_world_row(struct small_world *w, enum small_kind kind, struct vec3 at,
                         struct vec3 along);

/* Moves a row. */
void small_world_move(struct small_world *w, uint32_t row, struct vec3 at, struct vec3 along);

/* Adds a fixed object; its index. */
uint32_t small_world_tree(struct small_world *w, struct vec3 at, double radius_m);

/* Builds the squares' reach, for those who ask for it. */
void small_world_reach(struct small_world *w);

struct method_input small_world_input(const struct small_world *w);

#endif
