/* Moves land vehicles that agents drive on easy ground: steering, power and brakes, slopes, debris
 * and water. Their rolling resistance and grip are those of dirt. */
#include "mover/motion/ground_vehicle.h"

#include "mover/motion/chassis.h"
#include "mover/motion/chassis_shell.h"
#include "mover/motion/drivetrain.h"
#include "mover/motion/fording.h"
#include "mover/motion/ground_stretch.h"
#include "mover/motion/kinematics.h"
#include "mover/motion/kinematics_simd.h"
#include "mover/query/ground_debris.h"
#include "mover/query/ground_marks.h"
#include "world/maths/cpu_dispatch.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <string.h>

#define STANDING_TURN 0.35 /* share of the turn rate at rest */
#define FULL_TURN_MPS 4.0  /* from this speed on the turn rate is full */
#define SLIDES_MPS    1.0  /* a slower vehicle slides no sooner than at this speed */
#define LATERAL_SHARE 0.75 /* of the greatest lateral acceleration: below that of rough motion */
#define LEAST_MPS     0.5  /* below it the drive force grows no more */
#define PIVOT_RPS     1e3  /* tracks turn a vehicle on the spot: more than any turn rate */
#define LEAST_TURN_M  0.1  /* no circle is tighter */
#define MISSES_RAD    0.05 /* of its turn in the tightest circle, a stretch at changing speed */
#define NEAR_M        1.0  /* between a body and works or craters that cannot be under it */
#define LEAST_GAIN    0.1  /* [m/s2] a vehicle that can climb gains speed at least so fast */
#define HALF_WAYS     3    /* so often the speed half way of a stretch is found again */
#define GENTLE_RAD    0.4  /* on steeper slopes it would slide: it gains speed and brakes */
#define GENTLE_MPS2   1.0  /* by so much at most, */
#define GENTLE_SHARE  0.8  /* but brakes hard if it wants less than this share of its speed */

double ground_vehicle_debris(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    if (!(ground_marks_at(context->ground_marks, m->row[i].x, m->row[i].z) & GROUND_MARKS_DEBRIS))
        return 1.0;
    return ground_debris_share(context->world, context->committed,
                               &context->world->kinds[m->row[i].kind], m->row[i].x, m->row[i].z);
}

void ground_vehicle_begin(struct ground_vehicle *batch, uint32_t frames)
{
    memset(batch, 0, sizeof *batch);
    batch->frames = frames;
    ground_pose_begin(&batch->pose);
}

/* Returns true if works or craters may be under the row in this frame. */
static bool is_uneven_near(const struct step_context *context, const struct ground_vehicle *batch,
                           int l)
{
    const struct kind *kind = &context->world->kinds[context->m->row[batch->row[l]].kind];
    const double speed = fabs(batch->vx.lane[l]) + fabs(batch->vz.lane[l]) +
                         kind->acceleration_mps2 * BRAKES * context->dt_s;
    return terrain_uneven_near(&context->world->terrain, context->craters, batch->pose.x.lane[l],
                               batch->pose.z.lane[l],
                               vehicle_shell_reach(kind) + NEAR_M + 2.0 * context->dt_s * speed);
}

static void find_scars(const struct step_context *context, struct ground_vehicle *batch)
{
    const struct ground_pose *pose = &batch->pose;
    union lane_masks debris;
    ground_marks_find(context->ground_marks, &pose->x, &pose->z, &batch->pose.cratered, &debris);
    for (int l = 0; l < LANE_COUNT; l++) {
        batch->debris.lane[l] = 1.0;
        if (l < batch->count && batch->pose.cratered.lane[l] && batch->frames == 1)
            batch->pose.cratered.lane[l] = -(int64_t)is_uneven_near(context, batch, l);
        if (!debris.lane[l])
            continue;
        const struct kind *kind = &context->world->kinds[context->m->row[batch->row[l]].kind];
        batch->debris.lane[l] = ground_debris_share(context->world, context->committed, kind,
                                                    pose->x.lane[l], pose->z.lane[l]);
    }
}

static void take_kind(struct ground_vehicle *batch, int l, const struct kind *kind)
{
    const struct ground_grip dirt = ground_grip_of(COVER_GRASS);
    batch->bend.lane[l] = chassis_shell_bend(kind);
    batch->full_mps.lane[l] = kind->max_speed_mps;
    batch->acceleration.lane[l] = kind->acceleration_mps2;
    batch->turn_rate.lane[l] = kind->turn_rate_rps;
    batch->max_slope.lane[l] = kind->max_slope_rad;
    batch->power_wpkg.lane[l] = drivetrain_power(kind) / kind->mass_kg;
    batch->gears.lane[l] = drivetrain_gears(kind);
    batch->rolling.lane[l] = kind->tracked ? dirt.tracks : dirt.wheels;
    batch->lateral.lane[l] = LATERAL_SHARE * drivetrain_lateral(kind, dirt.friction);
    batch->curve.lane[l] = kind->tracked ? 0.0 : 1.0 / maths_max(kind->least_turn_m, LEAST_TURN_M);
    batch->pivot.lane[l] = kind->tracked ? PIVOT_RPS : 0.0;
    batch->half_length.lane[l] = kind->length_m * 0.5;
    batch->burn_lps.lane[l] = kind->fuel_lps;
    batch->idle_share.lane[l] = kind->idle_share;
    batch->tank.lane[l] = -(int64_t)(kind->fuel_l > 0.0);
}

/* Fills what does not depend on the desired motion, and returns the lane. */
static inline int take_row(const struct step_context *context, struct ground_vehicle *batch,
                           uint32_t i)
{
    const struct entities *m = context->m;
    int l = batch->count++;
    if (ground_pose_take(context, &batch->pose, l, i))
        take_kind(batch, l, &context->world->kinds[m->row[i].kind]);
    batch->row[l] = i;
    batch->y.lane[l] = m->row[i].y;
    batch->vx.lane[l] = m->row[i].vx;
    batch->vz.lane[l] = m->row[i].vz;
    batch->heading.lane[l] = m->row[i].heading;
    batch->pitch.lane[l] = m->row[i].pitch;
    batch->fuel.lane[l] = m->row[i].fuel_l;
    batch->burns.lane[l] = kinematics_parked(m, i) ? 0.0 : 1.0;
    return l;
}

bool ground_vehicle_take(const struct step_context *context, struct ground_vehicle *batch,
                         uint32_t i, const struct desired_motion *desired)
{
    int l = take_row(context, batch, i);
    batch->held.lane[l] = 0;
    batch->wanted_heading.lane[l] = desired->heading_rad;
    batch->wanted_mps.lane[l] = desired->speed_mps;
    return batch->count == LANE_COUNT;
}

bool ground_vehicle_take_held(const struct step_context *context, struct ground_vehicle *batch,
                              uint32_t i)
{
    int l = take_row(context, batch, i);
    if (batch->frames == 1)
        batch->burns.lane[l] = (double)kinematics_burn_frames(context, i);
    batch->turn.lane[l] = (double)context->m->row[i].steer;
    batch->wanted_mps.lane[l] = (double)context->m->row[i].throttle;
    batch->held.lane[l] = -1;
    return batch->count == LANE_COUNT;
}

struct desired_motion ground_vehicle_desired(const struct ground_vehicle *batch, int l)
{
    return (struct desired_motion){.heading_rad = batch->wanted_heading.lane[l],
                                   .speed_mps = batch->wanted_mps.lane[l],
                                   .held = batch->held.lane[l] != 0,
                                   .turn = batch->turn.lane[l]};
}

/* --- four at once ------------------------------------------------------------------------------*/

/* Comments describe one vehicle. Each function treats the four of vector h. */

/* Computes the desired motion of held lanes as agent_controls_motion() does. */
static inline void find_desired(struct ground_vehicle *batch, int h, double dt_s)
{
    four_masks held = batch->held.f64x4[h];
    f64x4 full = batch->full_mps.f64x4[h], most = batch->turn_rate.f64x4[h] * dt_s;
    f64x4 heading = batch->heading.f64x4[h] + batch->turn.f64x4[h] * most;
    f64x4 speed = batch->wanted_mps.f64x4[h] * full;
    batch->wanted_heading.f64x4[h] = SIMD_CHOOSE(held, heading, batch->wanted_heading.f64x4[h]);
    batch->wanted_mps.f64x4[h] = SIMD_CHOOSE(held, speed, batch->wanted_mps.f64x4[h]);
}

/* Steers as kinematics_steer() does: no vehicle so hard that it would slide or lean over, and
 * wheels in no tighter circle than they can, at the lesser of the speeds before and after the step.
 * So they turn no vehicle that stands. */
static inline void steer(struct ground_vehicle *batch, int h, const f64x4 *forward,
                         const f64x4 *after, double dt_s)
{
    const f64x4 slides = SIMD_EVERY(SLIDES_MPS), none = SIMD_EVERY(0.0);
    f64x4 speed = SIMD_ABS(*forward), later = SIMD_ABS(*after);
    f64x4 agility = STANDING_TURN + (1.0 - STANDING_TURN) * speed / FULL_TURN_MPS;
    agility = SIMD_CLAMP(agility, none, SIMD_EVERY(1.0));
    f64x4 rate = batch->turn_rate.f64x4[h] * agility;
    f64x4 holds = batch->lateral.f64x4[h] / SIMD_MAX(speed, slides);
    f64x4 circle = SIMD_MIN(speed, later) * batch->curve.f64x4[h] + batch->pivot.f64x4[h];
    rate = SIMD_MIN(rate, holds);
    f64x4 off = batch->wanted_heading.f64x4[h] - batch->heading.f64x4[h];
    kinematics_simd_wrap_half(&off);
    f64x4 misses = SIMD_ABS(later - speed) * batch->curve.f64x4[h] * dt_s;
    batch->tight.f64x4[h] =
        (circle < rate) & (SIMD_ABS(off) > circle * dt_s) & (misses > SIMD_EVERY(MISSES_RAD));
    rate = SIMD_MIN(rate, circle);
    struct kinematics_simd_helm helm = {batch->wanted_heading.f64x4[h], none, {0}};
    kinematics_simd_steer(&batch->heading.f64x4[h], &helm, &rate, dt_s);
}

/* Burns fuel for the desired speed as kinematics_burn() does, of as many frames as are due. Without
 * fuel the speed is 0. */
static inline void burn(struct ground_vehicle *batch, int h, f64x4 *wanted, double dt_s)
{
    const f64x4 none = SIMD_EVERY(0.0), least = SIMD_EVERY(1e-9);
    f64x4 share = SIMD_ABS(*wanted) / SIMD_MAX(batch->full_mps.f64x4[h], least);
    share = SIMD_MAX(share, batch->idle_share.f64x4[h]);
    share *= batch->burns.f64x4[h];
    four_masks dry;
    kinematics_simd_burn(&batch->fuel.f64x4[h], &batch->burn_lps.f64x4[h], &share,
                         &batch->tank.f64x4[h], dt_s, &dry);
    *wanted = SIMD_CHOOSE(dry, none, *wanted);
}

/* The force that rolling and the slope ahead take from the engine, over the mass [m/s2]. */
static inline void find_held_back(const struct ground_vehicle *batch, int h, const f64x4 *wanted,
                                  f64x4 *back)
{
    f64x4 pitch = batch->pitch.f64x4[h];
    f64x4 climb = SIMD_CHOOSE(*wanted < 0.0, SIMD_NEGATIVE(pitch), pitch);
    f64x4 sine = climb * (1.0 - climb * climb / 6.0);
    *back = GRAVITY_MPS2 * (sine + batch->rolling.f64x4[h]);
}

/* Limits the speed by the engine's power on the slope, and by debris. On a slope that the kind
 * cannot climb the speed is 0 and the vehicle is blocked. */
static inline void limit(struct ground_vehicle *batch, int h, f64x4 *wanted)
{
    const f64x4 none = SIMD_EVERY(0.0), least = SIMD_EVERY(1e-3);
    f64x4 full = batch->full_mps.f64x4[h], pitch = batch->pitch.f64x4[h];
    f64x4 climb = SIMD_CHOOSE(*wanted < 0.0, SIMD_NEGATIVE(pitch), pitch);
    f64x4 back;
    find_held_back(batch, h, wanted, &back);
    f64x4 most = batch->power_wpkg.f64x4[h] / SIMD_MAX(back, least);
    most = SIMD_MIN(most, full);
    most = SIMD_CHOOSE(climb >= batch->max_slope.f64x4[h], none, most);
    batch->blocked.f64x4[h] = (SIMD_ABS(*wanted) > none) & (most <= none);
    f64x4 in_debris = batch->debris.f64x4[h] * full;
    most = SIMD_MIN(most, in_debris);
    f64x4 lowest = SIMD_NEGATIVE(most);
    *wanted = SIMD_CLAMP(*wanted, lowest, most);
}

/* The gain of speed that the engine gives at this speed [m/s2]. */
static inline void pull(const struct ground_vehicle *batch, int h, const f64x4 *speed,
                        const f64x4 *back, f64x4 *gain)
{
    const f64x4 slow = SIMD_EVERY(LEAST_MPS), least = SIMD_EVERY(LEAST_GAIN);
    *gain = batch->power_wpkg.f64x4[h] / SIMD_MAX(*speed, slow) - *back;
    *gain /= batch->gears.f64x4[h];
    *gain = SIMD_MAX(*gain, least);
    *gain = SIMD_MIN(*gain, batch->acceleration.f64x4[h]);
}

/* The speed along the heading after the step. Agents brake as hard as their kind can, and stop
 * before they drive the other way: brakes give no speed. On steep slopes they keep their speed
 * gently. In a stretch an engine pulls as it does half way: it gives less force at a higher
 * speed. */
static inline void power(struct ground_vehicle *batch, int h, const f64x4 *wanted, f64x4 *forward,
                         double dt_s)
{
    const f64x4 none = SIMD_EVERY(0.0), grip = SIMD_EVERY(GROUND_GRIP * GRAVITY_MPS2);
    const f64x4 gentle = SIMD_EVERY(GENTLE_MPS2);
    f64x4 speed = SIMD_ABS(*forward);
    four_masks reverses = *wanted * *forward < none;
    four_masks braking = (SIMD_ABS(*wanted) < SIMD_ABS(*forward)) | reverses;
    f64x4 hardest = BRAKES * batch->acceleration.f64x4[h], back, gain;
    find_held_back(batch, h, wanted, &back);
    hardest = SIMD_MIN(hardest, grip);
    pull(batch, h, &speed, &back, &gain);
    for (int n = 0; n < HALF_WAYS && batch->frames > 1; n++) {
        f64x4 middle = speed + 0.5 * dt_s * gain;
        pull(batch, h, &middle, &back, &gain);
    }
    four_masks steep = SIMD_ABS(batch->pitch.f64x4[h]) > GENTLE_RAD;
    four_masks eases = steep & (SIMD_ABS(*wanted) > GENTLE_SHARE * speed);
    hardest = SIMD_CHOOSE(eases, SIMD_MIN(hardest, gentle), hardest);
    gain = SIMD_CHOOSE(steep, SIMD_MIN(gain, gentle), gain);
    f64x4 step = SIMD_CHOOSE(braking, hardest, gain) * dt_s;
    f64x4 aim = SIMD_CHOOSE(reverses, none, *wanted);
    kinematics_simd_approach(forward, &aim, &step);
    batch->reaches.f64x4[h] = *forward == aim;
}

/* --- lanes -------------------------------------------------------------------------------------*/

/* The position after the step, and that of the end of the body that leads. */
struct ahead {
    union simd_lanes x, z, lead_x, lead_z;
};

static inline void find_ahead(const struct step_context *context, struct ground_vehicle *batch,
                              const union simd_lanes *forward, union simd_lanes *rightward,
                              struct ahead *ahead)
{
    const f64x4 none = SIMD_EVERY(0.0);
    const double dt_s = ground_vehicle_time_s(context, batch);
    const f64x4 grip = SIMD_EVERY(GROUND_GRIP * GRAVITY_MPS2 * dt_s);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 sine = batch->pose.sine.f64x4[h], cosine = batch->pose.cosine.f64x4[h];
        f64x4 speed = forward->f64x4[h], half = batch->half_length.f64x4[h];
        kinematics_simd_approach(&rightward->f64x4[h], &none, &grip);
        batch->vx.f64x4[h] = speed * sine + rightward->f64x4[h] * cosine;
        batch->vz.f64x4[h] = SIMD_NEGATIVE(speed) * cosine + rightward->f64x4[h] * sine;
        ahead->x.f64x4[h] = batch->pose.x.f64x4[h] + batch->vx.f64x4[h] * dt_s;
        ahead->z.f64x4[h] = batch->pose.z.f64x4[h] + batch->vz.f64x4[h] * dt_s;
        f64x4 lead = SIMD_CHOOSE(speed < none, SIMD_NEGATIVE(half), half);
        ahead->lead_x.f64x4[h] = ahead->x.f64x4[h] + sine * lead;
        ahead->lead_z.f64x4[h] = ahead->z.f64x4[h] - cosine * lead;
    }
}

/* Replaces the position by that at the end of a stretch: on an arc on which the speed changes
 * evenly (world/entity/cruise.h). before: the speed when it begins; heading: that one. */
static void find_arc_end(const struct step_context *context, struct ground_vehicle *batch,
                         const union simd_lanes *before, const union simd_lanes *forward,
                         const union simd_lanes *heading, struct ahead *ahead)
{
    const double dt_s = ground_vehicle_time_s(context, batch);
    union simd_lanes middle, sine, cosine;
    for (int l = 0; l < LANE_COUNT; l++) {
        double turned = maths_wrap_half(batch->heading.lane[l] - heading->lane[l]);
        batch->turned.lane[l] = turned;
        middle.lane[l] = batch->heading.lane[l] - 0.5 * turned;
    }
    maths_sincos_lanes(&middle, &sine, &cosine);
    for (int l = 0; l < LANE_COUNT; l++) {
        double mean_mps = 0.5 * (before->lane[l] + forward->lane[l]);
        double way_m = cruise_chord(mean_mps * dt_s, 0.5 * batch->turned.lane[l]);
        double x = batch->pose.x.lane[l] + way_m * sine.lane[l];
        double z = batch->pose.z.lane[l] - way_m * cosine.lane[l];
        ahead->lead_x.lane[l] += x - ahead->x.lane[l];
        ahead->lead_z.lane[l] += z - ahead->z.lane[l];
        ahead->x.lane[l] = x;
        ahead->z.lane[l] = z;
        batch->gain_mps2.lane[l] = (forward->lane[l] - before->lane[l]) / dt_s;
    }
}

/* Takes away the lanes whose point is in a ford too deep for the kind. */
static void heed_fords(const struct step_context *context, const struct ground_vehicle *batch,
                       const union simd_lanes *x, const union simd_lanes *z, union lane_masks *pass)
{
    const struct terrain *terrain = &context->world->terrain;
    for (int l = 0; l < batch->count; l++) {
        const struct kind *kind = &context->world->kinds[context->m->row[batch->row[l]].kind];
        if (batch->pose.cratered.lane[l] &&
            terrain_water_depth(terrain, x->lane[l], z->lane[l]) > kind->ford_m)
            pass->lane[l] = 0;
    }
}

/* Tests whether the point is in the world and on dry land, or in a ford that the kind can cross.
 * dry: there is no water near. */
static inline void passable(const struct step_context *context, const struct ground_vehicle *batch,
                            const union simd_lanes *x, const union simd_lanes *z, bool dry,
                            union lane_masks *pass)
{
    const double side_m = context->world->terrain.squares.world_m;
    if (dry)
        memset(pass, 0, sizeof *pass);
    else
        terrain_cache_water(&context->world->terrain, &batch->pose.ground, x, z, pass);
    for (int h = 0; h < LANE_FOURS; h++)
        pass->f64x4[h] = ~pass->f64x4[h] & (x->f64x4[h] >= 0.0) & (z->f64x4[h] >= 0.0) &
                         (x->f64x4[h] <= side_m) & (z->f64x4[h] <= side_m);
    if (context->world->terrain.earthworks.count > 0)
        heed_fords(context, batch, x, z, pass);
}

/* Lets the lanes brake that have water where they would come to a stop: a driver sees it. before:
 * their speeds when the frame begins. */
static void brake_for_water(const struct step_context *context, struct ground_vehicle *batch,
                            const union simd_lanes *before, struct ahead *ahead)
{
    const double dt_s = ground_vehicle_time_s(context, batch);
    for (int l = 0; l < batch->count; l++) {
        double sine = batch->pose.sine.lane[l], cosine = batch->pose.cosine.lane[l];
        double x = batch->pose.x.lane[l], z = batch->pose.z.lane[l], forward = before->lane[l];
        double hardest =
            maths_min(BRAKES * batch->acceleration.lane[l], GROUND_GRIP * GRAVITY_MPS2);
        double way = batch->half_length.lane[l] + forward * forward / (2.0 * hardest);
        way = forward < 0.0 ? -way : way;
        double slower = kinematics_approach(forward, 0.0, hardest * dt_s);
        double now = batch->vx.lane[l] * sine - batch->vz.lane[l] * cosine;
        if (batch->pose.ground.patch[l]->water == 0 || now * forward <= 0.0 ||
            fabs(now) <= fabs(slower) ||
            !cover_is_water(
                terrain_cover(&context->world->terrain, x + way * sine, z - way * cosine)))
            continue;
        double less_x = (slower - now) * sine, less_z = (now - slower) * cosine;
        batch->vx.lane[l] += less_x;
        batch->vz.lane[l] += less_z;
        ahead->x.lane[l] += less_x * dt_s;
        ahead->z.lane[l] += less_z * dt_s;
        ahead->lead_x.lane[l] += less_x * dt_s;
        ahead->lead_z.lane[l] += less_z * dt_s;
    }
}

/* Finds the lanes that come to water so fast that their brakes do not stop them in the frame. They
 * go on as far as their kind can ford. */
static void run_into_water(const struct step_context *context, struct ground_vehicle *batch,
                           const struct ahead *ahead, union lane_masks *stays)
{
    const double stops_mps = GROUND_GRIP * GRAVITY_MPS2 * ground_vehicle_time_s(context, batch);
    for (int l = 0; l < batch->count; l++) {
        const struct kind *kind = &context->world->kinds[context->m->row[batch->row[l]].kind];
        double vx = batch->vx.lane[l], vz = batch->vz.lane[l];
        if (!stays->lane[l] || vx * vx + vz * vz <= stops_mps * stops_mps ||
            !fording_passable(context, kind, ahead->x.lane[l], ahead->z.lane[l]) ||
            !fording_passable(context, kind, ahead->lead_x.lane[l], ahead->lead_z.lane[l]))
            continue;
        stays->lane[l] = 0;
        batch->wades.lane[l] = -1;
    }
}

/* Moves the vehicle there unless it is blocked. */
static inline void change_position(const struct step_context *context, struct ground_vehicle *batch,
                                   const union simd_lanes *before, struct ahead *ahead)
{
    const f64x4 none = SIMD_EVERY(0.0);
    union lane_masks pass, lead_pass, stays;
    four_masks any = {0};
    terrain_cache_find(&context->world->terrain, &batch->pose.ground, &ahead->x, &ahead->z);
    bool dry =
        terrain_cache_dry(&context->world->terrain, &batch->pose.ground, &batch->half_length);
    if (!dry && batch->frames == 1)
        brake_for_water(context, batch, before, ahead);
    passable(context, batch, &ahead->x, &ahead->z, dry, &pass);
    passable(context, batch, &ahead->lead_x, &ahead->lead_z, dry, &lead_pass);
    memset(&batch->wades, 0, sizeof batch->wades);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 x = batch->pose.x.f64x4[h], z = batch->pose.z.f64x4[h];
        four_masks moves = (ahead->x.f64x4[h] != x) | (ahead->z.f64x4[h] != z);
        stays.f64x4[h] = moves & ~(pass.f64x4[h] & lead_pass.f64x4[h]);
        batch->blocked.f64x4[h] |= stays.f64x4[h];
        any |= stays.f64x4[h];
    }
    if (SIMD_ANY(any))
        run_into_water(context, batch, ahead, &stays);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 x = batch->pose.x.f64x4[h], z = batch->pose.z.f64x4[h];
        batch->pose.x.f64x4[h] = SIMD_CHOOSE(stays.f64x4[h], x, ahead->x.f64x4[h]);
        batch->pose.z.f64x4[h] = SIMD_CHOOSE(stays.f64x4[h], z, ahead->z.f64x4[h]);
        batch->vx.f64x4[h] = SIMD_CHOOSE(stays.f64x4[h], none, batch->vx.f64x4[h]);
        batch->vz.f64x4[h] = SIMD_CHOOSE(stays.f64x4[h], none, batch->vz.f64x4[h]);
        /* Points that are further from the start are beyond the start square's crater mark. */
        f64x4 far = SIMD_ABS(batch->pose.x.f64x4[h] - x) + SIMD_ABS(batch->pose.z.f64x4[h] - z) +
                    batch->pose.half_length.f64x4[h] + batch->pose.half_width.f64x4[h];
        batch->pose.cratered.f64x4[h] |= ~(far < GROUND_MARKS_NEAR_M);
    }
}

#define EASE_RPS 0.04 /* as fast a vehicle that comes back takes the angles of the ground */

/* Returns the pose of a row that comes back to that of the ground. before, now: of the ground, at
 * its old and at its new place. */
static struct rest_pose eased(const struct step_context *context, uint32_t i,
                              const struct rest_pose *before, const struct rest_pose *now)
{
    const struct entities *w = &context->committed->entities;
    const double most_m = GROUND_VEHICLE_EASE_MPS * context->dt_s,
                 most_rad = EASE_RPS * context->dt_s;
    return (struct rest_pose){
        now->y_m + kinematics_approach(w->row[i].y - before->y_m, 0.0, most_m),
        now->pitch_rad + kinematics_approach(w->row[i].pitch - before->pitch_rad, 0.0, most_rad),
        now->roll_rad + kinematics_approach(w->row[i].roll - before->roll_rad, 0.0, most_rad)};
}

void ground_vehicle_ease(const struct step_context *context, uint32_t i,
                         const struct rest_pose *before, const struct rest_pose *now)
{
    struct entities *m = context->m;
    const struct rest_pose to = eased(context, i, before, now);
    m->row[i].y = to.y_m;
    m->row[i].pitch = to.pitch_rad;
    m->row[i].roll = to.roll_rad;
    m->row[i].spin_x = m->row[i].spin_y = m->row[i].spin_z = 0.0;
    if (to.y_m == now->y_m && to.pitch_rad == now->pitch_rad && to.roll_rad == now->roll_rad)
        m->row[i].flags &= (uint8_t)~ENTITY_FLAG_CHASSIS;
}

/* Returns how the ground bears the row where it has moved to. */
static struct rest_pose ground_of(const struct ground_vehicle *batch, int l)
{
    return (struct rest_pose){batch->pose.y.lane[l], batch->pose.pitch.lane[l],
                              batch->pose.roll.lane[l]};
}

/* The same where the row was when the frame began. */
static struct rest_pose ground_before(const struct step_context *context, uint32_t i)
{
    const struct entities *w = &context->committed->entities;
    return rest_pose_of(&context->world->terrain, context->craters,
                        &context->world->kinds[context->m->row[i].kind], w->row[i].x, w->row[i].z,
                        w->row[i].heading);
}

/* Returns the pose that the ground gives the row, which has moved. */
static struct rest_pose set_on(const struct step_context *context,
                               const struct ground_vehicle *batch, int l)
{
    const uint32_t i = batch->row[l];
    const struct rest_pose ground = ground_of(batch, l);
    if (!(context->m->row[i].flags & ENTITY_FLAG_CHASSIS))
        return ground;
    const struct rest_pose before = ground_before(context, i);
    return eased(context, i, &before, &ground);
}

static void set_down(const struct step_context *context, const struct ground_vehicle *batch, int l)
{
    struct entities *m = context->m;
    const struct rest_pose ground = ground_of(batch, l);
    uint32_t i = batch->row[l];
    if (m->row[i].flags & ENTITY_FLAG_CHASSIS) {
        const struct rest_pose before = ground_before(context, i);
        ground_vehicle_ease(context, i, &before, &ground);
        return;
    }
    m->row[i].y = ground.y_m;
    m->row[i].pitch = ground.pitch_rad;
    m->row[i].roll = ground.roll_rad;
}

/* Returns how fast a row climbs that leaves the ground with this pitch [m/s]. */
static double climb_of(const struct ground_vehicle *batch, int l, double heading, double pitch)
{
    double sine, cosine;
    maths_sincos(heading, &sine, &cosine);
    return (batch->vx.lane[l] * sine - batch->vz.lane[l] * cosine) * pitch *
           (1.0 + pitch * pitch / 3.0);
}

#define LEAVES_DEEP_M 0.01 /* from this depth the ground pushes a shell out that leaves it */

/* How a row that has moved gets into the ground. */
enum entry { STAYS_OUT, LEAVES_HERE, LEAVES_BEFORE };

/* Looks whether the row, which has moved, has a corner of its shell in the ground of a hollow, a
 * work or a crater, or would have one if it left the ground in the next frame. It then leaves the
 * ground here, if it has none in it so, or where it was before the frame. One that was put down in
 * the ground goes on until it is out. bends: the natural ground bends so much that the sides of the
 * shell may get into it, too; works and craters lift a vehicle by its corners. */
static enum entry entry_of(const struct step_context *context, const struct ground_vehicle *batch,
                           int l, bool bends)
{
    const uint32_t i = batch->row[l];
    const struct entities *w = &context->committed->entities, *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    const struct terrain *terrain = &context->world->terrain;
    const struct ground_pose *pose = &batch->pose;
    const struct crater_index *craters = pose->cratered.lane[l] ? context->craters : NULL;
    const uint32_t points = bends ? VEHICLE_SHELL_SIDES : VEHICLE_SHELL_ENDS;
    const double heading = batch->heading.lane[l], dt_s = ground_vehicle_time_s(context, batch);
    const struct rest_pose stands = set_on(context, batch, l);
    struct vec3 at = {pose->x.lane[l], stands.y_m, pose->z.lane[l]};
    const struct vec3 way = {batch->vx.lane[l] * dt_s,
                             climb_of(batch, l, heading, stands.pitch_rad) * dt_s,
                             batch->vz.lane[l] * dt_s};
    struct mat3 turn = rotation_matrix(rotation_of(heading, stands.pitch_rad, stands.roll_rad));
    if (vehicle_shell_depth(terrain, craters, kind, points, at, &turn) <= 0.0 &&
        vehicle_shell_depth(terrain, craters, kind, points, vec3_add(at, way), &turn) <= 0.0)
        return STAYS_OUT;
    turn = rotation_matrix(rotation_of(heading, batch->pitch.lane[l], w->row[i].roll));
    at.y = batch->y.lane[l] + climb_of(batch, l, heading, batch->pitch.lane[l]) * dt_s;
    if (vehicle_shell_depth(terrain, craters, kind, points, at, &turn) <= 0.0)
        return LEAVES_HERE;
    turn = rotation_matrix(rotation_of(m->row[i].heading, batch->pitch.lane[l], w->row[i].roll));
    at = (struct vec3){m->row[i].x, batch->y.lane[l], m->row[i].z};
    return pose->cratered.lane[l] &&
                   vehicle_shell_depth(terrain, craters, kind, points, at, &turn) <= LEAVES_DEEP_M
               ? LEAVES_BEFORE
               : STAYS_OUT;
}

static inline void find_hollows(const struct step_context *context, struct ground_vehicle *batch)
{
    union simd_lanes bend;
    four_masks any = {0};
    terrain_cache_bends(&batch->pose.ground, &bend);
    for (int h = 0; h < LANE_FOURS; h++)
        any |= (bend.f64x4[h] > batch->bend.f64x4[h]) | batch->pose.cratered.f64x4[h];
    if (!SIMD_ANY(any))
        return;
    for (int l = 0; l < batch->count; l++) {
        bool bends = bend.lane[l] > batch->bend.lane[l];
        if (!bends && !batch->pose.cratered.lane[l])
            continue;
        enum entry entry = entry_of(context, batch, l, bends);
        batch->rough.lane[l] |= -(int64_t)(entry != STAYS_OUT);
        batch->walled.lane[l] = -(int64_t)(entry == LEAVES_BEFORE);
    }
}

#define LIFTS_MPS 0.3 /* edges under a vehicle that follows the ground lift it no faster */

/* Finds the lanes that a crater or a work lifts so fast that it would be a jump. */
static void find_jolts(const struct step_context *context, struct ground_vehicle *batch)
{
    const struct entities *m = context->m;
    const double most_m = LIFTS_MPS * context->dt_s;
    for (int l = 0; l < batch->count; l++) {
        const uint32_t i = batch->row[l];
        struct crater_footing before = {.x = m->row[i].x,
                                        .z = m->row[i].z,
                                        .half_length = batch->pose.half_length.lane[l],
                                        .half_width = batch->pose.half_width.lane[l]};
        if (batch->rough.lane[l] || batch->pose.lift.lane[l] <= most_m)
            continue;
        maths_sincos(m->row[i].heading, &before.sine, &before.cosine);
        if (batch->pose.lift.lane[l] - most_m >
            terrain_lift(&context->world->terrain, context->craters, &before))
            batch->rough.lane[l] = -1;
    }
}

/* Returns true if the tyres of the row, which leans much, do not hold it there as it drives. */
static bool slides(const struct step_context *context, const struct ground_vehicle *batch, int l,
                   double forward)
{
    const struct entities *m = context->m;
    const uint32_t i = batch->row[l];
    const double dt_s = ground_vehicle_time_s(context, batch);
    const double before =
        m->row[i].vx * batch->pose.sine.lane[l] - m->row[i].vz * batch->pose.cosine.lane[l];
    const double turned = maths_wrap_half(batch->heading.lane[l] - m->row[i].heading);
    const struct chassis_slope slope = {.pitch_rad = batch->pose.pitch.lane[l],
                                        .roll_rad = batch->pose.roll.lane[l],
                                        .gain_mps2 = (forward - before) / dt_s,
                                        .lateral_mps2 = forward * turned / dt_s};
    return !chassis_holds(
        &context->world->kinds[m->row[i].kind],
        ground_grip_at(context, batch->pose.x.lane[l], batch->pose.z.lane[l]).friction, &slope);
}

/* Finds the lanes that lean so much that their tyres do not hold them. */
static inline void find_slides(const struct step_context *context, struct ground_vehicle *batch,
                               const union simd_lanes *forward)
{
    const f64x4 tilt = SIMD_EVERY(CHASSIS_TILT_RAD);
    union lane_masks leans;
    four_masks any = {0};
    for (int h = 0; h < LANE_FOURS; h++) {
        leans.f64x4[h] = (SIMD_ABS(batch->pose.pitch.f64x4[h]) > tilt) |
                         (SIMD_ABS(batch->pose.roll.f64x4[h]) > tilt);
        any |= leans.f64x4[h];
    }
    memset(&batch->slides, 0, sizeof batch->slides);
    for (int l = 0; SIMD_ANY(any) && l < batch->count; l++) {
        if (leans.lane[l] && !batch->rough.lane[l])
            batch->slides.lane[l] = -(int64_t)slides(context, batch, l, forward->lane[l]);
        batch->rough.lane[l] |= batch->slides.lane[l];
    }
}

/* Finds the lanes whose ground is too rough for a body that follows it: it slides, crosses the edge
 * of a crater, runs into water, leaves the ground over a crest, or gets into that of a hollow. */
static inline void find_rough(const struct step_context *context, struct ground_vehicle *batch,
                              const union simd_lanes *forward)
{
    const double dt_s = ground_vehicle_time_s(context, batch);
    const f64x4 step = SIMD_EVERY(CHASSIS_STEP_M), lift = SIMD_EVERY(CHASSIS_LIFT_M);
    const f64x4 fall = SIMD_EVERY(GRAVITY_MPS2 * dt_s);
    memset(&batch->walled, 0, sizeof batch->walled);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 drop = forward->f64x4[h] * (batch->pitch.f64x4[h] - batch->pose.pitch.f64x4[h]);
        batch->rough.f64x4[h] = batch->wades.f64x4[h] | (batch->pose.step.f64x4[h] > step) |
                                (batch->pose.lift.f64x4[h] > lift) | (drop > fall);
    }
    if (batch->frames == 1) {
        find_hollows(context, batch);
        find_jolts(context, batch);
    }
    find_slides(context, batch, forward);
}

/* A row that comes back from its springs to ground that is too rough for it stays on them. It goes
 * on with the speed and the spin that they gave it, so that the turn and the pull of a vehicle that
 * follows the ground, which take no time, are not added to them. */
static void keep_sprung(const struct step_context *context, struct ground_vehicle *batch)
{
    for (int l = 0; l < batch->count; l++) {
        const bool comes_back = context->m->row[batch->row[l]].flags & ENTITY_FLAG_CHASSIS;
        batch->refused.lane[l] = comes_back ? batch->rough.lane[l] : 0;
    }
}

/* Makes a row on rough ground a body on its springs. One that slides stands on the ground, and goes
 * on along it. Others go on as before: an edge under them has lifted them by geometry, which must
 * not become a speed. They do not get into a wall. */
static void leave_rails(const struct step_context *context, const struct ground_vehicle *batch,
                        int l, double turned_rad)
{
    uint32_t i = batch->row[l];
    struct entities *m = context->m;
    if (!batch->rough.lane[l])
        return;
    chassis_disturb(context, i);
    m->row[i].spin_y = -maths_wrap_half(turned_rad) / context->dt_s;
    if (batch->slides.lane[l]) {
        m->row[i].vy = climb_of(batch, l, m->row[i].heading, m->row[i].pitch);
        return;
    }
    double pitch = batch->pitch.lane[l], climb = climb_of(batch, l, m->row[i].heading, pitch);
    m->row[i].vy = climb;
    m->row[i].y = batch->y.lane[l] + climb * context->dt_s;
    m->row[i].pitch = pitch;
    m->row[i].roll = context->committed->entities.row[i].roll;
    if (batch->walled.lane[l])
        m->row[i].y = batch->y.lane[l];
}

/* --- rows --------------------------------------------------------------------------------------*/

static void write_rows(const struct step_context *context, const struct ground_vehicle *batch)
{
    struct entities *m = context->m;
    const double dt_s = ground_vehicle_time_s(context, batch);
    for (int l = 0; l < batch->count; l++) {
        uint32_t i = batch->row[l];
        double turned = batch->heading.lane[l] - m->row[i].heading;
        if (batch->refused.lane[l])
            continue;
        if (batch->frames > 1)
            kinematics_cruise(context, i,
                              &(struct cruise_changes){.frames = batch->frames,
                                                       .turned_rad = batch->turned.lane[l],
                                                       .gain_mps2 = batch->gain_mps2.lane[l]});
        else
            m->row[i].cruise_tick = 0;
        set_down(context, batch, l);
        if (!batch->walled.lane[l]) {
            m->row[i].x = batch->pose.x.lane[l];
            m->row[i].z = batch->pose.z.lane[l];
            m->row[i].heading = batch->heading.lane[l];
        }
        m->row[i].vx = batch->vx.lane[l];
        m->row[i].vy = (m->row[i].y - batch->y.lane[l]) / dt_s;
        m->row[i].vz = batch->vz.lane[l];
        m->row[i].fuel_l = batch->fuel.lane[l];
        leave_rails(context, batch, l, turned);
    }
}

VECTOR_CLONES
void ground_vehicle_move(const struct step_context *context, struct ground_vehicle *batch)
{
    union simd_lanes sine, cosine, forward, rightward, under_power, heading;
    struct ahead ahead;
    const double dt_s = ground_vehicle_time_s(context, batch);
    find_scars(context, batch);
    heading = batch->heading;
    maths_sincos_lanes(&batch->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        find_desired(batch, h, dt_s);
        f64x4 wanted = batch->wanted_mps.f64x4[h];
        f64x4 vx = batch->vx.f64x4[h], vz = batch->vz.f64x4[h];
        forward.f64x4[h] = vx * sine.f64x4[h] - vz * cosine.f64x4[h];
        rightward.f64x4[h] = vx * cosine.f64x4[h] + vz * sine.f64x4[h];
        burn(batch, h, &wanted, dt_s);
        limit(batch, h, &wanted);
        under_power.f64x4[h] = forward.f64x4[h];
        power(batch, h, &wanted, &under_power.f64x4[h], dt_s);
        steer(batch, h, &forward.f64x4[h], &under_power.f64x4[h], dt_s);
    }
    if (memcmp((const unsigned char *)&heading, (const unsigned char *)&batch->heading,
               sizeof heading) == 0)
        batch->pose.sine = sine, batch->pose.cosine = cosine;
    else
        maths_sincos_lanes(&batch->heading, &batch->pose.sine, &batch->pose.cosine);
    find_ahead(context, batch, &under_power, &rightward, &ahead);
    if (batch->frames > 1)
        find_arc_end(context, batch, &forward, &under_power, &heading, &ahead);
    change_position(context, batch, &forward, &ahead);
    ground_pose_find(context, &batch->pose);
    find_rough(context, batch, &under_power);
    if (batch->frames > 1)
        ground_stretch_refuse(context, batch, &rightward);
    else
        keep_sprung(context, batch);
    write_rows(context, batch);
}
