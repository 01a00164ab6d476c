/* Bodies on the ground, a lane each: the height under the middle, and pitch and roll by the heights
 * under nose, tail and sides. */
#ifndef JOLON_MOVER_STAND_H
#define JOLON_MOVER_STAND_H

#include "mover/move.h"
#include "world/footing.h"

/* Whose patch is asked for while a row takes its lane; there are so many more patches than rows. */
#define STAND_AHEAD 16u

struct stand {
    struct footing ground;
    struct footing_patch idle;           /* of lanes that are nobody's yet */
    union lanes x, z, sine, cosine;      /* of the heading */
    union lanes half_length, half_width; /* of the kind [m] */
    uint16_t kind[LANE_COUNT];           /* whose they are; KIND_NONE: nobody's yet */
    union lane_masks scarred;            /* there may be craters under it */
    union lanes y, pitch, roll;          /* what comes out */
};

/* No lane is anybody's yet. */
void stand_begin(struct stand *stand);

/* Lane l is row i's, where the row is now; its heading is the caller's to say, and its scars. True
 * when the lane was another kind's: what it holds of the kind stays from one row to the next. */
bool stand_take(const struct move *move, struct stand *stand, int l, uint32_t i);

void stand_pose(const struct move *move, struct stand *stand);

#endif
