/* Where craters are and where objects fell, by gridsquare: most bodies are near neither, and one
 * look tells. A cache of the committed world, which the mover keeps for itself; made anew from it
 * after a start, and when the world is another one's past. */
#ifndef JOLON_MOVER_QUERY_GROUND_MARKS_H
#define JOLON_MOVER_QUERY_GROUND_MARKS_H

#include "world/maths/simd.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define GROUND_MARKS_DEBRIS 1u /* what is left of a fixed object reaches into the square */
#define GROUND_MARKS_CRATER 2u /* a crater is in it, or within GROUND_MARKS_NEAR_M of it */

#define GROUND_MARKS_BITS 2u

/* How far from a place in the square one may look for craters [m]. */
#define GROUND_MARKS_NEAR_M 24.0

struct ground_marks {
    uint64_t square[GRIDSQUARE_COUNT * GROUND_MARKS_BITS /
                    64]; /* SCARS_..., packed to stay in a cache */
    uint8_t *damage;     /* [counts.fixed] as of the last update */
    uint32_t craters;
    bool any; /* square has a bit set */
};

/* 0, or -1 with errno ENOMEM. */
int ground_marks_init(struct ground_marks *marks, const struct world *world);
void ground_marks_free(struct ground_marks *marks);

/* Takes in what the committed world has more. */
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
    return ground_marks_of(marks, gridsquare_of(x, z));
}

/* Returns true if a square that the box touches has one of these marks. */
bool ground_marks_within(const struct ground_marks *marks, struct gridsquare_box box, uint8_t any);

/* Which of eight places have which of them. */
void ground_marks_find(const struct ground_marks *marks, const union simd_lanes *x,
                       const union simd_lanes *z, union lane_masks *crater,
                       union lane_masks *debris);

#endif
