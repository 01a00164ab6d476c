/* Which pairs certainly stay apart until the end of a frame, so that they need no sweep. The poses
 * of a row are computed once for all of its pairs. The collider's own memory. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_PAIR_APART_H
#define JOLON_COLLIDER_NARROW_PHASE_PAIR_APART_H

#include "collider/motion/body_motion.h"
#include "collider/motion/pair_filter.h"
#include "collider/narrow_phase/separating_axis.h"

/* A row's body. */
struct row_pose {
    struct swept_body body;
    struct axis_side side; /* from path.since on, unless it turns freely */
    double spin_y;         /* [rad a frame] about the vertical, at path.since */
    double rate;           /* rotation_rate() from one to the other */
    bool freely;           /* it turns by no fixed axis, and only its sphere is tested */
};

struct pair_apart {
    const struct world *world;
    struct row_pose *row; /* [capacity of the world] */
    uint8_t *known;       /* [capacity of the world] 1: the row's path has not changed since */
};

/* Returns 0, or -1 with errno ENOMEM. */
int pair_apart_init(struct pair_apart *apart, const struct world *world);
void pair_apart_free(struct pair_apart *apart);

/* Returns true if the row's pose is not that of its present path, and takes it for known: the
 * caller has to prepare the row before anything asks for it. */
static inline bool pair_apart_claims(struct pair_apart *apart, uint32_t row)
{
    bool known = apart->known[row];
    apart->known[row] = 1;
    return !known;
}

/* Computes the row's pose from its present path. Any thread, for different rows. */
void pair_apart_prepare(struct pair_apart *apart, const struct body_motion *motion, uint32_t row);

/* The row's path has changed, or the frame is over. */
static inline void pair_apart_forget(struct pair_apart *apart, uint32_t row)
{
    apart->known[row] = 0;
}

/* Returns true if the hulls of the pair certainly stay farther apart than margin_m [m, >= 0] from
 * `time` to 1. False promises nothing. *axis may show it, and is kept for the next time (see
 * separating_axis_find). *apart_m becomes a length by which they stay apart at least. The rows must
 * be prepared. Any thread. */
bool pair_apart_stays(const struct pair_apart *apart, const struct pair *pair, double time,
                      double margin_m, bool nearest, struct vec3 *axis, double *apart_m);

#endif
