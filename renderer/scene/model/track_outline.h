/* The outline of a track: the convex hull of its side view, along which the links run. Pure. */
#ifndef JOLON_RENDERER_SCENE_MODEL_TRACK_OUTLINE_H
#define JOLON_RENDERER_SCENE_MODEL_TRACK_OUTLINE_H

#include <stdint.h>

struct world;

#define TRACK_OUTLINE_LINK_M 0.22 /* approximate; the outline has a whole number of links */

struct track_outline {
    float (*corner)[2]; /* [count] x, y, counter-clockwise; owned */
    float *along; /* [count + 1] distance of each corner along the outline, then the total [m];
                     owned */
    uint32_t count;
    float link_m; /* 0: the outline is empty */
};

/* Computes the outline of a joint of a model. Returns 0, or -1 with errno ENOMEM. */
int track_outline_find(struct track_outline *outline, const struct world *world, uint32_t model,
                       uint32_t joint);
void track_outline_free(struct track_outline *outline);

/* Returns the position along the outline [links] of its point nearest to the place, within half a
 * turn of `near` [links]. */
float track_outline_along(const struct track_outline *outline, const float place[3], float near);

#endif
