/* Overlaps of bodies with each other and with walls, from frame to frame. One thread. */
#ifndef JOLON_SUPERVISOR_PHYSICS_OVERLAPS_H
#define JOLON_SUPERVISOR_PHYSICS_OVERLAPS_H

#include "supervisor/physics/body_look.h"
#include "supervisor/physics/neighbour_pairs.h"

struct hull_shape;
struct world;

/* Two bodies, or a body and a wall, that were near each other in a frame. */
struct overlap {
    uint64_t key;     /* the lower id, then the other id; of a wall: the id, then its index */
    double depth_m;   /* 0: they do not overlap */
    bool touch;       /* they overlap or nearly do */
    bool since_start; /* they have overlapped since the first look at both */
    struct vec3 axis; /* the one that separated them, body axes of the first; 0: none */
};

struct overlap_list {
    struct overlap *item; /* ascending keys */
    uint32_t count, capacity;
};

struct overlaps {
    const struct world *world;
    const struct hull_shape *shape; /* of all the world's hulls */
    struct wall_grid walls;
    struct neighbour_ball *ball; /* [balls] in the order of the last frame */
    uint32_t balls;
    uint32_t *row;               /* [rows] of the last frame's balls */
    bool *listed;                /* [capacity] the row has a ball */
    struct neighbour_pairs near; /* of the kind that is being looked at */
    struct neighbour_pairs
        touching; /* this frame's pairs of bodies that touch, as indices of looks */
    struct overlap_list pairs[2], wall_pairs[2]; /* this frame's and the last frame's */
    int current;
    bool spheres; /* the scenario's bodies are spheres */
};

/* Returns 0, or -1 with errno ENOMEM. shape must outlive overlaps. */
int overlaps_make(struct overlaps *overlaps, const struct world *world,
                  const struct hull_shape *shape);
void overlaps_free(struct overlaps *overlaps);

/* Measures the overlaps at the end of a frame and marks the bodies that touch. Bodies must be
 * finite. Returns 0, or -1 with errno ENOMEM. */
int overlaps_look(struct overlaps *overlaps, struct measures *measures, struct body_looks *looks,
                  const uint8_t *fixed_damage, double dt_s);

#endif
