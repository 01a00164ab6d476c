/* The outline of a track: the convex line around it, seen from the side, along which its links run.
 * Pure. */
#ifndef JOLON_RENDERER_SCENE_MODEL_TRACK_OUTLINE_H
#define JOLON_RENDERER_SCENE_MODEL_TRACK_OUTLINE_H

#include <stdint.h>

struct world;

#define TRACK_OUTLINE_LINK_M 0.22 /* about; a whole number of them goes around */

struct track_outline {
    float (*corner)[2]; /* [count] x, y, counter-clockwise; owned */
    float *along;       /* [count + 1] way to each corner, then all around [m]; owned */
    uint32_t count;
    float link_m; /* 0: nothing to run along */
};

/* Of one joint of a model. 0, or -1 with errno ENOMEM. */
int track_outline_find(struct track_outline *outline, const struct world *world, uint32_t model,
                       uint32_t joint);
void track_outline_free(struct track_outline *outline);

/* [links] along the outline to the point of it nearest to the place; near: within half the way
 * around of that many links. */
float track_outline_along(const struct track_outline *outline, const float place[3], float near);

#endif
