/* Avoiding: agents steer around what is in their way, slow down for it, and stop before it.
 *
 * Each agent looks in its turn to think, ten times a second or less often in a crowd, and remembers
 * what it found in the columns dodge and ease. It looks along a fan of directions about
 * the wished one, for how far each is free: of fixed objects that would hurt its kind, of other
 * vehicles as they move on (all of them know the same of each other, so two that meet head on both
 * turn right), of water or land, of slopes too steep and of the world's edge. It takes the one that
 * is free the farthest and turns the least, and no more speed than it can lose before the end. */
#ifndef JOLON_MOVER_AVOID_H
#define JOLON_MOVER_AVOID_H

#include "mover/move.h"

/* What follows from the kinds alone. */
struct avoid {
    /* Of fixed kinds [m]: how far from its middle, at the height of vehicles on the ground, it is
     * in the way: a tree's trunk, not its crown. */
    double reach_m[KIND_COUNT_MAX];
    /* Of vehicle kinds: a bit for each fixed kind that does it no harm, by the collider's measure.
     */
    uint64_t harmless[KIND_COUNT_MAX];
};

void avoid_init(struct avoid *avoid, const struct world *world);

/* Looks, if it is row i's turn, and changes what an agent wishes by what it remembers. */
void avoid_steer(const struct move *move, uint32_t i, struct wish *wish);

#endif
