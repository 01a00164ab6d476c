/* Which bodies are near each other, by sorting their boxes from west to east, and which walls are
 * near a body, by a grid. It shares no code with the collider's broad phase. One thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_NEIGHBOUR_PAIRS_H
#define JOLON_SUPERVISOR_PHYSICS_NEIGHBOUR_PAIRS_H

#include "world/maths/maths.h"

#include <stdint.h>

struct fixed_object;
struct world;

/* A body's ball. */
struct neighbour_ball {
    struct vec3 at; /* [m, world] */
    double reach_m;
    uint32_t body; /* the caller's index */
};

struct neighbour_pair {
    uint32_t a, b; /* the caller's indices */
};

struct neighbour_pairs {
    struct neighbour_pair *pair;
    uint32_t count, capacity;
};

/* Sorts the balls and lists the pairs whose cubes meet. Fast if they are nearly in order already.
 * Returns 0, or -1 with errno ENOMEM. */
int neighbour_pairs_find(struct neighbour_pairs *pairs, struct neighbour_ball *ball,
                         uint32_t count);
void neighbour_pairs_free(struct neighbour_pairs *pairs);

/* Adds a pair. Returns 0, or -1 with errno ENOMEM. */
int neighbour_pairs_add(struct neighbour_pairs *pairs, uint32_t a, uint32_t b);

/* The walls of a world: fixed objects that do not bend. */
struct wall_grid {
    uint32_t side;   /* cells along an edge of the world; 0: the world has no walls */
    uint32_t *start; /* [side * side + 1] into item */
    uint32_t *item;  /* indices of fixed objects; an object is in each cell that it reaches */
};

/* Returns 0, or -1 with errno ENOMEM. */
int wall_grid_make(struct wall_grid *grid, const struct world *world);
void wall_grid_free(struct wall_grid *grid);

/* Adds to pairs every wall whose box the ball's cube meets: b is the index of the object. Returns
 * 0, or -1 with errno ENOMEM. */
int wall_grid_find(const struct wall_grid *grid, const struct world *world,
                   const struct neighbour_ball *ball, struct neighbour_pairs *pairs);

#endif
