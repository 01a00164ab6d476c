/* Flight as a point mass: load and bank, lift and stall, thrust and drag. For four aircraft at
 * once, each by the formulas of its sort: an aeroplane (struct aircraft: least_mps > 0) or a
 * helicopter. Aircraft bank before they turn and lean before they gain speed, so roll and pitch are
 * part of the state. Pure; any thread.
 *
 * Aeroplane. The lift is at most (V / V_stall)^2 times the weight, and at most the kind's load. The
 * bank leaves enough of it to climb, or to hold the height. Thrust is the kind's acceleration times
 * its mass. The drag is k V^2 + INDUCED g (n V_stall / V)^2, where n is the load and k follows from
 * the top speed. What thrust exceeds drag climbs or gains speed. Below V_stall the lift is less
 * than the weight: it sinks, its nose drops, and it gains speed.
 *
 * Helicopter. Its thrust is along the mast, which follows the stick with a lag. It tilts by at most
 * TILT_SLOPE forward or back, and banks by at most 60 degrees. Its engine has a power, and what a
 * load n and the speed leave of it climbs or gains speed (airframe_power()). So turns and climbs
 * cost speed. Below the speed of least power there is no speed to trade, and it banks and climbs
 * only as far as the engine can go on with.
 *
 * Engine. What the engine of a driven aircraft gives follows what is asked of it: the thrust of an
 * aeroplane, and the lift by which a helicopter climbs. Less is given at once. */
#ifndef JOLON_MOVER_MOTION_AIRFRAME_H
#define JOLON_MOVER_MOTION_AIRFRAME_H

#include "mover/motion/kinematics_simd.h"
#include "world/entity/climb_limits.h"
#include "world/entity/mass_properties.h"

/* The drag of lift: with an aspect ratio of 2 to 3 the drag coefficient is CD0 + 0.2 CL^2, and the
 * greatest CL is 1.2. A wing has that CL at the stall, where the drag is 0.24 of the weight. */
#define AIRFRAME_INDUCED 0.24

#define AIRFRAME_NEEDED 0.9 /* share of the thrust that holds the top speed */

/* The least thrust [share of the weight] with which an aeroplane flies at 1.3 V_stall. */
#define AIRFRAME_LEAST_THRUST 0.3

/* Agents fly at this multiple of V_stall or faster, as on approach (14 CFR 25.125: 1.23 or more).
 */
#define AIRFRAME_SAFE 1.3

/* Agents of aeroplanes descend by at most this share of their speed, 20 degrees, and so fast that
 * this share of the lift over their weight ends the descent at the height that they want. */
#define AIRFRAME_DESCENT  0.35
#define AIRFRAME_PULL_OUT 0.5
#define AIRFRAME_LEVELS   0.05 /* [g] by which any aeroplane levels out */

#define AIRFRAME_ROLL_RPS   2.1     /* an aeroplane's rate of roll: 120 degrees/s */
#define AIRFRAME_LAG_S      0.35    /* of a helicopter's attitude */
#define AIRFRAME_TILT_SLOPE 0.57735 /* tan 30 degrees */
#define AIRFRAME_BANK_SLOPE 1.73205 /* tan 60 degrees: 2 g */
#define AIRFRAME_SIDESLIP   0.15    /* [g] that a helicopter turns without bank */
#define AIRFRAME_DRAG_SLOPE 0.176   /* tan 10 degrees: the tilt at a helicopter's top speed */
#define AIRFRAME_CLIMB_S    0.5     /* in which the rate of climb follows the stick */
#define AIRFRAME_SPEED_S    1.0     /* and an aeroplane's speed the throttle */
#define AIRFRAME_HOVER_S    0.7     /* and a helicopter's the stick */
#define AIRFRAME_TURN_S     1.2     /* and the heading an agent's will */
#define AIRFRAME_COLLECTIVE 0.6     /* [g] the same by a helicopter's power */

/* The power of a helicopter, as shares of its weight times its top speed V. With u = v / V
 *
 *     needed = PROFILE (1 - BLADE + BLADE n^2) (1 + u^2 / 2)    the drag of the blades
 *            + DRAG_SLOPE u^3                                   of the fuselage
 *            + WAKE INFLOW n^2 / sqrt(u^2 + w^2)                the air that lift pushes down
 *
 * by momentum theory (Leishman, Principles of Helicopter Aerodynamics, chapters 2 and 5), where w
 * is the inflow. The figures are those of an AH-64 of 6.5 t: an inflow of 12.5 m/s at a hover, and
 * 60 W/kg for the blades, whose drag grows with their load. AIRFRAME_POWER is available, 0.9 of
 * which holds the top speed; or more, if the kind's climb_rate needs it at the speed of least
 * power. */
#define AIRFRAME_INFLOW      0.02778 /* square of the inflow at a hover: V / 6 */
#define AIRFRAME_WAKE        1.15    /* over the inflow of an ideal rotor */
#define AIRFRAME_PROFILE     0.08
#define AIRFRAME_BLADE       0.25
#define AIRFRAME_POWER       0.364
#define AIRFRAME_LEAST_POWER 0.175 /* what level flight needs at AIRFRAME_BUCKET */
#define AIRFRAME_BUCKET      0.45  /* u of the speed of least power */
#define AIRFRAME_ZOOM        0.5  /* climb over V, for each u over AIRFRAME_BUCKET, by speed lost */
#define AIRFRAME_TRADE       5.0  /* n^2 over the sustained, for the same */
#define AIRFRAME_HOVERS      0.2  /* u up to which power limits the acceleration as at this u */
#define AIRFRAME_GENTLE      0.03 /* square of the slope of a bank of 10 degrees */

/* Near the ground a driver's helicopter sinks no faster than AIRFRAME_SOFT_MPS, and so much more
 * for each metre under it. */
#define AIRFRAME_SOFT_MPS   1.0
#define AIRFRAME_SOFT_PS    0.4
#define AIRFRAME_SPOOL_S    5.0  /* a jet's engine, from idle to full thrust (14 CFR 33.73) */
#define AIRFRAME_SLOW_S     3.0  /* and back */
#define AIRFRAME_GOVERNOR_S 1.5  /* a helicopter's, both ways */
#define AIRFRAME_UNLOADED   0.7  /* [g] with less lift an aeroplane banks as with this */
#define AIRFRAME_DOWN       -0.8 /* [g] pushed over no harder: the crew stays in its seats */

/* Four aircraft in a frame. */
struct airframe {
    /* The kind. */
    f64x4 stall_mps, full_mps, thrust_mps2, climb_mps, turn_rps, load;
    four_masks aeroplane;
    /* The state. Along the heading; up. */
    f64x4 forward_mps, up_mps, bank_slope, bank_cosine, nose_slope;
    /* What it wants. */
    f64x4 wanted_mps, wanted_up_mps, turn; /* turn: -1..1 when driven or held, else [rad] off */
    f64x4 asked_up_mps;                    /* what it wants before the power limits it */
    f64x4 brake;                           /* 0..1 */
    f64x4 spool; /* 0..1: what its engine gives at most now; 1 unless driven */
    f64x4 power; /* 0..1: what an aeroplane's throttle allows its engine to give */
    four_masks driven, held, dry;
    /* Results of airframe_power(), for helicopters: shares as above. */
    f64x4 share;      /* u */
    f64x4 free_power; /* what no load leaves of the power */
    f64x4 per_load;   /* what each n^2 takes */
    f64x4 per_climb;  /* and each climb_mps / V */
    /* Results of airframe_lift() and airframe_turn(). */
    f64x4 lift_most; /* [g] */
    f64x4 rising_mps2, weight_mps2, turn_slope, turning_rps;
    f64x4 level_mps2; /* centripetal */
};

/* Lets the engine follow what is asked of it, 0..1. which: the sort of aircraft. */
static inline void airframe_spool(struct airframe *f, const f64x4 *asked, const four_masks *which,
                                  double dt_s)
{
    const f64x4 one = SIMD_EVERY(1.0), none = SIMD_EVERY(0.0);
    const f64x4 governed = SIMD_EVERY(dt_s / AIRFRAME_GOVERNOR_S);
    f64x4 up = SIMD_CHOOSE(f->aeroplane, SIMD_EVERY(dt_s / AIRFRAME_SPOOL_S), governed);
    f64x4 down =
        SIMD_CHOOSE(f->aeroplane, SIMD_EVERY(-dt_s / AIRFRAME_SLOW_S), SIMD_NEGATIVE(governed));
    f64x4 off = SIMD_CLAMP(*asked, none, one) - f->spool;
    off = SIMD_CLAMP(off, down, up);
    f->spool = SIMD_CHOOSE(f->driven & *which, f->spool + off, f->spool);
}

/* Limits the vertical acceleration of a driven helicopter to what its engine gives. */
static inline void airframe_govern(struct airframe *f, f64x4 *rise, double dt_s)
{
    const f64x4 g = SIMD_EVERY(GRAVITY_MPS2), one = SIMD_EVERY(1.0);
    const f64x4 full = SIMD_EVERY(1.0 + AIRFRAME_COLLECTIVE);
    four_masks helicopter = ~f->aeroplane;
    f64x4 asked = (one + *rise / g) / full;
    airframe_spool(f, &asked, &helicopter, dt_s);
    f64x4 most = (f->spool * full - one) * g;
    *rise = SIMD_CHOOSE(f->driven & helicopter, SIMD_MIN(*rise, most), *rise);
}

/* Returns u^2 + w^2, of which airframe_power() takes the root. The inflow w is that of a load of
 * 1, which is 3 % off at most. */
static inline void airframe_inflow(struct airframe *f, f64x4 *square)
{
    const f64x4 one = SIMD_EVERY(1.0), hover = SIMD_EVERY(AIRFRAME_INFLOW);
    f->share = SIMD_ABS(f->forward_mps) / SIMD_MAX(f->full_mps, one);
    f64x4 along = f->share * f->share;
    *square = along + hover * hover / (along + hover);
}

/* Computes the power of a helicopter. through: the root of what airframe_inflow() returned. */
static inline void airframe_power(struct airframe *f, const f64x4 *through)
{
    const f64x4 one = SIMD_EVERY(1.0), hover = SIMD_EVERY(AIRFRAME_INFLOW);
    f64x4 along = f->share * f->share, blades = AIRFRAME_PROFILE * (one + 0.5 * along);
    f64x4 climbs = AIRFRAME_LEAST_POWER + f->climb_mps / SIMD_MAX(f->full_mps, one);
    f->free_power = SIMD_MAX(climbs, SIMD_EVERY(AIRFRAME_POWER)) - (1.0 - AIRFRAME_BLADE) * blades -
                    AIRFRAME_DRAG_SLOPE * along * f->share;
    f->per_load = AIRFRAME_BLADE * blades + AIRFRAME_WAKE * AIRFRAME_INFLOW / *through;
    /* A climb lessens the inflow: at a hover it costs half. */
    f->per_climb = one - 0.5 * hover / (along + hover);
}

/* Returns what the bank leaves of a helicopter's power. */
static inline void airframe_spare(const struct airframe *f, f64x4 *spare)
{
    f64x4 slope = SIMD_MIN(SIMD_ABS(f->bank_slope), SIMD_EVERY(AIRFRAME_BANK_SLOPE));
    *spare = f->free_power - f->per_load * (1.0 + slope * slope);
}

/* Returns how far u is over AIRFRAME_BUCKET. */
static inline void airframe_over(const struct airframe *f, f64x4 *over)
{
    *over = SIMD_MAX(f->share - AIRFRAME_BUCKET, SIMD_EVERY(0.0));
}

/* The square of the slope of a bank that a helicopter's power holds beside an agent's climb
 * [m/s]. */
static inline void airframe_held(const struct airframe *f, const f64x4 *up_mps, f64x4 *held)
{
    const f64x4 none = SIMD_EVERY(0.0), one = SIMD_EVERY(1.0);
    f64x4 over, climbs = f->per_climb * SIMD_MAX(*up_mps, none) / SIMD_MAX(f->full_mps, one);
    climbs = SIMD_CHOOSE(f->driven, none, climbs);
    airframe_over(f, &over);
    *held = (f->free_power - climbs) / f->per_load + AIRFRAME_TRADE * over - one;
}

/* Computes the lift: the vertical acceleration, and the weight that a bank has to carry. */
static inline void airframe_lift(struct airframe *f, double dt_s)
{
    const f64x4 g = SIMD_EVERY(GRAVITY_MPS2), none = SIMD_EVERY(0.0), one = SIMD_EVERY(1.0);
    const f64x4 lowest = SIMD_EVERY(AIRFRAME_DOWN * GRAVITY_MPS2);
    f64x4 square = f->forward_mps * f->forward_mps + f->up_mps * f->up_mps;
    f64x4 stall = SIMD_MAX(f->stall_mps, one);
    f64x4 lift = SIMD_MIN(square / (stall * stall), f->load);
    f->lift_most = SIMD_CHOOSE(f->aeroplane, lift, f->load);
    double lag_s = dt_s > AIRFRAME_CLIMB_S ? dt_s : AIRFRAME_CLIMB_S;
    f64x4 rise = (f->wanted_up_mps - f->up_mps) / lag_s;
    f64x4 most = SIMD_CHOOSE(f->aeroplane, g * CLIMB_LIMITS_PULL, g * AIRFRAME_COLLECTIVE);
    rise = SIMD_CLAMP(rise, lowest, most);
    airframe_govern(f, &rise, dt_s);
    /* The bank is limited by what it wants, so that the lift is there when it has levelled out. */
    f64x4 carried = one + SIMD_MAX(rise, none) / g;
    f64x4 slope = f->lift_most / carried;
    slope = slope * slope - one;
    /* An agent climbs first: over what is before it, and away from others. But it always turns. */
    const f64x4 gentle = SIMD_EVERY(AIRFRAME_GENTLE);
    f64x4 asked, given;
    airframe_held(f, &f->asked_up_mps, &asked);
    airframe_held(f, &f->wanted_up_mps, &given);
    f64x4 held = SIMD_MAX(asked, SIMD_MIN(given, gentle));
    slope = SIMD_CHOOSE(f->aeroplane, slope, SIMD_MIN(slope, held));
    f->turn_slope = SIMD_MAX(slope, none); /* its square root is taken by lanes */
    f64x4 high = (f->lift_most * SIMD_MAX(f->bank_cosine, none) - one) * g;
    f->rising_mps2 = SIMD_MIN(rise, high);
    f->weight_mps2 = SIMD_MAX(g + f->rising_mps2, g * 0.05);
}

/* Returns the square of the rate of sink from which the lift levels an aeroplane out within a
 * height of over [m]. square: of its speed. */
static inline void airframe_pull_out(const struct airframe *f, const f64x4 *square,
                                     const f64x4 *over, f64x4 *sink)
{
    const f64x4 one = SIMD_EVERY(1.0), least = SIMD_EVERY(AIRFRAME_LEVELS);
    const f64x4 hardest = SIMD_EVERY(CLIMB_LIMITS_PULL);
    f64x4 stall = SIMD_MAX(f->stall_mps, one);
    f64x4 pull = (SIMD_MIN(*square / (stall * stall), f->load) - one) * AIRFRAME_PULL_OUT;
    pull = SIMD_CLAMP(pull, least, hardest);
    *sink = 2.0 * GRAVITY_MPS2 * pull * SIMD_MAX(*over, SIMD_EVERY(0.0));
}

/* Returns the sine of the steepest path to which its lift can bend an aeroplane's by the end of the
 * frame. speed: along the path, before the frame. Lift is across the path, so on a steep path
 * little of it is needed against the weight, and little of it lifts. */
static inline void airframe_steepest(const struct airframe *f, const f64x4 *speed, double dt_s,
                                     f64x4 *sine)
{
    const f64x4 g = SIMD_EVERY(GRAVITY_MPS2), one = SIMD_EVERY(1.0), none = SIMD_EVERY(0.0);
    f64x4 fast = SIMD_MAX(*speed, one), level = f->forward_mps / fast;
    f64x4 lifted = f->lift_most * SIMD_MAX(f->bank_cosine, none);
    *sine = f->up_mps / fast + level * (lifted - level) * g * dt_s / fast;
}

/* Computes the wanted slope of the bank, and the rate of turn by the present bank. turn_slope: the
 * steepest bank's. */
static inline void airframe_turn(struct airframe *f, double dt_s, f64x4 *bank)
{
    const f64x4 one = SIMD_EVERY(1.0), none = SIMD_EVERY(0.0), slip = SIMD_EVERY(AIRFRAME_SIDESLIP);
    const f64x4 gentle = SIMD_EVERY(AIRFRAME_BANK_SLOPE);
    f64x4 steepest = f->turn_slope, most = f->turn_rps, least = SIMD_NEGATIVE(f->turn_rps);
    steepest = SIMD_CHOOSE(f->aeroplane, steepest, SIMD_MIN(steepest, gentle));
    double lag_s = dt_s > AIRFRAME_TURN_S ? dt_s : AIRFRAME_TURN_S;
    f64x4 off = f->turn / lag_s, rate = f->turn * f->turn_rps;
    off = SIMD_CLAMP(off, least, most);
    rate = SIMD_CHOOSE(f->held | f->driven, rate, off);
    /* Wings that are nearly unloaded would need a steep bank for a gentle turn. */
    f64x4 weight = f->weight_mps2, unloaded = SIMD_EVERY(AIRFRAME_UNLOADED * GRAVITY_MPS2);
    weight = SIMD_CHOOSE(f->aeroplane, SIMD_MAX(weight, unloaded), weight);
    f64x4 slope = rate * f->forward_mps / weight;
    /* A driver's full deflection is the steepest bank. */
    f64x4 high = SIMD_CHOOSE(f->driven, steepest * SIMD_ABS(f->turn), steepest);
    f64x4 low = SIMD_NEGATIVE(high);
    *bank = SIMD_CLAMP(slope, low, high);
    f64x4 wing = f->bank_slope * f->weight_mps2;
    f64x4 right = SIMD_MAX(f->bank_slope, none) + slip, left = SIMD_MIN(f->bank_slope, none) - slip;
    f64x4 mast = SIMD_CLAMP(slope, left, right);
    mast = SIMD_CLAMP(mast, low, high);
    f->level_mps2 = SIMD_CHOOSE(f->aeroplane, wing, mast * f->weight_mps2);
    f64x4 slowest = SIMD_MAX(f->stall_mps * 0.5, one);
    f64x4 fast = SIMD_MAX(f->forward_mps, slowest);
    f64x4 hover = SIMD_CHOOSE(SIMD_ABS(slope) > 1e-9, mast / slope, one);
    f->turning_rps = SIMD_CHOOSE(f->aeroplane, wing / fast, rate * hover);
}

/* Returns the acceleration of an aeroplane along its path. speed: along it, above 0. */
static inline void airframe_push(struct airframe *f, const f64x4 *speed, double dt_s, f64x4 *push)
{
    const f64x4 none = SIMD_EVERY(0.0), g = SIMD_EVERY(GRAVITY_MPS2);
    const f64x4 least = g * AIRFRAME_LEAST_THRUST, one = SIMD_EVERY(1.0);
    f64x4 thrust = SIMD_MAX(f->thrust_mps2, least);
    f64x4 square = *speed * *speed, full = f->full_mps * f->full_mps;
    f64x4 stall = f->stall_mps * f->stall_mps;
    full = SIMD_MAX(full, one);
    f64x4 shape = (thrust * AIRFRAME_NEEDED - g * AIRFRAME_INDUCED * stall / full) / full;
    f64x4 load = (f->weight_mps2 * f->weight_mps2 + f->level_mps2 * f->level_mps2) / (g * g);
    f64x4 floor = SIMD_MAX(square, stall * 0.04);
    f64x4 drag = shape * square + g * AIRFRAME_INDUCED * load * stall / SIMD_MAX(floor, one);
    f64x4 slope = g * f->up_mps / SIMD_MAX(*speed, one);
    f64x4 idle = SIMD_NEGATIVE(drag) - slope;
    f64x4 wanted = (f->wanted_mps - *speed) / AIRFRAME_SPEED_S;
    f64x4 asked = SIMD_MIN((wanted - idle) / thrust, f->power);
    asked = SIMD_CHOOSE(f->dry, none, asked);
    airframe_spool(f, &asked, &f->aeroplane, dt_s);
    f64x4 most = idle + SIMD_CHOOSE(f->dry, none, thrust * f->spool);
    f64x4 low = idle - thrust * f->brake;
    *push = SIMD_CLAMP(wanted, low, most);
}

/* The rate of climb [m/s] that a helicopter may want: what its power gives, and more while it is
 * fast. */
static inline void airframe_lift_off(struct airframe *f)
{
    f64x4 spare, over;
    f->asked_up_mps = f->wanted_up_mps;
    airframe_spare(f, &spare);
    airframe_over(f, &over);
    f64x4 most = (spare / f->per_climb + AIRFRAME_ZOOM * over) * f->full_mps;
    most =
        SIMD_MAX(most, SIMD_EVERY(0.0)); /* a bank that is rolled out too slowly costs no height */
    most = SIMD_MIN(f->wanted_up_mps, most);
    f->wanted_up_mps = SIMD_CHOOSE(f->aeroplane, f->wanted_up_mps, most);
}

/* The rate of climb [m/s] that an aeroplane may want: what its thrust gives, more while it is fast,
 * and a glide without fuel. */
static inline void airframe_climb(struct airframe *f, const f64x4 *speed)
{
    const f64x4 g = SIMD_EVERY(GRAVITY_MPS2), one = SIMD_EVERY(1.0);
    const f64x4 least = g * AIRFRAME_LEAST_THRUST;
    f64x4 thrust = SIMD_MAX(f->thrust_mps2, least);
    f64x4 share = *speed / SIMD_MAX(f->full_mps, one);
    f64x4 safe = f->stall_mps * AIRFRAME_SAFE;
    f64x4 excess = (thrust * (1.0 - share * share) - g * AIRFRAME_INDUCED * 0.6) * *speed / g;
    f64x4 most = SIMD_MAX(excess, SIMD_EVERY(0.0)) + (*speed - safe) * 0.5;
    f64x4 glide = *speed * -0.25;
    most = SIMD_CHOOSE(f->dry, SIMD_MIN(glide, most), SIMD_MIN(f->wanted_up_mps, most));
    four_masks limited = f->aeroplane & (f->dry | ~f->driven);
    f->wanted_up_mps = SIMD_CHOOSE(limited, most, f->wanted_up_mps);
}

/* Limits a helicopter's wanted acceleration [m/s2] to what turn and climb leave of its power, along
 * the way that it flies. */
static inline void airframe_hasten(const struct airframe *f, f64x4 *low, f64x4 *high)
{
    const f64x4 one = SIMD_EVERY(1.0), slow = SIMD_EVERY(AIRFRAME_HOVERS);
    f64x4 spare;
    four_masks backwards = f->forward_mps < 0.0;
    airframe_spare(f, &spare);
    spare -= f->per_climb * f->up_mps / SIMD_MAX(f->full_mps, one);
    f64x4 most = SIMD_MAX(spare * GRAVITY_MPS2 / SIMD_MAX(f->share, slow), *low);
    f64x4 back = SIMD_MAX(*low, SIMD_NEGATIVE(most));
    *high = SIMD_CHOOSE(backwards, *high, SIMD_MIN(*high, most));
    *low = SIMD_CHOOSE(backwards, back, *low);
}

/* Returns a helicopter's acceleration along its heading by its present pitch, and the slope of the
 * pitch that it wants. */
static inline void airframe_tilt(const struct airframe *f, f64x4 *push, f64x4 *nose)
{
    const f64x4 steepest = SIMD_EVERY(AIRFRAME_TILT_SLOPE),
                flattest = SIMD_EVERY(-AIRFRAME_TILT_SLOPE);
    const f64x4 g = SIMD_EVERY(GRAVITY_MPS2), one = SIMD_EVERY(1.0);
    f64x4 high = f->thrust_mps2 * (1.0 + f->brake), low = SIMD_NEGATIVE(high);
    airframe_hasten(f, &low, &high);
    f64x4 full = SIMD_MAX(f->full_mps * f->full_mps, one);
    f64x4 drag = g * AIRFRAME_DRAG_SLOPE * f->forward_mps * SIMD_ABS(f->forward_mps) / full;
    f64x4 wanted = (f->wanted_mps - f->forward_mps) / AIRFRAME_HOVER_S;
    wanted = SIMD_CLAMP(wanted, low, high);
    f64x4 slope = (wanted + drag) / f->weight_mps2;
    slope = SIMD_CLAMP(slope, flattest, steepest);
    *nose = SIMD_NEGATIVE(slope);
    /* One that tumbles has no more of its thrust along the ground than in its steepest bank. */
    const f64x4 most = SIMD_EVERY(AIRFRAME_BANK_SLOPE), least = SIMD_EVERY(-AIRFRAME_BANK_SLOPE);
    f64x4 mast = SIMD_CLAMP(f->nose_slope, least, most);
    *push = SIMD_NEGATIVE(f->weight_mps2 * mast) - drag;
}

#endif
