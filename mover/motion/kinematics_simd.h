/* Parts of motion shared by land vehicles and aircraft, for four bodies at once. Each result is
 * equal to the bit to that of the function of the same name for one body (kinematics.h,
 * world/maths/maths.h), for angles up to 1e6. */
#ifndef JOLON_MOVER_MOTION_KINEMATICS_SIMD_H
#define JOLON_MOVER_MOTION_KINEMATICS_SIMD_H

#include "world/maths/simd.h"
#include "world/maths/maths.h"

static inline void kinematics_simd_wrap_turn(f64x4 *angle)
{
    const f64x4 none = SIMD_EVERY(0.0);
    f64x4 turns = *angle / TWO_PI;
    f64x4 whole = __builtin_convertvector(__builtin_convertvector(turns, four_cells), f64x4);
    whole -= SIMD_CHOOSE(whole > turns, SIMD_EVERY(1.0), none);
    f64x4 wrapped = *angle - TWO_PI * whole;
    wrapped = SIMD_CHOOSE((wrapped >= TWO_PI) | (wrapped < 0.0), none, wrapped);
    *angle = SIMD_CHOOSE((*angle >= 0.0) & (*angle < TWO_PI), *angle, wrapped);
}

static inline void kinematics_simd_wrap_half(f64x4 *angle)
{
    kinematics_simd_wrap_turn(angle);
    *angle = SIMD_CHOOSE(*angle >= PI, *angle - TWO_PI, *angle);
}

static inline void kinematics_simd_approach(f64x4 *value, const f64x4 *wanted, const f64x4 *step)
{
    f64x4 off = *wanted - *value, back = SIMD_NEGATIVE(*step);
    *value += SIMD_CLAMP(off, back, *step);
}

/* The desired motion as kinematics_steer() reads it. */
struct kinematics_simd_helm {
    f64x4 wanted_heading, turn;
    four_masks driven;
};

static inline void kinematics_simd_steer(f64x4 *heading, const struct kinematics_simd_helm *helm,
                                         const f64x4 *rate, double dt_s)
{
    f64x4 most = *rate * dt_s, least = SIMD_NEGATIVE(most);
    f64x4 off = helm->wanted_heading - *heading;
    kinematics_simd_wrap_half(&off);
    off = SIMD_CLAMP(off, least, most);
    f64x4 by_wheel = helm->turn * *rate * dt_s;
    *heading += SIMD_CHOOSE(helm->driven, by_wheel, off);
    kinematics_simd_wrap_turn(heading);
}

/* Burns fuel at a share of full throttle where there is a tank. dry: the tank is empty. */
static inline void kinematics_simd_burn(f64x4 *fuel, const f64x4 *burn_lps, const f64x4 *share,
                                        const four_masks *tank, double dt_s, four_masks *dry)
{
    const f64x4 none = SIMD_EVERY(0.0);
    f64x4 left = *fuel - *burn_lps * *share * dt_s;
    left = SIMD_MAX(none, left);
    *fuel = SIMD_CHOOSE(*tank, left, *fuel);
    *dry = *tank & ~(left > none);
}

#endif
