/* Ground vehicles: they follow the terrain, slopes and debris limit their speed, water stops them.
 */
#include "mover/land.h"

#include "mover/fours.h"
#include "mover/scars.h"
#include "world/clones.h"
#include "world/square.h"

#include <string.h>

#define TYRE_FRICTION 0.7  /* of the weight: how hard a sideways slide is braked */
#define CRAWL_SHARE   0.1  /* of full speed: what is left on the steepest slope */
#define STANDING_TURN 0.35 /* share of the turn rate that is there at rest */
#define FULL_TURN_MPS 4.0  /* speed from which the whole turn rate is */
#define LOW_CLIMB     1.2  /* of max_slope_rad: what low gear climbs, and no slower for it */
#define ENGINE_DRAG   0.5  /* of its acceleration: how it slows when the throttle is let go */
#define ROLLING       0.03 /* of the weight: how it slows in neutral */

/* Share of full speed that what is left of fallen objects here allows; 1 where nothing fell. */
static double debris_share(const struct move *move, double x, double z)
{
    const struct world *world = move->world;
    const struct state *committed = move->committed;
    double share = 1.0;
    const uint32_t *objects;
    uint32_t count = world_reach(world, square_of(x, z), &objects);
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

void land_begin(struct land *land)
{
    memset(land, 0, sizeof *land);
    stand_begin(&land->stand);
}

static void find_scars(const struct move *move, struct land *land)
{
    const struct stand *stand = &land->stand;
    union lane_masks debris;
    scars_find(move->scars, &stand->x, &stand->z, &land->stand.scarred, &debris);
    for (int l = 0; l < LANE_COUNT; l++)
        land->debris.lane[l] =
            debris.lane[l] ? debris_share(move, stand->x.lane[l], stand->z.lane[l]) : 1.0;
}

static void take_kind(struct land *land, int l, const struct kind *kind)
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
static inline int take_row(const struct move *move, struct land *land, uint32_t i)
{
    const struct entities *m = move->m;
    int l = land->count++;
    if (stand_take(move, &land->stand, l, i))
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

bool land_take(const struct move *move, struct land *land, uint32_t i, const struct wish *wish)
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

bool land_take_held(const struct move *move, struct land *land, uint32_t i)
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
static inline void find_wish(struct land *land, int h, double dt_s)
{
    four_masks held = land->held.four[h];
    four full = land->full_mps.four[h], most = land->turn_rate.four[h] * dt_s;
    four heading = land->heading.four[h] + land->turn.four[h] * most;
    four speed = land->wanted_mps.four[h] * full;
    land->wanted_heading.four[h] = LANES_CHOOSE(held, heading, land->wanted_heading.four[h]);
    land->wanted_mps.four[h] = LANES_CHOOSE(held, speed, land->wanted_mps.four[h]);
}

/* The heading turned as the wish asks: pose_steer(). */
static inline void steer(struct land *land, int h, const four *forward, double dt_s)
{
    four agility = STANDING_TURN + (1.0 - STANDING_TURN) * LANES_ABS(*forward) / FULL_TURN_MPS;
    agility = LANES_CLAMP(agility, LANES_EVERY(0.0), LANES_EVERY(1.0));
    four rate = land->turn_rate.four[h] * agility;
    struct fours_helm helm = {land->wanted_heading.four[h], land->turn.four[h],
                              land->driven.four[h]};
    fours_steer(&land->heading.four[h], &helm, &rate, dt_s);
}

/* The speed that it wants and gets fuel for: pose_burn(). */
static inline void burn(struct land *land, int h, four *wanted, double dt_s)
{
    const four none = LANES_EVERY(0.0), least = LANES_EVERY(1e-9);
    four share = LANES_ABS(*wanted) / LANES_MAX(land->full_mps.four[h], least);
    four_masks dry;
    fours_burn(&land->fuel.four[h], &land->burn_lps.four[h], &share, &land->tank.four[h], dt_s,
               &dry);
    *wanted = LANES_CHOOSE(dry, none, *wanted);
}

/* Within what slope and debris allow; 0 beyond what the kind climbs, and then it is blocked. */
static inline void limit(struct land *land, int h, four *wanted)
{
    const four none = LANES_EVERY(0.0);
    four full = land->full_mps.four[h], max_slope = land->max_slope.four[h];
    four pitch = land->pitch.four[h];
    four climb = LANES_CHOOSE(*wanted < 0.0, LANES_NEGATIVE(pitch), pitch);
    four crawling = full * (1.0 - (1.0 - CRAWL_SHARE) * climb / max_slope);
    crawling = LANES_CHOOSE(climb >= max_slope, none, crawling);
    four low = LANES_CHOOSE(climb < LOW_CLIMB * max_slope, full, none);
    four most = LANES_CHOOSE(land->low_gear.four[h], low, crawling);
    most = LANES_CHOOSE(climb <= none, full, most);
    land->blocked.four[h] = (LANES_ABS(*wanted) > none) & (most <= none);
    four in_debris = land->debris.four[h] * full;
    most = LANES_MIN(most, in_debris);
    four least = LANES_NEGATIVE(most);
    *wanted = LANES_CLAMP(*wanted, least, most);
}

/* Speed along the heading a step later, under power: it brakes by pose_slowing(). */
static inline void power(const struct land *land, int h, const four *wanted, four *forward,
                         double dt_s)
{
    const four none = LANES_EVERY(0.0), grip = LANES_EVERY(TYRE_FRICTION * GRAVITY_MPS2);
    four wish = land->wanted_mps.four[h], rate = land->acceleration.four[h];
    four_masks braking = (LANES_ABS(*wanted) < LANES_ABS(*forward)) | (*wanted * *forward < none);
    four_masks held = LANES_ABS(*wanted) < LANES_ABS(wish); /* the ground slows it as well */
    four hardest = BRAKES * rate;
    four drag = LANES_CHOOSE(held, hardest, ENGINE_DRAG * rate);
    four rest = hardest - drag;
    four slowing = drag + land->brake.four[h] * LANES_MAX(none, rest);
    slowing = LANES_CHOOSE(land->driven.four[h] & ~(wish * *forward < none), slowing, hardest);
    slowing = LANES_MIN(slowing, grip);
    four step = LANES_CHOOSE(braking, slowing, rate) * dt_s;
    fours_approach(forward, wanted, &step);
}

/* --- lanes -------------------------------------------------------------------------------------*/

/* And out of gear: the slope pulls, the wheels' own resistance and the brake hold. */
static double rolling(const struct move *move, const struct land *land, int l, double forward)
{
    double pull = -GRAVITY_MPS2 * maths_sin(land->pitch.lane[l]);
    double hold =
        ROLLING * GRAVITY_MPS2 + land->brake.lane[l] * (BRAKES * land->acceleration.lane[l]);
    forward = pose_approach(forward + pull * move->dt_s, 0.0, hold * move->dt_s);
    return maths_clamp(forward, -land->full_mps.lane[l], land->full_mps.lane[l]);
}

/* Where it would be a step later, where its nose or its tail, whichever leads. */
struct ahead {
    union lanes x, z, lead_x, lead_z;
};

static inline void find_ahead(const struct move *move, struct land *land,
                              const union lanes *forward, union lanes *rightward,
                              struct ahead *ahead)
{
    const four none = LANES_EVERY(0.0);
    const four grip = LANES_EVERY(TYRE_FRICTION * GRAVITY_MPS2 * move->dt_s);
    for (int h = 0; h < LANE_FOURS; h++) {
        four sine = land->stand.sine.four[h], cosine = land->stand.cosine.four[h];
        four speed = forward->four[h], half = land->half_length.four[h];
        fours_approach(&rightward->four[h], &none, &grip);
        land->vx.four[h] = speed * sine + rightward->four[h] * cosine;
        land->vz.four[h] = LANES_NEGATIVE(speed) * cosine + rightward->four[h] * sine;
        ahead->x.four[h] = land->stand.x.four[h] + land->vx.four[h] * move->dt_s;
        ahead->z.four[h] = land->stand.z.four[h] + land->vz.four[h] * move->dt_s;
        four lead = LANES_CHOOSE(speed < none, LANES_NEGATIVE(half), half);
        ahead->lead_x.four[h] = ahead->x.four[h] + sine * lead;
        ahead->lead_z.four[h] = ahead->z.four[h] - cosine * lead;
    }
}

/* Is the point in the world, and no water? */
static inline void passable(const struct move *move, const struct land *land, const union lanes *x,
                            const union lanes *z, union lane_masks *pass)
{
    footing_water(&move->world->terrain, &land->stand.ground, x, z, pass);
    for (int h = 0; h < LANE_FOURS; h++)
        pass->four[h] = ~pass->four[h] & (x->four[h] >= 0.0) & (z->four[h] >= 0.0) &
                        (x->four[h] <= WORLD_SIDE_M) & (z->four[h] <= WORLD_SIDE_M);
}

/* There, unless the way is blocked. */
static inline void go(const struct move *move, struct land *land, const struct ahead *ahead)
{
    const four none = LANES_EVERY(0.0);
    union lane_masks pass, lead_pass;
    footing_find(&move->world->terrain, &land->stand.ground, &ahead->x, &ahead->z);
    passable(move, land, &ahead->x, &ahead->z, &pass);
    passable(move, land, &ahead->lead_x, &ahead->lead_z, &lead_pass);
    for (int h = 0; h < LANE_FOURS; h++) {
        four x = land->stand.x.four[h], z = land->stand.z.four[h];
        four_masks goes = (ahead->x.four[h] != x) | (ahead->z.four[h] != z);
        four_masks stays = goes & ~(pass.four[h] & lead_pass.four[h]);
        land->blocked.four[h] |= stays;
        land->stand.x.four[h] = LANES_CHOOSE(stays, x, ahead->x.four[h]);
        land->stand.z.four[h] = LANES_CHOOSE(stays, z, ahead->z.four[h]);
        land->vx.four[h] = LANES_CHOOSE(stays, none, land->vx.four[h]);
        land->vz.four[h] = LANES_CHOOSE(stays, none, land->vz.four[h]);
        /* Beyond this the map of scars says nothing. */
        four far = LANES_ABS(land->stand.x.four[h] - x) + LANES_ABS(land->stand.z.four[h] - z) +
                   land->stand.half_length.four[h] + land->stand.half_width.four[h];
        land->stand.scarred.four[h] |= ~(far < SCARS_NEAR_M);
    }
}

static void write_rows(const struct move *move, const struct land *land)
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
void land_move(const struct move *move, struct land *land)
{
    union lanes sine, cosine, forward, rightward, under_power;
    struct ahead ahead;
    find_scars(move, land);
    maths_sincos_lanes(&land->heading, &sine, &cosine);
    for (int h = 0; h < LANE_FOURS; h++) {
        find_wish(land, h, move->dt_s);
        four wanted = land->wanted_mps.four[h];
        four vx = land->vx.four[h], vz = land->vz.four[h];
        forward.four[h] = vx * sine.four[h] - vz * cosine.four[h];
        rightward.four[h] = vx * cosine.four[h] + vz * sine.four[h];
        steer(land, h, &forward.four[h], move->dt_s);
        burn(land, h, &wanted, move->dt_s);
        limit(land, h, &wanted);
        under_power.four[h] = forward.four[h];
        power(land, h, &wanted, &under_power.four[h], move->dt_s);
    }
    for (int l = 0; l < land->count; l++) {
        if (land->out_of_gear[l])
            under_power.lane[l] = rolling(move, land, l, forward.lane[l]);
    }
    maths_sincos_lanes(&land->heading, &land->stand.sine, &land->stand.cosine);
    find_ahead(move, land, &under_power, &rightward, &ahead);
    go(move, land, &ahead);
    stand_pose(move, &land->stand);
    write_rows(move, land);
}
