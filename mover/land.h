/* Ground vehicles, eight at a time: each fills a lane with what it wishes, then all of them move.
 * What a vehicle does depends on nothing in the other lanes. */
#ifndef JOLON_MOVER_LAND_H
#define JOLON_MOVER_LAND_H

#include "mover/stand.h"

struct land {
    int count; /* lanes taken */
    uint32_t row[LANE_COUNT];
    bool out_of_gear[LANE_COUNT];
    union lane_masks held; /* its wish is what its controls ask: turn and wanted_mps are these */
    union lane_masks driven, low_gear; /* of the wish */
    union lanes wanted_heading, wanted_mps, turn, brake;
    union lanes y, vx, vz, heading, pitch, fuel; /* of the row, before and after */
    union lanes full_mps, acceleration, turn_rate, max_slope, half_length,
        burn_lps;             /* of its kind */
    union lane_masks tank;    /* it has one */
    union lanes debris;       /* share of full speed that what fell here allows */
    union lane_masks blocked; /* what comes out: the way is: water, a slope, the world's edge */
    struct stand stand;       /* with its place */
};

/* Without anybody. */
void land_begin(struct land *land);

/* Row i, by its wish, takes a lane: true when that was the last. */
bool land_take(const struct move *move, struct land *land, uint32_t i, const struct wish *wish);

/* The same by its controls as its agent set them: what agent_hold() would wish. */
bool land_take_held(const struct move *move, struct land *land, uint32_t i);

/* Moves those who have a lane; their lanes stay taken, so that the caller can see who is blocked.
 */
void land_move(const struct move *move, struct land *land);

#endif
