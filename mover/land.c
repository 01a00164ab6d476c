/* Ground vehicles: they follow the terrain, slopes and debris limit their speed, water stops them.
 */
#include "mover/move.h"

#include "world/square.h"

#define TYRE_FRICTION 0.7  /* of the weight: how hard a sideways slide is braked */
#define CRAWL_SHARE   0.1  /* of full speed: what is left on the steepest slope */
#define STANDING_TURN 0.35 /* share of the turn rate that is there at rest */
#define FULL_TURN_MPS 4.0  /* speed from which the whole turn rate is */
#define LOW_CLIMB     1.2  /* of max_slope_rad: what low gear climbs, and no slower for it */
#define ENGINE_DRAG   0.5  /* of its acceleration: how it slows when the throttle is let go */
#define ROLLING       0.03 /* of the weight: how it slows in neutral */

/* Full speed on this slope [m/s]; 0 beyond what the kind climbs. */
static double slope_speed(const struct kind *kind, double climb_rad, enum gearing gear)
{
    if (climb_rad <= 0.0)
        return kind->max_speed_mps;
    if (gear == GEAR_LOW)
        return climb_rad < LOW_CLIMB * kind->max_slope_rad ? kind->max_speed_mps : 0.0;
    if (climb_rad >= kind->max_slope_rad)
        return 0.0;
    double share = 1.0 - (1.0 - CRAWL_SHARE) * climb_rad / kind->max_slope_rad;
    return kind->max_speed_mps * share;
}

/* Share of full speed that what is left of fallen objects here allows; 1 where nothing fell. */
static double debris_share(const struct move *move, double x, double z)
{
    const struct world *world = move->world;
    const struct state *committed = move->committed;
    double share = 1.0;
    if (committed->head->tally.fixed_damaged == 0)
        return share;
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

static bool passable(const struct move *move, double x, double z)
{
    return x >= 0.0 && z >= 0.0 && x <= WORLD_SIDE_M && z <= WORLD_SIDE_M &&
           !cover_is_water(terrain_cover(&move->world->terrain, x, z));
}

/* Speed along the heading a step later, under power. */
static double powered(const struct move *move, const struct kind *kind, const struct wish *wish,
                      double forward, double wanted)
{
    bool braking = fabs(wanted) < fabs(forward) || wanted * forward < 0.0;
    bool held = fabs(wanted) < fabs(wish->speed_mps); /* the ground slows it as well */
    double rate = kind->acceleration_mps2;
    if (braking)
        rate = maths_min(pose_slowing(kind, wish, forward, (held ? BRAKES : ENGINE_DRAG) * rate),
                         TYRE_FRICTION * GRAVITY_MPS2);
    return pose_approach(forward, wanted, rate * move->dt_s);
}

/* And out of gear: the slope pulls, the wheels' own resistance and the brake hold. */
static double rolling(const struct move *move, uint32_t i, const struct kind *kind,
                      const struct wish *wish, double forward)
{
    double pull = -GRAVITY_MPS2 * maths_sin(move->m->pitch[i]);
    double hold = ROLLING * GRAVITY_MPS2 +
                  wish->brake * pose_slowing(kind, &(struct wish){.driven = false}, forward, 0.0);
    forward = pose_approach(forward + pull * move->dt_s, 0.0, hold * move->dt_s);
    return maths_clamp(forward, -kind->max_speed_mps, kind->max_speed_mps);
}

bool move_land(const struct move *move, uint32_t i, const struct wish *wish)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double forward, rightward, sine, cosine;
    bool blocked = false;
    double before = m->heading[i];
    maths_sincos(m->heading[i], &sine, &cosine);
    pose_along(m, i, sine, cosine, &forward, &rightward);

    double agility = maths_clamp(
        STANDING_TURN + (1.0 - STANDING_TURN) * fabs(forward) / FULL_TURN_MPS, 0.0, 1.0);
    pose_steer(move, i, wish, kind->turn_rate_rps * agility);
    if (m->heading[i] != before)
        maths_sincos(m->heading[i], &sine, &cosine);

    double wanted = wish->speed_mps;
    if (!pose_burn(move, i, fabs(wanted) / maths_max(kind->max_speed_mps, 1e-9)))
        wanted = 0.0;
    double climb = wanted < 0.0 ? -m->pitch[i] : m->pitch[i];
    double limit = slope_speed(kind, climb, wish->gear);
    if (fabs(wanted) > 0.0 && limit <= 0.0)
        blocked = true;
    limit = maths_min(limit, debris_share(move, m->x[i], m->z[i]) * kind->max_speed_mps);
    wanted = maths_clamp(wanted, -limit, limit);
    forward = wish->gear == GEAR_NEUTRAL ? rolling(move, i, kind, wish, forward)
                                         : powered(move, kind, wish, forward, wanted);
    rightward = pose_approach(rightward, 0.0, TYRE_FRICTION * GRAVITY_MPS2 * move->dt_s);

    double vx = forward * sine + rightward * cosine;
    double vz = -forward * cosine + rightward * sine;
    double x = m->x[i] + vx * move->dt_s;
    double z = m->z[i] + vz * move->dt_s;
    double lead = forward < 0.0 ? -kind->length_m * 0.5 : kind->length_m * 0.5;
    bool goes = x != m->x[i] || z != m->z[i];
    if (goes && (!passable(move, x + sine * lead, z - cosine * lead) || !passable(move, x, z))) {
        blocked = true;
        x = m->x[i];
        z = m->z[i];
        vx = vz = 0.0;
    }
    double y = pose_ground(move, x, z);
    m->vx[i] = vx;
    m->vy[i] = (y - m->y[i]) / move->dt_s;
    m->vz[i] = vz;
    m->x[i] = x;
    m->y[i] = y;
    m->z[i] = z;
    pose_on_ground(move, i, sine, cosine);
    return blocked;
}
