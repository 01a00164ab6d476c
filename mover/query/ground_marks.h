/* The gridsquares that have craters, earthworks or the debris of objects. Most bodies are near
 * neither, which one bit shows. This is the mover's own cache of the committed world. It is built
 * again after a start, and after the world has been set back to an earlier frame. */
#ifndef JOLON_MOVER_QUERY_GROUND_MARKS_H
#define JOLON_MOVER_QUERY_GROUND_MARKS_H

#include "world/maths/simd.h"
#include "world/terrain/gridsquare.h"

#include <stdbool.h>

struct state;
struct world;

#define GROUND_MARKS_DEBRIS 1u /* the debris of a fixed object reaches into the square */
#define GROUND_MARKS_CRATER                                                                        \
    2u /* a crater or an earthwork is in the square, or within GROUND_MARKS_NEAR_M of it           \
        */
#define GROUND_MARKS_BITS 2u

/* The crater bit of a position's square covers all points so near to the position [m]. */
#define GROUND_MARKS_NEAR_M 24.0

struct ground_marks {
    /* Marks, packed so that they stay in the processor's cache. */
    uint64_t *square; /* [squares.count * GROUND_MARKS_BITS / 64], rounded up */
    struct gridsquares squares;
    uint8_t *damage;  /* [counts.fixed] as of the last update */
    uint32_t craters; /* as of the last update */
    bool any;         /* some square has a mark */
};

/* 0, or -1 with errno ENOMEM. */
int ground_marks_init(struct ground_marks *marks, const struct world *world);
void ground_marks_free(struct ground_marks *marks);

/* Adds the new marks of the committed world. Serial, before the frame's queries. */
void ground_marks_update(struct ground_marks *marks, const struct world *world,
                         const struct state *committed);

static inline uint8_t ground_marks_of(const struct ground_marks *marks, uint32_t square)
{
    uint32_t bit = square * GROUND_MARKS_BITS;
    return (uint8_t)(marks->square[bit / 64] >> bit % 64 &
                     (GROUND_MARKS_DEBRIS | GROUND_MARKS_CRATER));
}

static inline uint8_t ground_marks_at(const struct ground_marks *marks, double x, double z)
{
    return ground_marks_of(marks, gridsquare_of(&marks->squares, x, z));
}

/* Returns true if a square that the box touches has one of these marks. */
bool ground_marks_within(const struct ground_marks *marks, struct gridsquare_box box, uint8_t any);

/* The marks of the squares of eight points. */
void ground_marks_find(const struct ground_marks *marks, const union simd_lanes *x,
                       const union simd_lanes *z, union lane_masks *crater,
                       union lane_masks *debris);

#endif
