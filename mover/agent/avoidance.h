/* Avoiding: agents steer around what is in their way, slow down for it, and stop before it.
 *
 * Each agent looks in its turn to think, ten times a second or less often in a crowd, and remembers
 * what it found in the columns dodge and ease. It looks along a fan of directions about
 * the wished one, for how far each is free: of fixed objects that would hurt its kind, of other
 * vehicles as they move on (all of them know the same of each other, so two that meet head on both
 * turn right), of water or land, of slopes too steep and of the world's edge. It takes the one that
 * is free the farthest and turns the least, and no more speed than it can lose before the end. */
#ifndef JOLON_MOVER_AGENT_AVOIDANCE_H
#define JOLON_MOVER_AGENT_AVOIDANCE_H

#include "mover/context/step_context.h"
#include "world/terrain/gridsquare.h"

#define AVOIDANCE_ROUNDED_M 0.01 /* more than the index rounds positions */

/* What follows from the kinds alone. */
struct avoidance {
    /* [m] How far from its middle one of a kind is in the way; fixed ones at the height of vehicles
     * on the ground: a tree's trunk, not its crown. */
    double reach_m[KIND_COUNT_MAX];
    /* Of vehicle kinds: a bit for each fixed kind that does it no harm, by the collider's measure.
     */
    uint64_t harmless[KIND_COUNT_MAX];
    /* Likewise: the tangent of the slope that is too steep for it. */
    double slope[KIND_COUNT_MAX];
    /* Of vehicle kinds [m], rounded up: half its height, and what it keeps clear above and below.
     */
    float high_m[KIND_COUNT_MAX], gap_m[KIND_COUNT_MAX];
    /* Likewise [m]: how far about it one at full speed looks for others. */
    double around_m[KIND_COUNT_MAX];
    /* A bit for each gridsquare that a fixed object reaches into: most have none. */
    uint64_t stands[GRIDSQUARE_COUNT / 64];
};

void avoidance_init(struct avoidance *avoidance, const struct world *world);

/* Looks, if it is row i's turn, and changes what an agent wishes by what it remembers. */
void avoidance_steer(const struct step_context *context, uint32_t i,
                     struct desired_motion *desired);

#endif
