/* Aircraft: helicopters hover (min_speed_mps 0), jets keep their speed; both keep their height
 * above the ground ahead of them. */
#include "mover/motion/aircraft.h"

#include "mover/motion/kinematics_simd.h"
#include "world/maths/cpu_dispatch.h"
#include "world/terrain/gridsquare.h"

#include <string.h>

#define LOOK_AHEAD_S   3.0
#define SIDE_DRAG_MPS2 6.0
#define BANK_LIMIT     1.0 /* [rad] */
#define BANK_RATE_RPS  1.5
#define EDGE_M         200.0 /* turns back this far before the world's edge */

void aircraft_begin(struct aircraft *air)
{
    memset(air, 0, sizeof *air);
    for (int l = 0; l < LANE_COUNT; l++)
        air->here.patch[l] = air->ahead.patch[l] = &air->idle;
}

static void take_kind(struct aircraft *air, int l, const struct kind *kind)
{
    air->full_mps.lane[l] = kind->max_speed_mps;
    air->least_mps.lane[l] = kind->min_speed_mps;
    air->acceleration.lane[l] = kind->acceleration_mps2;
    air->turn_rate.lane[l] = kind->turn_rate_rps;
    air->climb_rate.lane[l] = kind->climb_rate_mps;
    air->burn_lps.lane[l] = kind->fuel_lps;
    air->tank.lane[l] = -(int64_t)(kind->fuel_l > 0.0);
}

bool aircraft_take(const struct step_context *move, struct aircraft *air, uint32_t i,
                   const struct desired_motion *wish)
{
    const struct entities *m = move->m;
    int l = air->count++;
    air->row[l] = i;
    air->here.patch[l] = &move->patches[i];
    air->ahead.patch[l] = &move->patches_ahead[i];
    __builtin_prefetch(air->ahead.patch[l]);
    air->driven.lane[l] = -(int64_t)wish->driven;
    air->wanted_heading.lane[l] = wish->heading_rad;
    air->wanted_mps.lane[l] = wish->speed_mps;
    air->altitude.lane[l] = wish->altitude_m;
    air->turn.lane[l] = wish->turn;
    air->climb.lane[l] = wish->climb_mps;
    air->brake.lane[l] = wish->brake;
    air->x.lane[l] = m->x[i];
    air->y.lane[l] = m->y[i];
    air->z.lane[l] = m->z[i];
    air->vx.lane[l] = m->vx[i];
    air->vy.lane[l] = m->vy[i];
    air->vz.lane[l] = m->vz[i];
    air->heading.lane[l] = m->heading[i];
    air->pitch.lane[l] = m->pitch[i];
    air->roll.lane[l] = m->roll[i];
    air->fuel.lane[l] = m->fuel_l[i];
    take_kind(air, l, &move->world->kinds[m->kind[i]]);
    return air->count == LANE_COUNT;
}

/* The higher of the ground here and ahead. */
static inline void find_highest(const struct step_context *move, struct aircraft *air,
                                union simd_lanes *highest)
{
    union simd_lanes x, z, ahead;
    for (int h = 0; h < LANE_FOURS; h++) {
        x.f64x4[h] = air->x.f64x4[h] + air->vx.f64x4[h] * LOOK_AHEAD_S;
        z.f64x4[h] = air->z.f64x4[h] + air->vz.f64x4[h] * LOOK_AHEAD_S;
    }
    kinematics_ground_lanes(move, &air->here, &air->x, &air->z, highest);
    kinematics_ground_lanes(move, &air->ahead, &x, &z, &ahead);
    for (int h = 0; h < LANE_FOURS; h++)
        highest->f64x4[h] = SIMD_MAX(highest->f64x4[h], ahead.f64x4[h]);
}

/* --- four at once ------------------------------------------------------------------------------*/

/* Each of these does for the four lanes from 4 h on what its comment says of one aircraft. */

/* Speed and climb that it wants, and gets fuel for; without, it glides down. */
static inline void want(struct aircraft *air, int h, const f64x4 *ground, double dt_s,
                        f64x4 *wanted, f64x4 *climb)
{
    const f64x4 none = SIMD_EVERY(0.0);
    four_masks driven = air->driven.f64x4[h], dry;
    f64x4 full = air->full_mps.f64x4[h], most = air->climb_rate.f64x4[h];
    f64x4 least = SIMD_NEGATIVE(most);
    f64x4 by_agent = SIMD_CLAMP(air->wanted_mps.f64x4[h], air->least_mps.f64x4[h], full);
    *wanted =
        SIMD_CHOOSE(driven, air->wanted_mps.f64x4[h], by_agent); /* who hovers goes back too */
    f64x4 off = (*ground + air->altitude.f64x4[h] - air->y.f64x4[h]) * 0.8;
    off = SIMD_CLAMP(off, least, most);
    *climb = SIMD_CHOOSE(driven, air->climb.f64x4[h], off);
    f64x4 share = SIMD_ABS(*wanted) / SIMD_MAX(full, SIMD_EVERY(1e-9));
    share = SIMD_CLAMP(share, SIMD_EVERY(0.2), SIMD_EVERY(1.0));
    kinematics_simd_burn(&air->fuel.f64x4[h], &air->burn_lps.f64x4[h], &share, &air->tank.f64x4[h],
                         dt_s, &dry);
    *wanted = SIMD_CHOOSE(dry, none, *wanted);
    *climb = SIMD_CHOOSE(dry, least, *climb);
}

/* kinematics_advance() */
static inline void advance(f64x4 *metres, f64x4 *speed_mps, double dt_s)
{
    f64x4 to = *metres + *speed_mps * dt_s;
    *metres = SIMD_CLAMP(to, SIMD_EVERY(0.0), SIMD_EVERY(WORLD_SIDE_M));
    *speed_mps = SIMD_CHOOSE(to != *metres, SIMD_EVERY(0.0), *speed_mps);
}

/* There; is it near the edge? */
static inline void go(struct aircraft *air, int h, double dt_s)
{
    const f64x4 last = SIMD_EVERY(WORLD_SIDE_M - EDGE_M);
    advance(&air->x.f64x4[h], &air->vx.f64x4[h], dt_s);
    advance(&air->z.f64x4[h], &air->vz.f64x4[h], dt_s);
    air->y.f64x4[h] += air->vy.f64x4[h] * dt_s;
    air->blocked.f64x4[h] = (air->x.f64x4[h] < EDGE_M) | (air->z.f64x4[h] < EDGE_M) |
                            (air->x.f64x4[h] > last) | (air->z.f64x4[h] > last);
}

/* --- lanes -------------------------------------------------------------------------------------*/

/* What a body leans by: a hovering one into its acceleration, a wing with its climb. */
struct lean {
    union simd_lanes turning, weight, rising, level, hover;
};

static inline void lean(const struct step_context *move, struct aircraft *air,
                        const struct lean *lean)
{
    const f64x4 most = SIMD_EVERY(BANK_LIMIT), least = SIMD_EVERY(-BANK_LIMIT);
    const f64x4 step = SIMD_EVERY(BANK_RATE_RPS * move->dt_s);
    union simd_lanes bank, nose;
    maths_slopes_lanes(&lean->turning, &lean->weight, &bank);
    maths_slopes_lanes(&lean->rising, &lean->level, &nose);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 to = SIMD_CLAMP(bank.f64x4[h], least, most);
        kinematics_simd_approach(&air->roll.f64x4[h], &to, &step);
        to = SIMD_CHOOSE(air->least_mps.f64x4[h] > 0.0, nose.f64x4[h], lean->hover.f64x4[h]);
        kinematics_simd_approach(&air->pitch.f64x4[h], &to, &step);
    }
}

static void write_rows(const struct step_context *move, const struct aircraft *air)
{
    struct entities *m = move->m;
    for (int l = 0; l < air->count; l++) {
        uint32_t i = air->row[l];
        m->x[i] = air->x.lane[l];
        m->y[i] = air->y.lane[l];
        m->z[i] = air->z.lane[l];
        m->vx[i] = air->vx.lane[l];
        m->vy[i] = air->vy.lane[l];
        m->vz[i] = air->vz.lane[l];
        m->heading[i] = air->heading.lane[l];
        m->pitch[i] = air->pitch.lane[l];
        m->roll[i] = air->roll.lane[l];
        m->fuel_l[i] = air->fuel.lane[l];
    }
}

VECTOR_CLONES
void aircraft_move(const struct step_context *move, struct aircraft *air)
{
    const f64x4 none = SIMD_EVERY(0.0), least = SIMD_EVERY(1e-9), one = SIMD_EVERY(1.0);
    const f64x4 drag = SIMD_EVERY(SIDE_DRAG_MPS2 * move->dt_s);
    union simd_lanes ground, sine, cosine, forward, rightward, turned;
    struct lean leaning;
    find_highest(move, air, &ground);
    maths_sincos_lanes(&air->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 vx = air->vx.f64x4[h], vz = air->vz.f64x4[h], before = air->heading.f64x4[h];
        struct kinematics_simd_helm helm = {air->wanted_heading.f64x4[h], air->turn.f64x4[h],
                                            air->driven.f64x4[h]};
        forward.f64x4[h] = vx * sine.f64x4[h] - vz * cosine.f64x4[h];
        rightward.f64x4[h] = vx * cosine.f64x4[h] + vz * sine.f64x4[h];
        kinematics_simd_steer(&air->heading.f64x4[h], &helm, &air->turn_rate.f64x4[h], move->dt_s);
        turned.f64x4[h] = air->heading.f64x4[h] - before;
        kinematics_simd_wrap_half(&turned.f64x4[h]);
    }
    maths_sincos_lanes(&air->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 wanted, climb, gain = air->acceleration.f64x4[h] * move->dt_s;
        f64x4 speed = forward.f64x4[h], before = speed;
        want(air, h, &ground.f64x4[h], move->dt_s, &wanted, &climb);
        f64x4 faster = gain * (1.0 + air->brake.f64x4[h]), steeper = 2.0 * gain;
        kinematics_simd_approach(&speed, &wanted, &faster);
        kinematics_simd_approach(&rightward.f64x4[h], &none, &drag);
        air->vx.f64x4[h] = speed * sine.f64x4[h] + rightward.f64x4[h] * cosine.f64x4[h];
        air->vz.f64x4[h] =
            SIMD_NEGATIVE(speed) * cosine.f64x4[h] + rightward.f64x4[h] * sine.f64x4[h];
        kinematics_simd_approach(&air->vy.f64x4[h], &climb, &steeper);
        go(air, h, move->dt_s);
        f64x4 full = SIMD_MAX(air->full_mps.f64x4[h], least);
        leaning.turning.f64x4[h] = turned.f64x4[h] / move->dt_s * speed;
        leaning.weight.f64x4[h] = SIMD_EVERY(GRAVITY_MPS2);
        leaning.rising.f64x4[h] = air->vy.f64x4[h];
        leaning.level.f64x4[h] = SIMD_MAX(speed, one);
        leaning.hover.f64x4[h] =
            -0.12 * speed / full - 0.1 * (speed - before) / SIMD_MAX(gain, least);
    }
    lean(move, air, &leaning);
    write_rows(move, air);
}
