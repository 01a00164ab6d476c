/* Ground vehicles: they follow the terrain, slopes and debris limit their speed, water stops them.
 */
#include "mover/move.h"

#include "world/square.h"

#define TYRE_FRICTION 0.7  /* of the weight: how hard a sideways slide is braked */
#define CRAWL_SHARE   0.1  /* of full speed: what is left on the steepest slope */
#define STANDING_TURN 0.35 /* share of the turn rate that is there at rest */
#define FULL_TURN_MPS 4.0  /* speed from which the whole turn rate is */

/* Full speed on this slope [m/s]; 0 beyond what the kind climbs. */
static double slope_speed(const struct kind *kind, double climb_rad)
{
    if (climb_rad <= 0.0)
        return kind->max_speed_mps;
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

bool move_land(const struct move *move, uint32_t i, const struct wish *wish)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double forward, rightward, sine, cosine;
    bool blocked = false;
    pose_speeds(m, i, &forward, &rightward);

    double agility = maths_clamp(
        STANDING_TURN + (1.0 - STANDING_TURN) * fabs(forward) / FULL_TURN_MPS, 0.0, 1.0);
    m->heading[i] =
        pose_turn(m->heading[i], wish->heading_rad, kind->turn_rate_rps * agility, move->dt_s);
    maths_sincos(m->heading[i], &sine, &cosine);

    double wanted = wish->speed_mps;
    if (!pose_burn(move, i, fabs(wanted) / maths_max(kind->max_speed_mps, 1e-9)))
        wanted = 0.0;
    double climb = wanted < 0.0 ? -m->pitch[i] : m->pitch[i];
    double limit = slope_speed(kind, climb);
    if (fabs(wanted) > 0.0 && limit <= 0.0)
        blocked = true;
    limit = maths_min(limit, debris_share(move, m->x[i], m->z[i]) * kind->max_speed_mps);
    wanted = maths_clamp(wanted, -limit, limit);
    bool braking = fabs(wanted) < fabs(forward) || wanted * forward < 0.0;
    forward = pose_approach(forward, wanted,
                            kind->acceleration_mps2 * (braking ? 2.0 : 1.0) * move->dt_s);
    rightward = pose_approach(rightward, 0.0, TYRE_FRICTION * GRAVITY_MPS2 * move->dt_s);

    double vx = forward * sine + rightward * cosine;
    double vz = -forward * cosine + rightward * sine;
    double x = m->x[i] + vx * move->dt_s;
    double z = m->z[i] + vz * move->dt_s;
    double lead = forward < 0.0 ? -kind->length_m * 0.5 : kind->length_m * 0.5;
    if (!passable(move, x + sine * lead, z - cosine * lead) || !passable(move, x, z)) {
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
