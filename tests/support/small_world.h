/* The smallest world that collision detection accepts: kinds, level ground at 0 m, and the fixed
 * objects and paths of bodies that the test draws. Nothing moves by itself. For tests that try very
 * many worlds. */
#ifndef JOLON_TESTS_SUPPORT_SMALL_WORLD_H
#define JOLON_TESTS_SUPPORT_SMALL_WORLD_H

#include "collider/motion/pair_filter.h"
#include "world/entity/kind.h"
#include "world/world.h"

#include <stdint.h>

/* Ground vehicles from small to huge, an aircraft, a munition, and a fixed object. */
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
    uint8_t *damage; /* of the fixed objects */
    float posts[4];
    uint8_t cover[4];
    uint32_t *reach_start, *reach;
    void *memory;
    struct entities e;
    struct path *path;
    uint32_t rows, fixed_most;
    struct world world;
};

/* Allocates room for rows and fixed objects. The world is empty. */
void small_world_begin(struct small_world *w, uint32_t rows, uint32_t fixed);
void small_world_end(struct small_world *w);

/* Removes all rows and fixed objects. */
void small_world_empty(struct small_world *w);

/* Adds an active row that moves from at by along during the frame. Its columns hold the position at
 * the end of the frame. Its id is row + 1. A round is in flight. */
uint32_t small_world_row(struct small_world *w, enum small_kind kind, struct vec3 at,
                         struct vec3 along);

/* Gives a row another path. */
void small_world_move(struct small_world *w, uint32_t row, struct vec3 at, struct vec3 along);

/* Adds a fixed object and returns its index. */
uint32_t small_world_tree(struct small_world *w, struct vec3 at, double radius_m);

/* Builds the index of the fixed objects that reach into each gridsquare, for the methods that use
 * it. */
void small_world_index(struct small_world *w);

struct method_input small_world_input(const struct small_world *w);

#endif
