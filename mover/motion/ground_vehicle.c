/* Ground vehicles: they follow the terrain, slopes and debris limit their speed, water stops them.
 */
#include "mover/motion/ground_vehicle.h"

#include "mover/motion/kinematics_simd.h"
#include "mover/query/ground_marks.h"
#include "world/maths/cpu_dispatch.h"
#include "world/terrain/gridsquare.h"

#include <string.h>

#define TYRE_FRICTION 0.7  /* of the weight: how hard a sideways slide is braked */
#define CRAWL_SHARE   0.1  /* of full speed: what is left on the steepest slope */
#define STANDING_TURN 0.35 /* share of the turn rate that is there at rest */
#define FULL_TURN_MPS 4.0  /* speed from which the whole turn rate is */
#define LOW_CLIMB     1.2  /* of max_slope_rad: what low gear climbs, and no slower for it */
#define ENGINE_DRAG   0.5  /* of its acceleration: how it slows when the throttle is let go */
#define ROLLING       0.03 /* of the weight: how it slows in neutral */

/* Share of full speed that what is left of fallen objects here allows; 1 where nothing fell. */
static double debris_share(const struct step_context *move, double x, double z)
{
    const struct world *world = move->world;
    const struct state *committed = move->committed;
    double share = 1.0;
    const uint32_t *objects;
    uint32_t count = world_reach(world, gridsquare_of(x, z), &objects);
    for (uint32_t n = 0; n < count; n++) {
        if (committed->fixed_damage[objects[n]] < DAMAGE_HIGH)
            continue;
        const struct fixed_object *object = &world->fixed[objects[n]];
        double dx = x - object->x, dz = z - object->z, radius = (double)object->radius_m;
        if (dx * dx + dz * dz < radius * radius)
            share = maths_min(share, world->kinds[object->kind].debris_keep);
    }
    return share;
}

void ground_vehicle_begin(struct ground_vehicle *land)
{
    memset(land, 0, sizeof *land);
    ground_pose_begin(&land->stand);
}

static void find_scars(const struct step_context *move, struct ground_vehicle *land)
{
    const struct ground_pose *stand = &land->stand;
    union lane_masks debris;
    ground_marks_find(move->scars, &stand->x, &stand->z, &land->stand.scarred, &debris);
    for (int l = 0; l < LANE_COUNT; l++)
        land->debris.lane[l] =
            debris.lane[l] ? debris_share(move, stand->x.lane[l], stand->z.lane[l]) : 1.0;
}

static void take_kind(struct ground_vehicle *land, int l, const struct kind *kind)
{
    land->full_mps.lane[l] = kind->max_speed_mps;
    land->acceleration.lane[l] = kind->acceleration_mps2;
    land->turn_rate.lane[l] = kind->turn_rate_rps;
    land->max_slope.lane[l] = kind->max_slope_rad;
    land->half_length.lane[l] = kind->length_m * 0.5;
    land->burn_lps.lane[l] = kind->fuel_lps;
    land->tank.lane[l] = -(int64_t)(kind->fuel_l > 0.0);
}

/* What does not depend on its wish; the lane. */
static inline int take_row(const struct step_context *move, struct ground_vehicle *land, uint32_t i)
{
    const struct entities *m = move->m;
    int l = land->count++;
    if (ground_pose_take(move, &land->stand, l, i))
        take_kind(land, l, &move->world->kinds[m->kind[i]]);
    land->row[l] = i;
    land->y.lane[l] = m->y[i];
    land->vx.lane[l] = m->vx[i];
    land->vz.lane[l] = m->vz[i];
    land->heading.lane[l] = m->heading[i];
    land->pitch.lane[l] = m->pitch[i];
    land->fuel.lane[l] = m->fuel_l[i];
    return l;
}

bool ground_vehicle_take(const struct step_context *move, struct ground_vehicle *land, uint32_t i,
                         const struct desired_motion *wish)
{
    int l = take_row(move, land, i);
    land->held.lane[l] = 0;
    land->out_of_gear[l] = wish->gear == GEAR_NEUTRAL;
    land->low_gear.lane[l] = -(int64_t)(wish->gear == GEAR_LOW);
    land->driven.lane[l] = -(int64_t)wish->driven;
    land->wanted_heading.lane[l] = wish->heading_rad;
    land->wanted_mps.lane[l] = wish->speed_mps;
    land->turn.lane[l] = wish->turn;
    land->brake.lane[l] = wish->brake;
    return land->count == LANE_COUNT;
}

bool ground_vehicle_take_held(const struct step_context *move, struct ground_vehicle *land,
                              uint32_t i)
{
    int l = take_row(move, land, i);
    land->turn.lane[l] = (double)move->m->steer[i];
    land->wanted_mps.lane[l] = (double)move->m->throttle[i];
    if (land->held.lane[l] == 0) {
        land->held.lane[l] = -1;
        land->out_of_gear[l] = false;
        land->low_gear.lane[l] = land->driven.lane[l] = 0;
        land->brake.lane[l] = 0.0;
    }
    return land->count == LANE_COUNT;
}

/* --- four at once ------------------------------------------------------------------------------*/

/* Each of these does for the four lanes from 4 h on what its comment says of one vehicle. */

/* Of those who hold their controls, what these ask: agent_hold(). */
static inline void find_wish(struct ground_vehicle *land, int h, double dt_s)
{
    four_masks held = land->held.f64x4[h];
    f64x4 full = land->full_mps.f64x4[h], most = land->turn_rate.f64x4[h] * dt_s;
    f64x4 heading = land->heading.f64x4[h] + land->turn.f64x4[h] * most;
    f64x4 speed = land->wanted_mps.f64x4[h] * full;
    land->wanted_heading.f64x4[h] = SIMD_CHOOSE(held, heading, land->wanted_heading.f64x4[h]);
    land->wanted_mps.f64x4[h] = SIMD_CHOOSE(held, speed, land->wanted_mps.f64x4[h]);
}

/* The heading turned as the wish asks: kinematics_steer(). */
static inline void steer(struct ground_vehicle *land, int h, const f64x4 *forward, double dt_s)
{
    f64x4 agility = STANDING_TURN + (1.0 - STANDING_TURN) * SIMD_ABS(*forward) / FULL_TURN_MPS;
    agility = SIMD_CLAMP(agility, SIMD_EVERY(0.0), SIMD_EVERY(1.0));
    f64x4 rate = land->turn_rate.f64x4[h] * agility;
    struct kinematics_simd_helm helm = {land->wanted_heading.f64x4[h], land->turn.f64x4[h],
                                        land->driven.f64x4[h]};
    kinematics_simd_steer(&land->heading.f64x4[h], &helm, &rate, dt_s);
}

/* The speed that it wants and gets fuel for: kinematics_burn(). */
static inline void burn(struct ground_vehicle *land, int h, f64x4 *wanted, double dt_s)
{
    const f64x4 none = SIMD_EVERY(0.0), least = SIMD_EVERY(1e-9);
    f64x4 share = SIMD_ABS(*wanted) / SIMD_MAX(land->full_mps.f64x4[h], least);
    four_masks dry;
    kinematics_simd_burn(&land->fuel.f64x4[h], &land->burn_lps.f64x4[h], &share,
                         &land->tank.f64x4[h], dt_s, &dry);
    *wanted = SIMD_CHOOSE(dry, none, *wanted);
}

/* Within what slope and debris allow; 0 beyond what the kind climbs, and then it is blocked. */
static inline void limit(struct ground_vehicle *land, int h, f64x4 *wanted)
{
    const f64x4 none = SIMD_EVERY(0.0);
    f64x4 full = land->full_mps.f64x4[h], max_slope = land->max_slope.f64x4[h];
    f64x4 pitch = land->pitch.f64x4[h];
    f64x4 climb = SIMD_CHOOSE(*wanted < 0.0, SIMD_NEGATIVE(pitch), pitch);
    f64x4 crawling = full * (1.0 - (1.0 - CRAWL_SHARE) * climb / max_slope);
    crawling = SIMD_CHOOSE(climb >= max_slope, none, crawling);
    f64x4 low = SIMD_CHOOSE(climb < LOW_CLIMB * max_slope, full, none);
    f64x4 most = SIMD_CHOOSE(land->low_gear.f64x4[h], low, crawling);
    most = SIMD_CHOOSE(climb <= none, full, most);
    land->blocked.f64x4[h] = (SIMD_ABS(*wanted) > none) & (most <= none);
    f64x4 in_debris = land->debris.f64x4[h] * full;
    most = SIMD_MIN(most, in_debris);
    f64x4 least = SIMD_NEGATIVE(most);
    *wanted = SIMD_CLAMP(*wanted, least, most);
}

/* Speed along the heading a step later, under power: it brakes by kinematics_slowing(). */
static inline void power(const struct ground_vehicle *land, int h, const f64x4 *wanted,
                         f64x4 *forward, double dt_s)
{
    const f64x4 none = SIMD_EVERY(0.0), grip = SIMD_EVERY(TYRE_FRICTION * GRAVITY_MPS2);
    f64x4 wish = land->wanted_mps.f64x4[h], rate = land->acceleration.f64x4[h];
    four_masks braking = (SIMD_ABS(*wanted) < SIMD_ABS(*forward)) | (*wanted * *forward < none);
    four_masks held = SIMD_ABS(*wanted) < SIMD_ABS(wish); /* the ground slows it as well */
    f64x4 hardest = BRAKES * rate;
    f64x4 drag = SIMD_CHOOSE(held, hardest, ENGINE_DRAG * rate);
    f64x4 rest = hardest - drag;
    f64x4 slowing = drag + land->brake.f64x4[h] * SIMD_MAX(none, rest);
    slowing = SIMD_CHOOSE(land->driven.f64x4[h] & ~(wish * *forward < none), slowing, hardest);
    slowing = SIMD_MIN(slowing, grip);
    f64x4 step = SIMD_CHOOSE(braking, slowing, rate) * dt_s;
    kinematics_simd_approach(forward, wanted, &step);
}

/* --- lanes -------------------------------------------------------------------------------------*/

/* And out of gear: the slope pulls, the wheels' own resistance and the brake hold. */
static double rolling(const struct step_context *move, const struct ground_vehicle *land, int l,
                      double forward)
{
    double pull = -GRAVITY_MPS2 * maths_sin(land->pitch.lane[l]);
    double hold =
        ROLLING * GRAVITY_MPS2 + land->brake.lane[l] * (BRAKES * land->acceleration.lane[l]);
    forward = kinematics_approach(forward + pull * move->dt_s, 0.0, hold * move->dt_s);
    return maths_clamp(forward, -land->full_mps.lane[l], land->full_mps.lane[l]);
}

/* Where it would be a step later, where its nose or its tail, whichever leads. */
struct ahead {
    union simd_lanes x, z, lead_x, lead_z;
};

static inline void find_ahead(const struct step_context *move, struct ground_vehicle *land,
                              const union simd_lanes *forward, union simd_lanes *rightward,
                              struct ahead *ahead)
{
    const f64x4 none = SIMD_EVERY(0.0);
    const f64x4 grip = SIMD_EVERY(TYRE_FRICTION * GRAVITY_MPS2 * move->dt_s);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 sine = land->stand.sine.f64x4[h], cosine = land->stand.cosine.f64x4[h];
        f64x4 speed = forward->f64x4[h], half = land->half_length.f64x4[h];
        kinematics_simd_approach(&rightward->f64x4[h], &none, &grip);
        land->vx.f64x4[h] = speed * sine + rightward->f64x4[h] * cosine;
        land->vz.f64x4[h] = SIMD_NEGATIVE(speed) * cosine + rightward->f64x4[h] * sine;
        ahead->x.f64x4[h] = land->stand.x.f64x4[h] + land->vx.f64x4[h] * move->dt_s;
        ahead->z.f64x4[h] = land->stand.z.f64x4[h] + land->vz.f64x4[h] * move->dt_s;
        f64x4 lead = SIMD_CHOOSE(speed < none, SIMD_NEGATIVE(half), half);
        ahead->lead_x.f64x4[h] = ahead->x.f64x4[h] + sine * lead;
        ahead->lead_z.f64x4[h] = ahead->z.f64x4[h] - cosine * lead;
    }
}

/* Is the point in the world, and no water? */
static inline void passable(const struct step_context *move, const struct ground_vehicle *land,
                            const union simd_lanes *x, const union simd_lanes *z,
                            union lane_masks *pass)
{
    terrain_cache_water(&move->world->terrain, &land->stand.ground, x, z, pass);
    for (int h = 0; h < LANE_FOURS; h++)
        pass->f64x4[h] = ~pass->f64x4[h] & (x->f64x4[h] >= 0.0) & (z->f64x4[h] >= 0.0) &
                         (x->f64x4[h] <= WORLD_SIDE_M) & (z->f64x4[h] <= WORLD_SIDE_M);
}

/* There, unless the way is blocked. */
static inline void go(const struct step_context *move, struct ground_vehicle *land,
                      const struct ahead *ahead)
{
    const f64x4 none = SIMD_EVERY(0.0);
    union lane_masks pass, lead_pass;
    terrain_cache_find(&move->world->terrain, &land->stand.ground, &ahead->x, &ahead->z);
    passable(move, land, &ahead->x, &ahead->z, &pass);
    passable(move, land, &ahead->lead_x, &ahead->lead_z, &lead_pass);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 x = land->stand.x.f64x4[h], z = land->stand.z.f64x4[h];
        four_masks goes = (ahead->x.f64x4[h] != x) | (ahead->z.f64x4[h] != z);
        four_masks stays = goes & ~(pass.f64x4[h] & lead_pass.f64x4[h]);
        land->blocked.f64x4[h] |= stays;
        land->stand.x.f64x4[h] = SIMD_CHOOSE(stays, x, ahead->x.f64x4[h]);
        land->stand.z.f64x4[h] = SIMD_CHOOSE(stays, z, ahead->z.f64x4[h]);
        land->vx.f64x4[h] = SIMD_CHOOSE(stays, none, land->vx.f64x4[h]);
        land->vz.f64x4[h] = SIMD_CHOOSE(stays, none, land->vz.f64x4[h]);
        /* Beyond this the map of scars says nothing. */
        f64x4 far = SIMD_ABS(land->stand.x.f64x4[h] - x) + SIMD_ABS(land->stand.z.f64x4[h] - z) +
                    land->stand.half_length.f64x4[h] + land->stand.half_width.f64x4[h];
        land->stand.scarred.f64x4[h] |= ~(far < GROUND_MARKS_NEAR_M);
    }
}

static void write_rows(const struct step_context *move, const struct ground_vehicle *land)
{
    struct entities *m = move->m;
    for (int l = 0; l < land->count; l++) {
        uint32_t i = land->row[l];
        m->x[i] = land->stand.x.lane[l];
        m->y[i] = land->stand.y.lane[l];
        m->z[i] = land->stand.z.lane[l];
        m->vx[i] = land->vx.lane[l];
        m->vy[i] = (land->stand.y.lane[l] - land->y.lane[l]) / move->dt_s;
        m->vz[i] = land->vz.lane[l];
        m->heading[i] = land->heading.lane[l];
        m->pitch[i] = land->stand.pitch.lane[l];
        m->roll[i] = land->stand.roll.lane[l];
        m->fuel_l[i] = land->fuel.lane[l];
    }
}

VECTOR_CLONES
void ground_vehicle_move(const struct step_context *move, struct ground_vehicle *land)
{
    union simd_lanes sine, cosine, forward, rightward, under_power;
    struct ahead ahead;
    find_scars(move, land);
    maths_sincos_lanes(&land->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        find_wish(land, h, move->dt_s);
        f64x4 wanted = land->wanted_mps.f64x4[h];
        f64x4 vx = land->vx.f64x4[h], vz = land->vz.f64x4[h];
        forward.f64x4[h] = vx * sine.f64x4[h] - vz * cosine.f64x4[h];
        rightward.f64x4[h] = vx * cosine.f64x4[h] + vz * sine.f64x4[h];
        steer(land, h, &forward.f64x4[h], move->dt_s);
        burn(land, h, &wanted, move->dt_s);
        limit(land, h, &wanted);
        under_power.f64x4[h] = forward.f64x4[h];
        power(land, h, &wanted, &under_power.f64x4[h], move->dt_s);
    }
    for (int l = 0; l < land->count; l++) {
        if (land->out_of_gear[l])
            under_power.lane[l] = rolling(move, land, l, forward.lane[l]);
    }
    maths_sincos_lanes(&land->heading, &land->stand.sine, &land->stand.cosine);
    find_ahead(move, land, &under_power, &rightward, &ahead);
    go(move, land, &ahead);
    ground_pose_pose(move, &land->stand);
    write_rows(move, land);
}
