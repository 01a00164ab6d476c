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

/* Poses lie one after the other in the order in which their rows came to need one. Few rows of a
 * large world do, and a place for each would touch a page of memory for each. */
struct pair_apart {
    const struct world *world;
    struct row_pose *pose; /* [capacity of the world] */
    uint32_t *place;       /* [capacity of the world] index + 1 into pose, 0: the row has none */
    uint32_t count;        /* poses of this frame */
    uint8_t *known;        /* [capacity of the world] 1: the row's path has not changed since */
};

/* Returns 0, or -1 with errno ENOMEM. */
int pair_apart_init(struct pair_apart *apart, const struct world *world);
void pair_apart_free(struct pair_apart *apart);

/* Returns true if the row's pose is not that of its present path, and takes it for known: the
 * caller has to prepare the row before anything asks for it. One thread. */
static inline bool pair_apart_claims(struct pair_apart *apart, uint32_t row)
{
    bool known = apart->known[row];
    if (apart->place[row] == 0)
        apart->place[row] = ++apart->count;
    apart->known[row] = 1;
    return !known;
}

/* Returns the pose of a row that has been prepared. */
static inline const struct row_pose *pair_apart_pose(const struct pair_apart *apart, uint32_t row)
{
    return &apart->pose[apart->place[row] - 1];
}

/* Computes the row's pose from its present path. Any thread, for different rows. */
void pair_apart_prepare(struct pair_apart *apart, const struct body_motion *motion, uint32_t row);

/* The row's path has changed. */
static inline void pair_apart_forget(struct pair_apart *apart, uint32_t row)
{
    apart->known[row] = 0;
}

/* The frame is over for the row. */
static inline void pair_apart_let_go(struct pair_apart *apart, uint32_t row)
{
    apart->known[row] = 0;
    apart->place[row] = 0;
}

/* It is over for each row that has a pose. */
static inline void pair_apart_end(struct pair_apart *apart)
{
    apart->count = 0;
}

/* Returns true if the hulls of the pair certainly stay farther apart than margin_m [m, >= 0] from
 * `time` to 1. False promises nothing. *axis may show it, and is kept for the next time (see
 * separating_axis_find). *apart_m becomes a length by which they stay apart at least. The rows must
 * be prepared. Any thread. */
bool pair_apart_stays(const struct pair_apart *apart, const struct pair *pair, double time,
                      double margin_m, bool nearest, struct vec3 *axis, double *apart_m);

#endif
