/* Aircraft: helicopters hover (min_speed_mps 0), jets keep their speed; both keep their height
 * above the ground ahead of them. */
#include "mover/air.h"

#include "mover/fours.h"
#include "world/clones.h"
#include "world/square.h"

#include <string.h>

#define LOOK_AHEAD_S   3.0
#define SIDE_DRAG_MPS2 6.0
#define BANK_LIMIT     1.0 /* [rad] */
#define BANK_RATE_RPS  1.5
#define EDGE_M         200.0 /* turns back this far before the world's edge */

void air_begin(struct air *air)
{
    memset(air, 0, sizeof *air);
    for (int l = 0; l < LANE_COUNT; l++)
        air->here.patch[l] = air->ahead.patch[l] = &air->idle;
}

static void take_kind(struct air *air, int l, const struct kind *kind)
{
    air->full_mps.lane[l] = kind->max_speed_mps;
    air->least_mps.lane[l] = kind->min_speed_mps;
    air->acceleration.lane[l] = kind->acceleration_mps2;
    air->turn_rate.lane[l] = kind->turn_rate_rps;
    air->climb_rate.lane[l] = kind->climb_rate_mps;
    air->burn_lps.lane[l] = kind->fuel_lps;
    air->tank.lane[l] = -(int64_t)(kind->fuel_l > 0.0);
}

bool air_take(const struct move *move, struct air *air, uint32_t i, const struct wish *wish)
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
static inline void find_highest(const struct move *move, struct air *air, union lanes *highest)
{
    union lanes x, z, ahead;
    for (int h = 0; h < LANE_FOURS; h++) {
        x.four[h] = air->x.four[h] + air->vx.four[h] * LOOK_AHEAD_S;
        z.four[h] = air->z.four[h] + air->vz.four[h] * LOOK_AHEAD_S;
    }
    pose_ground_lanes(move, &air->here, &air->x, &air->z, highest);
    pose_ground_lanes(move, &air->ahead, &x, &z, &ahead);
    for (int h = 0; h < LANE_FOURS; h++)
        highest->four[h] = LANES_MAX(highest->four[h], ahead.four[h]);
}

/* --- four at once ------------------------------------------------------------------------------*/

/* Each of these does for the four lanes from 4 h on what its comment says of one aircraft. */

/* Speed and climb that it wants, and gets fuel for; without, it glides down. */
static inline void want(struct air *air, int h, const four *ground, double dt_s, four *wanted,
                        four *climb)
{
    const four none = LANES_EVERY(0.0);
    four_masks driven = air->driven.four[h], dry;
    four full = air->full_mps.four[h], most = air->climb_rate.four[h];
    four least = LANES_NEGATIVE(most);
    four by_agent = LANES_CLAMP(air->wanted_mps.four[h], air->least_mps.four[h], full);
    *wanted =
        LANES_CHOOSE(driven, air->wanted_mps.four[h], by_agent); /* who hovers goes back too */
    four off = (*ground + air->altitude.four[h] - air->y.four[h]) * 0.8;
    off = LANES_CLAMP(off, least, most);
    *climb = LANES_CHOOSE(driven, air->climb.four[h], off);
    four share = LANES_ABS(*wanted) / LANES_MAX(full, LANES_EVERY(1e-9));
    share = LANES_CLAMP(share, LANES_EVERY(0.2), LANES_EVERY(1.0));
    fours_burn(&air->fuel.four[h], &air->burn_lps.four[h], &share, &air->tank.four[h], dt_s, &dry);
    *wanted = LANES_CHOOSE(dry, none, *wanted);
    *climb = LANES_CHOOSE(dry, least, *climb);
}

/* pose_advance() */
static inline void advance(four *metres, four *speed_mps, double dt_s)
{
    four to = *metres + *speed_mps * dt_s;
    *metres = LANES_CLAMP(to, LANES_EVERY(0.0), LANES_EVERY(WORLD_SIDE_M));
    *speed_mps = LANES_CHOOSE(to != *metres, LANES_EVERY(0.0), *speed_mps);
}

/* There; is it near the edge? */
static inline void go(struct air *air, int h, double dt_s)
{
    const four last = LANES_EVERY(WORLD_SIDE_M - EDGE_M);
    advance(&air->x.four[h], &air->vx.four[h], dt_s);
    advance(&air->z.four[h], &air->vz.four[h], dt_s);
    air->y.four[h] += air->vy.four[h] * dt_s;
    air->blocked.four[h] = (air->x.four[h] < EDGE_M) | (air->z.four[h] < EDGE_M) |
                           (air->x.four[h] > last) | (air->z.four[h] > last);
}

/* --- lanes -------------------------------------------------------------------------------------*/

/* What a body leans by: a hovering one into its acceleration, a wing with its climb. */
struct lean {
    union lanes turning, weight, rising, level, hover;
};

static inline void lean(const struct move *move, struct air *air, const struct lean *lean)
{
    const four most = LANES_EVERY(BANK_LIMIT), least = LANES_EVERY(-BANK_LIMIT);
    const four step = LANES_EVERY(BANK_RATE_RPS * move->dt_s);
    union lanes bank, nose;
    maths_slopes_lanes(&lean->turning, &lean->weight, &bank);
    maths_slopes_lanes(&lean->rising, &lean->level, &nose);
    for (int h = 0; h < LANE_FOURS; h++) {
        four to = LANES_CLAMP(bank.four[h], least, most);
        fours_approach(&air->roll.four[h], &to, &step);
        to = LANES_CHOOSE(air->least_mps.four[h] > 0.0, nose.four[h], lean->hover.four[h]);
        fours_approach(&air->pitch.four[h], &to, &step);
    }
}

static void write_rows(const struct move *move, const struct air *air)
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
void air_move(const struct move *move, struct air *air)
{
    const four none = LANES_EVERY(0.0), least = LANES_EVERY(1e-9), one = LANES_EVERY(1.0);
    const four drag = LANES_EVERY(SIDE_DRAG_MPS2 * move->dt_s);
    union lanes ground, sine, cosine, forward, rightward, turned;
    struct lean leaning;
    find_highest(move, air, &ground);
    maths_sincos_lanes(&air->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        four vx = air->vx.four[h], vz = air->vz.four[h], before = air->heading.four[h];
        struct fours_helm helm = {air->wanted_heading.four[h], air->turn.four[h],
                                  air->driven.four[h]};
        forward.four[h] = vx * sine.four[h] - vz * cosine.four[h];
        rightward.four[h] = vx * cosine.four[h] + vz * sine.four[h];
        fours_steer(&air->heading.four[h], &helm, &air->turn_rate.four[h], move->dt_s);
        turned.four[h] = air->heading.four[h] - before;
        fours_wrap_half(&turned.four[h]);
    }
    maths_sincos_lanes(&air->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        four wanted, climb, gain = air->acceleration.four[h] * move->dt_s;
        four speed = forward.four[h], before = speed;
        want(air, h, &ground.four[h], move->dt_s, &wanted, &climb);
        four faster = gain * (1.0 + air->brake.four[h]), steeper = 2.0 * gain;
        fours_approach(&speed, &wanted, &faster);
        fours_approach(&rightward.four[h], &none, &drag);
        air->vx.four[h] = speed * sine.four[h] + rightward.four[h] * cosine.four[h];
        air->vz.four[h] = LANES_NEGATIVE(speed) * cosine.four[h] + rightward.four[h] * sine.four[h];
        fours_approach(&air->vy.four[h], &climb, &steeper);
        go(air, h, move->dt_s);
        four full = LANES_MAX(air->full_mps.four[h], least);
        leaning.turning.four[h] = turned.four[h] / move->dt_s * speed;
        leaning.weight.four[h] = LANES_EVERY(GRAVITY_MPS2);
        leaning.rising.four[h] = air->vy.four[h];
        leaning.level.four[h] = LANES_MAX(speed, one);
        leaning.hover.four[h] =
            -0.12 * speed / full - 0.1 * (speed - before) / LANES_MAX(gain, least);
    }
    lean(move, air, &leaning);
    write_rows(move, air);
}
