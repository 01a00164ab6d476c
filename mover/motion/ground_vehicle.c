/* Moves land vehicles: steering, power and brakes, slopes, debris and water. */
#include "mover/motion/ground_vehicle.h"

#include "mover/motion/kinematics.h"
#include "mover/motion/kinematics_simd.h"
#include "mover/query/ground_marks.h"
#include "world/maths/cpu_dispatch.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <string.h>

#define CRAWL_SHARE   0.1  /* share of full speed that is left on the steepest slope */
#define STANDING_TURN 0.35 /* share of the turn rate at rest */
#define FULL_TURN_MPS 4.0  /* from this speed on the turn rate is full */
#define LOW_CLIMB     1.2  /* share of max_slope_rad that low gear climbs at full speed */
#define ENGINE_DRAG   0.5  /* share of the acceleration: braking when the throttle is released */
#define ROLLING       0.03 /* share of the weight: braking in neutral */

/* The share of full speed that the debris of an object leaves a vehicle which pushes it along: the
 * vehicle shares its momentum with the loose part, 1 - debris_keep, of the debris in its way. The
 * debris lies evenly over the object's rectangle. */
static double debris_speed(const struct kind *vehicle, const struct kind *object)
{
    double loose_kg = object->mass_kg * (1.0 - object->debris_keep);
    double covered = vehicle->length_m * vehicle->width_m / (object->length_m * object->width_m);
    return vehicle->mass_kg / (vehicle->mass_kg + loose_kg * maths_min(1.0, covered));
}

/* The share of full speed that the debris of fallen objects allows the vehicle here; 1: there is
 * none. */
static double debris_share(const struct step_context *context, const struct kind *vehicle, double x,
                           double z)
{
    const struct world *world = context->world;
    const struct state *committed = context->committed;
    double share = 1.0;
    const uint32_t *objects;
    uint32_t count = world_reach(world, gridsquare_of(x, z), &objects);
    for (uint32_t n = 0; n < count; n++) {
        if (committed->fixed_damage[objects[n]] < DAMAGE_HIGH)
            continue;
        const struct fixed_object *object = &world->fixed[objects[n]];
        double dx = x - object->x, dz = z - object->z, radius = (double)object->radius_m;
        if (dx * dx + dz * dz < radius * radius)
            share = maths_min(share, debris_speed(vehicle, &world->kinds[object->kind]));
    }
    return share;
}

void ground_vehicle_begin(struct ground_vehicle *batch)
{
    memset(batch, 0, sizeof *batch);
    ground_pose_begin(&batch->pose);
}

static void find_scars(const struct step_context *context, struct ground_vehicle *batch)
{
    const struct ground_pose *pose = &batch->pose;
    union lane_masks debris;
    ground_marks_find(context->ground_marks, &pose->x, &pose->z, &batch->pose.cratered, &debris);
    for (int l = 0; l < LANE_COUNT; l++) {
        batch->debris.lane[l] = 1.0;
        if (!debris.lane[l])
            continue;
        const struct kind *kind = &context->world->kinds[context->m->kind[batch->row[l]]];
        batch->debris.lane[l] = debris_share(context, kind, pose->x.lane[l], pose->z.lane[l]);
    }
}

static void take_kind(struct ground_vehicle *batch, int l, const struct kind *kind)
{
    batch->full_mps.lane[l] = kind->max_speed_mps;
    batch->acceleration.lane[l] = kind->acceleration_mps2;
    batch->turn_rate.lane[l] = kind->turn_rate_rps;
    batch->max_slope.lane[l] = kind->max_slope_rad;
    batch->half_length.lane[l] = kind->length_m * 0.5;
    batch->burn_lps.lane[l] = kind->fuel_lps;
    batch->tank.lane[l] = -(int64_t)(kind->fuel_l > 0.0);
}

/* Fills what does not depend on the desired motion, and returns the lane. */
static inline int take_row(const struct step_context *context, struct ground_vehicle *batch,
                           uint32_t i)
{
    const struct entities *m = context->m;
    int l = batch->count++;
    if (ground_pose_take(context, &batch->pose, l, i))
        take_kind(batch, l, &context->world->kinds[m->kind[i]]);
    batch->row[l] = i;
    batch->y.lane[l] = m->y[i];
    batch->vx.lane[l] = m->vx[i];
    batch->vz.lane[l] = m->vz[i];
    batch->heading.lane[l] = m->heading[i];
    batch->pitch.lane[l] = m->pitch[i];
    batch->fuel.lane[l] = m->fuel_l[i];
    return l;
}

bool ground_vehicle_take(const struct step_context *context, struct ground_vehicle *batch,
                         uint32_t i, const struct desired_motion *desired)
{
    int l = take_row(context, batch, i);
    batch->held.lane[l] = 0;
    batch->out_of_gear[l] = desired->gear == GEAR_NEUTRAL;
    batch->low_gear.lane[l] = -(int64_t)(desired->gear == GEAR_LOW);
    batch->driven.lane[l] = -(int64_t)desired->driven;
    batch->wanted_heading.lane[l] = desired->heading_rad;
    batch->wanted_mps.lane[l] = desired->speed_mps;
    batch->turn.lane[l] = desired->turn;
    batch->brake.lane[l] = desired->brake;
    return batch->count == LANE_COUNT;
}

bool ground_vehicle_take_held(const struct step_context *context, struct ground_vehicle *batch,
                              uint32_t i)
{
    int l = take_row(context, batch, i);
    batch->turn.lane[l] = (double)context->m->steer[i];
    batch->wanted_mps.lane[l] = (double)context->m->throttle[i];
    if (batch->held.lane[l] == 0) {
        batch->held.lane[l] = -1;
        batch->out_of_gear[l] = false;
        batch->low_gear.lane[l] = batch->driven.lane[l] = 0;
        batch->brake.lane[l] = 0.0;
    }
    return batch->count == LANE_COUNT;
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

/* Steers as kinematics_steer() does. */
static inline void steer(struct ground_vehicle *batch, int h, const f64x4 *forward, double dt_s)
{
    f64x4 agility = STANDING_TURN + (1.0 - STANDING_TURN) * SIMD_ABS(*forward) / FULL_TURN_MPS;
    agility = SIMD_CLAMP(agility, SIMD_EVERY(0.0), SIMD_EVERY(1.0));
    f64x4 rate = batch->turn_rate.f64x4[h] * agility;
    struct kinematics_simd_helm helm = {batch->wanted_heading.f64x4[h], batch->turn.f64x4[h],
                                        batch->driven.f64x4[h]};
    kinematics_simd_steer(&batch->heading.f64x4[h], &helm, &rate, dt_s);
}

/* Burns fuel for the desired speed as kinematics_burn() does. Without fuel the speed is 0. */
static inline void burn(struct ground_vehicle *batch, int h, f64x4 *wanted, double dt_s)
{
    const f64x4 none = SIMD_EVERY(0.0), least = SIMD_EVERY(1e-9);
    f64x4 share = SIMD_ABS(*wanted) / SIMD_MAX(batch->full_mps.f64x4[h], least);
    four_masks dry;
    kinematics_simd_burn(&batch->fuel.f64x4[h], &batch->burn_lps.f64x4[h], &share,
                         &batch->tank.f64x4[h], dt_s, &dry);
    *wanted = SIMD_CHOOSE(dry, none, *wanted);
}

/* Limits the speed by slope and debris. On a slope that the kind cannot climb the speed is 0 and
 * the vehicle is blocked. */
static inline void limit(struct ground_vehicle *batch, int h, f64x4 *wanted)
{
    const f64x4 none = SIMD_EVERY(0.0);
    f64x4 full = batch->full_mps.f64x4[h], max_slope = batch->max_slope.f64x4[h];
    f64x4 pitch = batch->pitch.f64x4[h];
    f64x4 climb = SIMD_CHOOSE(*wanted < 0.0, SIMD_NEGATIVE(pitch), pitch);
    f64x4 crawling = full * (1.0 - (1.0 - CRAWL_SHARE) * climb / max_slope);
    crawling = SIMD_CHOOSE(climb >= max_slope, none, crawling);
    f64x4 low = SIMD_CHOOSE(climb < LOW_CLIMB * max_slope, full, none);
    f64x4 most = SIMD_CHOOSE(batch->low_gear.f64x4[h], low, crawling);
    most = SIMD_CHOOSE(climb <= none, full, most);
    batch->blocked.f64x4[h] = (SIMD_ABS(*wanted) > none) & (most <= none);
    f64x4 in_debris = batch->debris.f64x4[h] * full;
    most = SIMD_MIN(most, in_debris);
    f64x4 least = SIMD_NEGATIVE(most);
    *wanted = SIMD_CLAMP(*wanted, least, most);
}

/* The speed along the heading after the step, in gear. Braking is as in kinematics_slowing(). */
static inline void power(const struct ground_vehicle *batch, int h, const f64x4 *wanted,
                         f64x4 *forward, double dt_s)
{
    const f64x4 none = SIMD_EVERY(0.0), grip = SIMD_EVERY(GROUND_GRIP * GRAVITY_MPS2);
    f64x4 desired = batch->wanted_mps.f64x4[h], rate = batch->acceleration.f64x4[h];
    four_masks braking = (SIMD_ABS(*wanted) < SIMD_ABS(*forward)) | (*wanted * *forward < none);
    four_masks held = SIMD_ABS(*wanted) < SIMD_ABS(desired); /* the ground slows it as well */
    f64x4 hardest = BRAKES * rate;
    f64x4 drag = SIMD_CHOOSE(held, hardest, ENGINE_DRAG * rate);
    f64x4 rest = hardest - drag;
    f64x4 slowing = drag + batch->brake.f64x4[h] * SIMD_MAX(none, rest);
    slowing = SIMD_CHOOSE(batch->driven.f64x4[h] & ~(desired * *forward < none), slowing, hardest);
    slowing = SIMD_MIN(slowing, grip);
    f64x4 step = SIMD_CHOOSE(braking, slowing, rate) * dt_s;
    kinematics_simd_approach(forward, wanted, &step);
}

/* --- lanes -------------------------------------------------------------------------------------*/

/* The same out of gear, where the slope accelerates and the wheels and the brake slow. */
static double rolling(const struct step_context *context, const struct ground_vehicle *batch, int l,
                      double forward)
{
    double pull = -GRAVITY_MPS2 * maths_sin(batch->pitch.lane[l]);
    double drag =
        ROLLING * GRAVITY_MPS2 + batch->brake.lane[l] * (BRAKES * batch->acceleration.lane[l]);
    forward = kinematics_approach(forward + pull * context->dt_s, 0.0, drag * context->dt_s);
    return maths_clamp(forward, -batch->full_mps.lane[l], batch->full_mps.lane[l]);
}

/* The position after the step, and that of the end of the body that leads. */
struct ahead {
    union simd_lanes x, z, lead_x, lead_z;
};

static inline void find_ahead(const struct step_context *context, struct ground_vehicle *batch,
                              const union simd_lanes *forward, union simd_lanes *rightward,
                              struct ahead *ahead)
{
    const f64x4 none = SIMD_EVERY(0.0);
    const f64x4 grip = SIMD_EVERY(GROUND_GRIP * GRAVITY_MPS2 * context->dt_s);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 sine = batch->pose.sine.f64x4[h], cosine = batch->pose.cosine.f64x4[h];
        f64x4 speed = forward->f64x4[h], half = batch->half_length.f64x4[h];
        kinematics_simd_approach(&rightward->f64x4[h], &none, &grip);
        batch->vx.f64x4[h] = speed * sine + rightward->f64x4[h] * cosine;
        batch->vz.f64x4[h] = SIMD_NEGATIVE(speed) * cosine + rightward->f64x4[h] * sine;
        ahead->x.f64x4[h] = batch->pose.x.f64x4[h] + batch->vx.f64x4[h] * context->dt_s;
        ahead->z.f64x4[h] = batch->pose.z.f64x4[h] + batch->vz.f64x4[h] * context->dt_s;
        f64x4 lead = SIMD_CHOOSE(speed < none, SIMD_NEGATIVE(half), half);
        ahead->lead_x.f64x4[h] = ahead->x.f64x4[h] + sine * lead;
        ahead->lead_z.f64x4[h] = ahead->z.f64x4[h] - cosine * lead;
    }
}

/* Tests whether the point is in the world and on dry land. */
static inline void passable(const struct step_context *context, const struct ground_vehicle *batch,
                            const union simd_lanes *x, const union simd_lanes *z,
                            union lane_masks *pass)
{
    terrain_cache_water(&context->world->terrain, &batch->pose.ground, x, z, pass);
    for (int h = 0; h < LANE_FOURS; h++)
        pass->f64x4[h] = ~pass->f64x4[h] & (x->f64x4[h] >= 0.0) & (z->f64x4[h] >= 0.0) &
                         (x->f64x4[h] <= WORLD_SIDE_M) & (z->f64x4[h] <= WORLD_SIDE_M);
}

/* Moves the vehicle there unless it is blocked. */
static inline void change_position(const struct step_context *context, struct ground_vehicle *batch,
                                   const struct ahead *ahead)
{
    const f64x4 none = SIMD_EVERY(0.0);
    union lane_masks pass, lead_pass;
    terrain_cache_find(&context->world->terrain, &batch->pose.ground, &ahead->x, &ahead->z);
    passable(context, batch, &ahead->x, &ahead->z, &pass);
    passable(context, batch, &ahead->lead_x, &ahead->lead_z, &lead_pass);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 x = batch->pose.x.f64x4[h], z = batch->pose.z.f64x4[h];
        four_masks moves = (ahead->x.f64x4[h] != x) | (ahead->z.f64x4[h] != z);
        four_masks stays = moves & ~(pass.f64x4[h] & lead_pass.f64x4[h]);
        batch->blocked.f64x4[h] |= stays;
        batch->pose.x.f64x4[h] = SIMD_CHOOSE(stays, x, ahead->x.f64x4[h]);
        batch->pose.z.f64x4[h] = SIMD_CHOOSE(stays, z, ahead->z.f64x4[h]);
        batch->vx.f64x4[h] = SIMD_CHOOSE(stays, none, batch->vx.f64x4[h]);
        batch->vz.f64x4[h] = SIMD_CHOOSE(stays, none, batch->vz.f64x4[h]);
        /* Points that are further from the start are beyond the start square's crater mark. */
        f64x4 far = SIMD_ABS(batch->pose.x.f64x4[h] - x) + SIMD_ABS(batch->pose.z.f64x4[h] - z) +
                    batch->pose.half_length.f64x4[h] + batch->pose.half_width.f64x4[h];
        batch->pose.cratered.f64x4[h] |= ~(far < GROUND_MARKS_NEAR_M);
    }
}

static void write_rows(const struct step_context *context, const struct ground_vehicle *batch)
{
    struct entities *m = context->m;
    for (int l = 0; l < batch->count; l++) {
        uint32_t i = batch->row[l];
        m->x[i] = batch->pose.x.lane[l];
        m->y[i] = batch->pose.y.lane[l];
        m->z[i] = batch->pose.z.lane[l];
        m->vx[i] = batch->vx.lane[l];
        m->vy[i] = (batch->pose.y.lane[l] - batch->y.lane[l]) / context->dt_s;
        m->vz[i] = batch->vz.lane[l];
        m->heading[i] = batch->heading.lane[l];
        m->pitch[i] = batch->pose.pitch.lane[l];
        m->roll[i] = batch->pose.roll.lane[l];
        m->fuel_l[i] = batch->fuel.lane[l];
    }
}

VECTOR_CLONES
void ground_vehicle_move(const struct step_context *context, struct ground_vehicle *batch)
{
    union simd_lanes sine, cosine, forward, rightward, under_power;
    struct ahead ahead;
    find_scars(context, batch);
    maths_sincos_lanes(&batch->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        find_desired(batch, h, context->dt_s);
        f64x4 wanted = batch->wanted_mps.f64x4[h];
        f64x4 vx = batch->vx.f64x4[h], vz = batch->vz.f64x4[h];
        forward.f64x4[h] = vx * sine.f64x4[h] - vz * cosine.f64x4[h];
        rightward.f64x4[h] = vx * cosine.f64x4[h] + vz * sine.f64x4[h];
        steer(batch, h, &forward.f64x4[h], context->dt_s);
        burn(batch, h, &wanted, context->dt_s);
        limit(batch, h, &wanted);
        under_power.f64x4[h] = forward.f64x4[h];
        power(batch, h, &wanted, &under_power.f64x4[h], context->dt_s);
    }
    for (int l = 0; l < batch->count; l++) {
        if (batch->out_of_gear[l])
            under_power.lane[l] = rolling(context, batch, l, forward.lane[l]);
    }
    maths_sincos_lanes(&batch->heading, &batch->pose.sine, &batch->pose.cosine);
    find_ahead(context, batch, &under_power, &rightward, &ahead);
    change_position(context, batch, &ahead);
    ground_pose_find(context, &batch->pose);
    write_rows(context, batch);
}
