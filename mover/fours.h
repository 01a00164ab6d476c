/* Parts of motion that land vehicles and aircraft share, for four bodies at once; each to the bit
 * what its namesake of one body gives (pose.c, world/maths.h). Angles are of up to 1e6. */
#ifndef JOLON_MOVER_FOURS_H
#define JOLON_MOVER_FOURS_H

#include "world/lanes.h"
#include "world/maths.h"

static inline void fours_wrap_turn(four *angle)
{
    const four none = LANES_EVERY(0.0);
    four turns = *angle / TWO_PI;
    four whole = __builtin_convertvector(__builtin_convertvector(turns, four_cells), four);
    whole -= LANES_CHOOSE(whole > turns, LANES_EVERY(1.0), none);
    four wrapped = *angle - TWO_PI * whole;
    wrapped = LANES_CHOOSE((wrapped >= TWO_PI) | (wrapped < 0.0), none, wrapped);
    *angle = LANES_CHOOSE((*angle >= 0.0) & (*angle < TWO_PI), *angle, wrapped);
}

static inline void fours_wrap_half(four *angle)
{
    fours_wrap_turn(angle);
    *angle = LANES_CHOOSE(*angle >= PI, *angle - TWO_PI, *angle);
}

static inline void fours_approach(four *value, const four *wanted, const four *step)
{
    four off = *wanted - *value, back = LANES_NEGATIVE(*step);
    *value += LANES_CLAMP(off, back, *step);
}

/* What pose_steer() asks of the wish. */
struct fours_helm {
    four wanted_heading, turn;
    four_masks driven;
};

static inline void fours_steer(four *heading, const struct fours_helm *helm, const four *rate,
                               double dt_s)
{
    four most = *rate * dt_s, least = LANES_NEGATIVE(most);
    four off = helm->wanted_heading - *heading;
    fours_wrap_half(&off);
    off = LANES_CLAMP(off, least, most);
    four by_wheel = helm->turn * *rate * dt_s;
    *heading += LANES_CHOOSE(helm->driven, by_wheel, off);
    fours_wrap_turn(heading);
}

/* Burns at a share of full throttle where there is a tank; who has run dry. */
static inline void fours_burn(four *fuel, const four *burn_lps, const four *share,
                              const four_masks *tank, double dt_s, four_masks *dry)
{
    const four none = LANES_EVERY(0.0);
    four left = *fuel - *burn_lps * *share * dt_s;
    left = LANES_MAX(none, left);
    *fuel = LANES_CHOOSE(*tank, left, *fuel);
    *dry = *tank & ~(left > none);
}

#endif
