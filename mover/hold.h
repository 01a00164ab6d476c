/* Motion without a will. A row goes by itself; those that then stand on the ground take a lane, and
 * are set upon it together. */
#ifndef JOLON_MOVER_HOLD_H
#define JOLON_MOVER_HOLD_H

#include "mover/stand.h"

/* Row i keeps heading and speed and reacts to nothing, save that what ran into it may have set it
 * turning; a land vehicle's height is the ground's, a ship's the water's. True when it is to take a
 * lane. */
bool hold_row(const struct move *move, uint32_t i);

struct hold {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    union lanes heading;
    struct stand stand;
};

/* Without anybody. */
void hold_begin(struct hold *hold);

/* Row i takes a lane: true when that was the last. */
bool hold_take(const struct move *move, struct hold *hold, uint32_t i);

/* Sets those who have a lane on the ground; their lanes stay taken. */
void hold_pose(const struct move *move, struct hold *hold);

#endif
