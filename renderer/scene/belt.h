/* The belt of a track: the convex line around it, seen from the side, along which its links run.
 * Pure. */
#ifndef JOLON_RENDERER_BELT_H
#define JOLON_RENDERER_BELT_H

#include "world/world.h"

#include <stdint.h>

#define BELT_LINK_M 0.22 /* about; a whole number of them goes around */

struct belt {
    float (*corner)[2]; /* [count] x, y, counter-clockwise; owned */
    float *along;       /* [count + 1] way to each corner, then all around [m]; owned */
    uint32_t count;
    float link_m; /* 0: nothing to run along */
};

/* Of one joint of a model. 0, or -1 with errno ENOMEM. */
int belt_find(struct belt *belt, const struct world *world, uint32_t model, uint32_t joint);
void belt_free(struct belt *belt);

/* [links] along the belt to the point of it nearest to the place; near: within half the way around
 * of that many links. */
float belt_along(const struct belt *belt, const float place[3], float near);

#endif
