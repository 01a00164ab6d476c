/* Moves aircraft: bank and turn, speed, climb and lean. */
#include "mover/motion/aircraft.h"

#include "mover/motion/airframe.h"
#include "mover/motion/kinematics.h"
#include "world/maths/cpu_dispatch.h"
#include "world/maths/rotation.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/square_bounds.h"
#include "world/world.h"

#include <string.h>

#define LOOK_AHEAD_S   3.0
#define SIDE_DRAG_MPS2 6.0
#define NOSE_RATE_RPS  1.5   /* of an aeroplane's nose, towards its path */
#define LEAN_LEAST     1e-4  /* [rad] by which an attitude at least nears what is wanted */
#define STEEP_COSINE   0.12  /* a bank or pitch beyond counts as this one, whose slope is 8 */
#define UPRIGHT        0.97  /* sine of the steepest path */
#define SNAP_MPS       1e-3  /* a speed so near to what is wanted is what is wanted */
#define HOVER_MPS      4e-3  /* a climb that would bring one on hold to its height to 5 mm */
#define EDGE_M         200.0 /* an aircraft is told so far from the edge of the world */
#define EDGE_TURN_S    9.0   /* and turns back if it would reach it within this time */
#define EDGE_LEAST_M   50.0  /* as near as it wants to come */
#define EDGE_TURN_RAD  0.5   /* a driven aircraft that is further off has its stick hard over */

void aircraft_begin(struct aircraft *batch, uint32_t frames)
{
    memset(batch, 0, sizeof *batch);
    batch->frames = frames;
    for (int l = 0; l < LANE_COUNT; l++)
        batch->here.patch[l] = batch->ahead.patch[l] = &batch->idle;
}

static void take_kind(struct aircraft *batch, int l, const struct kind *kind)
{
    batch->full_mps.lane[l] = kind->max_speed_mps;
    batch->least_mps.lane[l] = kind->min_speed_mps;
    batch->acceleration.lane[l] = kind->acceleration_mps2;
    batch->turn_rate.lane[l] = kind->turn_rate_rps;
    batch->climb_rate.lane[l] = kind->climb_rate_mps;
    batch->load.lane[l] = maths_max(kind->max_load, 1.0);
    batch->low.lane[l] = kind->low_m;
    batch->burn_lps.lane[l] = kind->fuel_lps;
    batch->tank.lane[l] = -(int64_t)(kind->fuel_l > 0.0);
}

bool aircraft_turns_back(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const double side_m = context->world->terrain.squares.world_m;
    double x = m->row[i].x + m->row[i].vx * EDGE_TURN_S,
           z = m->row[i].z + m->row[i].vz * EDGE_TURN_S;
    const double first = EDGE_LEAST_M, last = side_m - EDGE_LEAST_M;
    return x < first || z < first || x > last || z > last;
}

/* Turns it towards the middle of the world, whatever its agent or its driver wants. */
static void turn_back(const struct entities *m, struct aircraft *batch, int l, double side_m)
{
    uint32_t i = batch->row[l];
    double heading = maths_heading(0.5 * side_m - m->row[i].x, 0.5 * side_m - m->row[i].z);
    double off = maths_wrap_half(heading - m->row[i].heading);
    batch->held.lane[l] = 0;
    batch->wanted_heading.lane[l] = heading;
    batch->wanted_mps.lane[l] = fabs(batch->wanted_mps.lane[l]); /* helicopters fly backwards */
    batch->turn.lane[l] = maths_clamp(off / EDGE_TURN_RAD, -1.0, 1.0);
}

static void take_desired(const struct step_context *context, struct aircraft *batch, int l,
                         const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const double side_m = context->world->terrain.squares.world_m;
    uint32_t i = batch->row[l];
    batch->driven.lane[l] = -(int64_t)desired->driven;
    batch->held.lane[l] = -(int64_t)desired->held;
    batch->wanted_heading.lane[l] = desired->heading_rad;
    batch->wanted_mps.lane[l] = desired->speed_mps;
    batch->altitude.lane[l] = desired->altitude_m;
    batch->turn.lane[l] = desired->turn;
    batch->climb.lane[l] = desired->climb_mps;
    batch->brake.lane[l] = desired->brake;
    batch->spool.lane[l] = desired->driven ? 1.0 - (double)m->row[i].dodge : 1.0;
    batch->power.lane[l] = desired->driven ? desired->power : 1.0;
    if (aircraft_turns_back(context, i))
        turn_back(m, batch, l, side_m);
}

bool aircraft_take(const struct step_context *context, struct aircraft *batch, uint32_t i,
                   const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    int l = batch->count++;
    batch->row[l] = i;
    batch->here.patch[l] = &context->terrain_entries[i];
    batch->ahead.patch[l] = &context->terrain_entries_ahead[i];
    __builtin_prefetch(batch->ahead.patch[l]);
    batch->x.lane[l] = m->row[i].x;
    batch->y.lane[l] = m->row[i].y;
    batch->z.lane[l] = m->row[i].z;
    batch->vx.lane[l] = m->row[i].vx;
    batch->vy.lane[l] = m->row[i].vy;
    batch->vz.lane[l] = m->row[i].vz;
    batch->heading.lane[l] = m->row[i].heading;
    batch->pitch.lane[l] = m->row[i].pitch;
    batch->roll.lane[l] = m->row[i].roll;
    batch->fuel.lane[l] = m->row[i].fuel_l;
    take_kind(batch, l, &context->world->kinds[m->row[i].kind]);
    batch->parked.lane[l] = -(int64_t)kinematics_parked(m, i);
    if (batch->parked.lane[l]) /* it hovers, and burns the fuel of many frames at once */
        batch->burn_lps.lane[l] *=
            kinematics_hover_burns(context, i) ? (double)kinematics_hover_frames(context) : 0.0;
    take_desired(context, batch, l, desired);
    return batch->count == LANE_COUNT;
}

double aircraft_ground(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    double here = kinematics_ground(context, m->row[i].x, m->row[i].z);
    return maths_max(here, kinematics_ground(context, m->row[i].x + LOOK_AHEAD_S * m->row[i].vx,
                                             m->row[i].z + LOOK_AHEAD_S * m->row[i].vz));
}

/* aircraft_ground() of a batch. */
static inline void find_highest(const struct step_context *context, struct aircraft *batch,
                                union simd_lanes *highest)
{
    union simd_lanes x, z, ahead;
    for (int h = 0; h < LANE_FOURS; h++) {
        x.f64x4[h] = batch->x.f64x4[h] + batch->vx.f64x4[h] * LOOK_AHEAD_S;
        z.f64x4[h] = batch->z.f64x4[h] + batch->vz.f64x4[h] * LOOK_AHEAD_S;
    }
    kinematics_ground_lanes(context, &batch->here, &batch->x, &batch->z, highest);
    kinematics_ground_lanes(context, &batch->ahead, &x, &z, &ahead);
    for (int h = 0; h < LANE_FOURS; h++)
        highest->f64x4[h] = SIMD_MAX(highest->f64x4[h], ahead.f64x4[h]);
}

/* --- four at once ------------------------------------------------------------------------------*/

/* Comments describe one aircraft. Each function treats the four of vector h. */

/* Computes the desired speed and climb, and burns fuel for them. sink: the rate at which the agent
 * of an aeroplane may come down. Without fuel a helicopter comes down under its rotor. */
static inline void want(struct aircraft *batch, int h, const f64x4 *ground, const f64x4 *sink,
                        double dt_s, struct airframe *f)
{
    const f64x4 none = SIMD_EVERY(0.0);
    f64x4 full = batch->full_mps.f64x4[h], most = batch->climb_rate.f64x4[h];
    f64x4 least = SIMD_NEGATIVE(most), slowest = batch->least_mps.f64x4[h] * AIRFRAME_SAFE;
    slowest = SIMD_MIN(slowest, full);
    f64x4 by_agent = SIMD_CLAMP(batch->wanted_mps.f64x4[h], slowest, full);
    /* A driver's speed is not clamped: helicopters also fly backwards. */
    f->wanted_mps = SIMD_CHOOSE(f->driven, batch->wanted_mps.f64x4[h], by_agent);
    f64x4 off = (*ground + batch->altitude.f64x4[h] - batch->y.f64x4[h]) * AIRCRAFT_FOLLOW_PS;
    f64x4 lowest = SIMD_CHOOSE(f->aeroplane, SIMD_MAX(SIMD_NEGATIVE(*sink), least), least);
    off = SIMD_CLAMP(off, lowest, most);
    four_masks level = batch->parked.f64x4[h] & (SIMD_ABS(off) < HOVER_MPS);
    off = SIMD_CHOOSE(level, none, off);
    f64x4 soft = SIMD_MAX(batch->y.f64x4[h] + batch->low.f64x4[h] - *ground, none);
    soft = SIMD_NEGATIVE(SIMD_EVERY(AIRFRAME_SOFT_MPS) + soft * AIRFRAME_SOFT_PS);
    soft = SIMD_MAX(batch->climb.f64x4[h], soft);
    soft = SIMD_CHOOSE(f->aeroplane, batch->climb.f64x4[h], soft);
    f->wanted_up_mps = SIMD_CHOOSE(f->driven, soft, off);
    f64x4 share = SIMD_ABS(f->wanted_mps) / SIMD_MAX(full, SIMD_EVERY(1e-9));
    share = SIMD_CLAMP(share, SIMD_EVERY(0.2), SIMD_EVERY(1.0));
    kinematics_simd_burn(&batch->fuel.f64x4[h], &batch->burn_lps.f64x4[h], &share,
                         &batch->tank.f64x4[h], dt_s, &f->dry);
    four_masks sinks = f->dry & ~f->aeroplane;
    f->wanted_mps = SIMD_CHOOSE(sinks, none, f->wanted_mps);
    f->wanted_up_mps = SIMD_CHOOSE(sinks, least, f->wanted_up_mps);
}

/* Advances a map coordinate, and notes whether it has crossed the edge of the world. */
static inline void advance(f64x4 *metres, const f64x4 *speed_mps, double dt_s, double side_m,
                           four_masks *left)
{
    f64x4 to = *metres + *speed_mps * dt_s;
    *metres = SIMD_CLAMP(to, SIMD_EVERY(0.0), SIMD_EVERY(side_m));
    *left |= to != *metres;
}

/* Moves it, and notes whether it is near the edge. */
static inline void change_position(struct aircraft *batch, int h, double dt_s, double side_m)
{
    const f64x4 last = SIMD_EVERY(side_m - EDGE_M);
    batch->left.f64x4[h] = (four_masks){0};
    advance(&batch->x.f64x4[h], &batch->vx.f64x4[h], dt_s, side_m, &batch->left.f64x4[h]);
    advance(&batch->z.f64x4[h], &batch->vz.f64x4[h], dt_s, side_m, &batch->left.f64x4[h]);
    batch->y.f64x4[h] += batch->vy.f64x4[h] * dt_s;
    batch->blocked.f64x4[h] = (batch->x.f64x4[h] < EDGE_M) | (batch->z.f64x4[h] < EDGE_M) |
                              (batch->x.f64x4[h] > last) | (batch->z.f64x4[h] > last);
}

/* Moves value to wanted where they are near to each other. */
static inline void snap(f64x4 *value, const f64x4 *wanted)
{
    *value = SIMD_CHOOSE(SIMD_ABS(*value - *wanted) < SNAP_MPS, *wanted, *value);
}

/* Changes the speeds. speed: an aeroplane's, along its path; before and after. */
static inline void push(struct airframe *f, double dt_s, f64x4 *speed, f64x4 *nose)
{
    const f64x4 none = SIMD_EVERY(0.0);
    f64x4 along, level, steepest;
    airframe_push(f, speed, dt_s, &along);
    airframe_tilt(f, &level, nose);
    airframe_steepest(f, speed, dt_s, &steepest);
    f->up_mps += f->rising_mps2 * dt_s;
    snap(&f->up_mps, &f->wanted_up_mps);
    /* One that has no speed to fly with falls. */
    f64x4 falls = SIMD_MAX(SIMD_NEGATIVE(f->up_mps), none);
    *speed = SIMD_MAX(*speed + along * dt_s, falls);
    snap(speed, &f->wanted_mps);
    f64x4 high = *speed * UPRIGHT, low = SIMD_NEGATIVE(high);
    high = SIMD_MIN(high, *speed * steepest);
    high = SIMD_MAX(high, low);
    f64x4 steep = SIMD_CLAMP(f->up_mps, low, high);
    four_masks backwards = f->aeroplane & (f->forward_mps < 0.0);
    f->up_mps = SIMD_CHOOSE(f->aeroplane & ~backwards, steep, f->up_mps);
    f->forward_mps += SIMD_CHOOSE(f->aeroplane, along, level) * dt_s;
    *speed = SIMD_CHOOSE(f->aeroplane & ~backwards, *speed * *speed - steep * steep,
                         f->forward_mps * f->forward_mps);
    f64x4 hovers = f->forward_mps;
    snap(&hovers, &f->wanted_mps);
    f->forward_mps = SIMD_CHOOSE(f->aeroplane, f->forward_mps, hovers);
}

/* --- lanes -------------------------------------------------------------------------------------*/

static inline void roots(union simd_lanes *square)
{
    for (int l = 0; l < LANE_COUNT; l++)
        square->lane[l] = sqrt(square->lane[l]);
}

/* Slope and cosine of an angle; both stay within what a wing can do. */
static inline void slopes(const union simd_lanes *angle, union simd_lanes *slope,
                          union simd_lanes *cosine)
{
    const f64x4 steep = SIMD_EVERY(STEEP_COSINE);
    maths_sincos_lanes(angle, slope, cosine);
    for (int h = 0; h < LANE_FOURS; h++)
        slope->f64x4[h] /= SIMD_MAX(cosine->f64x4[h], steep);
}

/* What the lean follows from. A helicopter pitches to change its speed, an aeroplane with its
 * path. */
struct lean {
    union simd_lanes bank, nose, flat;
    double lag; /* share of the way that a helicopter's attitude goes in the frame */
};

static inline void lean(struct aircraft *batch, const struct lean *lean, double dt_s)
{
    const f64x4 rate = SIMD_EVERY(AIRFRAME_ROLL_RPS * dt_s);
    const f64x4 nodding = SIMD_EVERY(NOSE_RATE_RPS * dt_s);
    union simd_lanes bank, nose;
    maths_slopes_lanes(&lean->bank, &lean->flat, &bank);
    maths_slopes_lanes(&lean->nose, &lean->flat, &nose);
    for (int h = 0; h < LANE_FOURS; h++) {
        four_masks aeroplane = batch->least_mps.f64x4[h] > 0.0;
        f64x4 off = SIMD_ABS(bank.f64x4[h] - batch->roll.f64x4[h]) * lean->lag + LEAN_LEAST;
        off = SIMD_MIN(off, nodding);
        f64x4 step = SIMD_CHOOSE(aeroplane, rate, off);
        kinematics_simd_approach(&batch->roll.f64x4[h], &bank.f64x4[h], &step);
        off = SIMD_ABS(nose.f64x4[h] - batch->pitch.f64x4[h]) * lean->lag + LEAN_LEAST;
        off = SIMD_MIN(off, nodding);
        step = SIMD_CHOOSE(aeroplane, nodding, off);
        kinematics_simd_approach(&batch->pitch.f64x4[h], &nose.f64x4[h], &step);
    }
}

/* Steering turns the spin with the aircraft. The same spin about other axes of the body would have
 * another energy. */
static void carry_spin(struct entities *m, uint32_t i, const struct aircraft *batch, int l)
{
    const struct vec3 spin = {m->row[i].spin_x, m->row[i].spin_y, m->row[i].spin_z};
    if (vec3_dot(spin, spin) == 0.0)
        return;
    struct mat3 before =
        rotation_matrix(rotation_of(m->row[i].heading, m->row[i].pitch, m->row[i].roll));
    struct mat3 after = rotation_matrix(
        rotation_of(batch->heading.lane[l], batch->pitch.lane[l], batch->roll.lane[l]));
    struct vec3 turned = rotation_apply(&after, rotation_back(&before, spin));
    m->row[i].spin_x = turned.x;
    m->row[i].spin_y = turned.y;
    m->row[i].spin_z = turned.z;
}

/* Notes in the row of lane l, which is as it was, how it flies a stretch. */
static void begin_stretch(const struct step_context *context, const struct aircraft *batch, int l)
{
    const struct entities *m = context->m;
    uint32_t i = batch->row[l];
    const struct cruise_changes changes = {
        .frames = batch->frames,
        .turned_rad = batch->turned.lane[l],
        .gain_mps2 = batch->gain_mps2.lane[l],
        .climbed_mps = batch->vy.lane[l] - m->row[i].vy,
        .pitched_rad = batch->pitch.lane[l] - m->row[i].pitch,
        .rolled_rad = batch->roll.lane[l] - m->row[i].roll,
    };
    kinematics_cruise(context, i, &changes);
}

static void write_rows(const struct step_context *context, const struct aircraft *batch)
{
    struct entities *m = context->m;
    for (int l = 0; l < batch->count; l++) {
        uint32_t i = batch->row[l];
        if (batch->refused.lane[l])
            continue;
        if (batch->frames > 1)
            begin_stretch(context, batch, l);
        else
            m->row[i].cruise_tick = 0;
        carry_spin(m, i, batch, l);
        m->row[i].x = batch->x.lane[l];
        m->row[i].y = batch->y.lane[l];
        m->row[i].z = batch->z.lane[l];
        m->row[i].vx = batch->vx.lane[l];
        m->row[i].vy = batch->vy.lane[l];
        m->row[i].vz = batch->vz.lane[l];
        m->row[i].heading = batch->heading.lane[l];
        m->row[i].pitch = batch->pitch.lane[l];
        m->row[i].roll = batch->roll.lane[l];
        m->row[i].fuel_l = batch->fuel.lane[l];
        if (batch->driven.lane[l])
            m->row[i].dodge = (float)(1.0 - batch->spool.lane[l]);
    }
}

/* Returns 1 - exp(-x) to 1e-4, for x up to 1: the share of a lag's way that a time of x lags
 * makes. */
static double lagged(double x)
{
    return x / (1.0 + x * (0.5 + x * (1.0 / 12.0)));
}

static inline void take_airframe(const struct aircraft *batch, int h, struct airframe *f)
{
    f->stall_mps = batch->least_mps.f64x4[h];
    f->full_mps = batch->full_mps.f64x4[h];
    f->thrust_mps2 = batch->acceleration.f64x4[h];
    f->climb_mps = batch->climb_rate.f64x4[h];
    f->turn_rps = batch->turn_rate.f64x4[h];
    f->load = batch->load.f64x4[h];
    f->aeroplane = batch->least_mps.f64x4[h] > 0.0;
    f->driven = batch->driven.f64x4[h];
    f->held = batch->held.f64x4[h];
    f->up_mps = batch->vy.f64x4[h];
    f->spool = batch->spool.f64x4[h];
    f->power = batch->power.f64x4[h];
    /* Agents slow an aeroplane by its air brakes. */
    f->brake = SIMD_CHOOSE(f->driven, batch->brake.f64x4[h], SIMD_EVERY(1.0));
    f64x4 off = batch->wanted_heading.f64x4[h] - batch->heading.f64x4[h];
    kinematics_simd_wrap_half(&off);
    f->turn = SIMD_CHOOSE(f->driven | f->held, batch->turn.f64x4[h], off);
}

/* The lanes between the steps of a move. */
struct moving {
    struct airframe flight[LANE_FOURS];
    union simd_lanes speed, rightward, through, sink;
    struct lean lean;
};

/* Takes the lanes, and computes their lift. */
static inline void rise(struct aircraft *batch, const union simd_lanes *ground,
                        struct moving *moving, double dt_s)
{
    union simd_lanes sine, cosine, bank_slope, bank_cosine, nose_slope, nose_cosine;
    maths_sincos_lanes(&batch->heading, &sine, &cosine);
    slopes(&batch->roll, &bank_slope, &bank_cosine);
    slopes(&batch->pitch, &nose_slope, &nose_cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        struct airframe *f = &moving->flight[h];
        f64x4 vx = batch->vx.f64x4[h], vz = batch->vz.f64x4[h];
        take_airframe(batch, h, f);
        f->forward_mps = vx * sine.f64x4[h] - vz * cosine.f64x4[h];
        moving->rightward.f64x4[h] = vx * cosine.f64x4[h] + vz * sine.f64x4[h];
        f->bank_slope = bank_slope.f64x4[h];
        f->bank_cosine = bank_cosine.f64x4[h];
        f->nose_slope = nose_slope.f64x4[h];
        moving->speed.f64x4[h] = f->forward_mps * f->forward_mps + f->up_mps * f->up_mps;
        airframe_inflow(f, &moving->through.f64x4[h]);
        f64x4 over = batch->y.f64x4[h] - ground->f64x4[h] - batch->altitude.f64x4[h];
        airframe_pull_out(f, &moving->speed.f64x4[h], &over, &moving->sink.f64x4[h]);
    }
    roots(&moving->speed);
    roots(&moving->through);
    roots(&moving->sink);
    for (int h = 0; h < LANE_FOURS; h++) {
        struct airframe *f = &moving->flight[h];
        f64x4 slope = moving->speed.f64x4[h] * AIRFRAME_DESCENT;
        f64x4 sink = SIMD_MIN(moving->sink.f64x4[h], slope);
        want(batch, h, &ground->f64x4[h], &sink, dt_s, f);
        airframe_power(f, &moving->through.f64x4[h]);
        airframe_climb(f, &moving->speed.f64x4[h]);
        airframe_lift_off(f);
        airframe_lift(f, dt_s);
        moving->lean.bank.f64x4[h] = f->turn_slope;
    }
    roots(&moving->lean.bank);
}

/* Turns and changes the speeds. */
static inline void fly(struct aircraft *batch, struct moving *moving, double dt_s)
{
    for (int h = 0; h < LANE_FOURS; h++) {
        struct airframe *f = &moving->flight[h];
        f->turn_slope = moving->lean.bank.f64x4[h];
        airframe_turn(f, dt_s, &moving->lean.bank.f64x4[h]);
        batch->heading.f64x4[h] += f->turning_rps * dt_s;
        kinematics_simd_wrap_turn(&batch->heading.f64x4[h]);
        push(f, dt_s, &moving->speed.f64x4[h], &moving->lean.nose.f64x4[h]);
        batch->spool.f64x4[h] = f->spool;
    }
    roots(&moving->speed);
    for (int h = 0; h < LANE_FOURS; h++) {
        struct airframe *f = &moving->flight[h];
        four_masks wings = f->aeroplane & (f->forward_mps >= 0.0);
        f->forward_mps = SIMD_CHOOSE(wings, moving->speed.f64x4[h], f->forward_mps);
        f64x4 path = f->up_mps / SIMD_MAX(f->forward_mps, SIMD_EVERY(1.0));
        moving->lean.nose.f64x4[h] = SIMD_CHOOSE(f->aeroplane, path, moving->lean.nose.f64x4[h]);
        moving->lean.flat.f64x4[h] = SIMD_EVERY(1.0);
    }
}

/* --- stretches ---------------------------------------------------------------------------------*/

/* A stretch is refused whose motion is not that of many frames: its end shows how even it is. */
#define STRETCH_TURN_RAD  0.3  /* it turns by no more */
#define STRETCH_GAIN_MPS  3.0  /* and gains or loses no more speed */
#define STRETCH_CLIMB_MPS 3.0  /* its climb changes by no more */
#define STRETCH_LEAN_RAD  0.15 /* and its bank and pitch, by nine degrees */
#define STRETCH_SLIP_MPS  0.01 /* it slips sideways no faster */
#define STRETCH_SLOPE     0.6  /* the ground under it is no steeper */
#define STRETCH_OVER_M    3.0  /* it stays so high over it, and over the rim of any new crater */

/* Replaces the position by that at the end of an arc on which speed and climb change evenly. */
static void find_arc_end(struct aircraft *batch, const struct entities *m, int l,
                         double forward_mps, double dt_s)
{
    uint32_t i = batch->row[l];
    double turned = maths_wrap_half(batch->heading.lane[l] - m->row[i].heading), sine, cosine;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    double before_mps = m->row[i].vx * sine - m->row[i].vz * cosine;
    const struct vec3 from = entities_position(m, i);
    const struct vec3 to =
        cruise_end(from, m->row[i].heading, turned, 0.5 * (before_mps + forward_mps) * dt_s);
    batch->x.lane[l] = to.x;
    batch->y.lane[l] = from.y + 0.5 * (m->row[i].vy + batch->vy.lane[l]) * dt_s;
    batch->z.lane[l] = to.z;
    batch->turned.lane[l] = turned;
    batch->gain_mps2.lane[l] = (forward_mps - before_mps) / dt_s;
}

/* Returns true if lane l flies evenly for the whole stretch. */
static bool flies_evenly(const struct aircraft *batch, const struct entities *m, int l, double dt_s)
{
    uint32_t i = batch->row[l];
    return fabs(batch->turned.lane[l]) <= STRETCH_TURN_RAD &&
           fabs(batch->gain_mps2.lane[l]) * dt_s <= STRETCH_GAIN_MPS &&
           fabs(batch->vy.lane[l] - m->row[i].vy) <= STRETCH_CLIMB_MPS &&
           fabs(batch->roll.lane[l] - m->row[i].roll) <= STRETCH_LEAN_RAD &&
           fabs(batch->pitch.lane[l] - m->row[i].pitch) <= STRETCH_LEAN_RAD;
}

/* Returns true if nothing of lane l can touch the ground, nor a new crater there. It is over all
 * that stands in these squares; or of the ground between two points no more is over the higher one
 * than the steepest slope makes of half the way. */
static bool stays_over_ground(const struct step_context *context, const struct aircraft *batch,
                              int l)
{
    const struct entities *m = context->m;
    uint32_t i = batch->row[l];
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double x = m->row[i].x, z = m->row[i].z, to_x = batch->x.lane[l], to_z = batch->z.lane[l];
    struct gridsquare_box box =
        gridsquare_box_of(&context->world->terrain.squares, maths_min(x, to_x), maths_min(z, to_z),
                          maths_max(x, to_x), maths_max(z, to_z));
    double way_m = sqrt((to_x - x) * (to_x - x) + (to_z - z) * (to_z - z));
    double ground_m = maths_max(batch->ground.lane[l], kinematics_ground(context, to_x, to_z));
    double sag_m = fabs(batch->vy.lane[l] - m->row[i].vy) * context->dt_s * batch->frames / 8.0;
    double low_m =
        maths_min(m->row[i].y, batch->y.lane[l]) - sag_m - kind->bound_m - STRETCH_OVER_M;
    if (square_bounds_within(&context->line_of_sight->skyline, box,
                             square_bounds_below_height(low_m)))
        return true;
    return low_m > ground_m + 0.5 * STRETCH_SLOPE * way_m &&
           square_bounds_within(context->slopes, box, square_bounds_below_slope(STRETCH_SLOPE));
}

/* Finds the lanes that cannot be moved by a stretch, and where the others are at its end. */
static void refuse(const struct step_context *context, struct aircraft *batch,
                   const struct moving *moving, double dt_s)
{
    const struct entities *m = context->m;
    for (int l = 0; l < batch->count; l++) {
        double forward_mps = moving->flight[l / 4].forward_mps[l % 4];
        find_arc_end(batch, m, l, forward_mps, dt_s);
        bool even = fabs(moving->rightward.lane[l]) <= STRETCH_SLIP_MPS && !batch->driven.lane[l] &&
                    !batch->parked.lane[l] && !batch->blocked.lane[l] && !batch->left.lane[l] &&
                    flies_evenly(batch, m, l, dt_s) && stays_over_ground(context, batch, l);
        batch->refused.lane[l] = even ? 0 : -1;
    }
}

VECTOR_CLONES
void aircraft_move(const struct step_context *context, struct aircraft *batch)
{
    const double dt_s = context->dt_s * batch->frames;
    const f64x4 none = SIMD_EVERY(0.0), drag = SIMD_EVERY(SIDE_DRAG_MPS2 * dt_s);
    union simd_lanes sine, cosine;
    struct moving moving;
    find_highest(context, batch, &batch->ground);
    rise(batch, &batch->ground, &moving, dt_s);
    fly(batch, &moving, dt_s);
    maths_sincos_lanes(&batch->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 speed = moving.flight[h].forward_mps, side = moving.rightward.f64x4[h];
        kinematics_simd_approach(&side, &none, &drag);
        batch->vx.f64x4[h] = speed * sine.f64x4[h] + side * cosine.f64x4[h];
        batch->vz.f64x4[h] = side * sine.f64x4[h] - speed * cosine.f64x4[h];
        batch->vy.f64x4[h] = moving.flight[h].up_mps;
        change_position(batch, h, dt_s, context->world->terrain.squares.world_m);
    }
    moving.lean.lag = lagged(maths_min(dt_s / AIRFRAME_LAG_S, 1.0));
    lean(batch, &moving.lean, dt_s);
    if (batch->frames > 1)
        refuse(context, batch, &moving, dt_s);
    write_rows(context, batch);
}
