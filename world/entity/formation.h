/* Formations: vehicles that keep their places behind a leader. */
#ifndef JOLON_WORLD_ENTITY_FORMATION_H
#define JOLON_WORLD_ENTITY_FORMATION_H

#include <stdint.h>

enum formation_shape {
    FORMATION_COLUMN,        /* one behind the other */
    FORMATION_LINE,          /* side by side, alternately to the right and left of the leader */
    FORMATION_WEDGE,         /* alternately behind to the right and left */
    FORMATION_ECHELON_LEFT,  /* each behind the one before it, to its left */
    FORMATION_ECHELON_RIGHT, /* each behind the one before it, to its right */
    FORMATION_SHAPE_COUNT
};

/* Initial vehicles in consecutive slots: first .. first + count - 1. The first leads; the others'
 * order is BEHAVIOUR_FOLLOW, with the formation as its argument. */
struct formation {
    uint32_t first, count;
    uint32_t shape;            /* enum formation_shape */
    uint32_t order, order_arg; /* the leader's own; the next leader takes them over */
    uint32_t reserved;
    double spacing_m; /* from one to the next */
};

_Static_assert(sizeof(struct formation) == 32, "shared layout");

/* Returns the place of a member (0: the leader, at 0, 0) in the leader's axes [m]. */
void formation_place(enum formation_shape shape, double spacing_m, uint32_t member, double *ahead_m,
                     double *right_m);

#endif
