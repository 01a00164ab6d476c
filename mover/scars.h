/* Where craters are and where objects fell, by gridsquare: most bodies are near neither, and one
 * look tells. A cache of the committed world, which the mover keeps for itself; made anew from it
 * after a start, and when the world is another one's past. */
#ifndef JOLON_MOVER_SCARS_H
#define JOLON_MOVER_SCARS_H

#include "world/lanes.h"
#include "world/square.h"
#include "world/world.h"

#define SCARS_DEBRIS 1u /* what is left of a fixed object reaches into the square */
#define SCARS_CRATER 2u /* a crater is in it, or within SCARS_NEAR_M of it */

#define SCARS_BITS 2u

/* How far from a place in the square one may look for craters [m]. */
#define SCARS_NEAR_M 24.0

struct scars {
    uint64_t square[SQUARE_COUNT * SCARS_BITS / 64]; /* SCARS_..., packed to stay in a cache */
    uint8_t *damage;                                 /* [counts.fixed] as of the last update */
    uint32_t craters;
    bool any; /* square has a bit set */
};

/* 0, or -1 with errno ENOMEM. */
int scars_init(struct scars *scars, const struct world *world);
void scars_free(struct scars *scars);

/* Takes in what the committed world has more. */
void scars_update(struct scars *scars, const struct world *world, const struct state *committed);

static inline uint8_t scars_of(const struct scars *scars, uint32_t square)
{
    uint32_t bit = square * SCARS_BITS;
    return (uint8_t)(scars->square[bit / 64] >> bit % 64 & (SCARS_DEBRIS | SCARS_CRATER));
}

static inline uint8_t scars_at(const struct scars *scars, double x, double z)
{
    return scars_of(scars, square_of(x, z));
}

/* Which of eight places have which of them. */
void scars_find(const struct scars *scars, const union lanes *x, const union lanes *z,
                union lane_masks *crater, union lane_masks *debris);

#endif
