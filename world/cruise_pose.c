/* Poses of vehicles that cruise. */
#include "world/cruise_pose.h"

#include "world/entity/cruise.h"
#include "world/params.h"
#include "world/terrain/rest_pose.h"
#include "world/world.h"

/* What a stretch that ends changes. */
#define CRUISE_COLUMNS                                                                             \
    (COLUMN_BIT(x) | COLUMN_BIT(y) | COLUMN_BIT(z) | COLUMN_BIT(vx) | COLUMN_BIT(vy) |             \
     COLUMN_BIT(vz) | COLUMN_BIT(heading) | COLUMN_BIT(pitch) | COLUMN_BIT(roll) |                 \
     COLUMN_BIT(fuel_l) | COLUMN_BIT(cruise_tick))

#define AIR_IDLE_SHARE 0.2 /* of the fuel at full speed: an aircraft burns no less */

struct cruise_pose cruise_pose_of(const struct world *world, const struct crater_index *craters,
                                  const struct entities *e, uint32_t i, uint64_t tick)
{
    struct cruise_pose pose = {.at = entities_position(e, i),
                               .heading_rad = e->heading[i],
                               .pitch_rad = e->pitch[i],
                               .roll_rad = e->roll[i]};
    if (!cruise_goes(e, i, tick))
        return pose;
    double dt_s = world_dt_s(world);
    pose.at = cruise_position(e, i, tick, dt_s);
    pose.heading_rad = cruise_heading(e, i, tick, dt_s);
    if (world->kinds[e->kind[i]].domain != DOMAIN_LAND) {
        pose.pitch_rad = cruise_pitch(e, i, tick, dt_s);
        pose.roll_rad = cruise_roll(e, i, tick, dt_s);
        return pose;
    }
    struct rest_pose stands = rest_pose_of(&world->terrain, craters, &world->kinds[e->kind[i]],
                                           pose.at.x, pose.at.z, pose.heading_rad);
    pose.at.y = stands.y_m;
    pose.pitch_rad = stands.pitch_rad;
    pose.roll_rad = stands.roll_rad;
    return pose;
}

struct told_motion cruise_pose_motion(const struct world *world, const struct crater_index *craters,
                                      const struct entities *e, uint32_t i, uint64_t tick)
{
    double dt_s = world_dt_s(world), left_s = cruise_left_s(e, i, tick, dt_s);
    struct cruise_pose pose = cruise_pose_of(world, craters, e, i, tick);
    struct told_motion motion = {.at = pose.at,
                                 .velocity = cruise_velocity(e, i, tick, dt_s),
                                 .heading_rad = pose.heading_rad,
                                 .pitch_rad = pose.pitch_rad,
                                 .roll_rad = pose.roll_rad};
    if (!(left_s > 0.0))
        return motion;
    motion.turn_rps = (float)e->cruise_rps[i];
    motion.gain_mps2 = (float)e->cruise_mps2[i];
    motion.climb_mps2 = e->cruise_climb_mps2[i];
    motion.pitch_rps = (float)((e->pitch[i] - pose.pitch_rad) / left_s);
    motion.roll_rps = (float)(maths_wrap_half(e->roll[i] - pose.roll_rad) / left_s);
    motion.lasts_s = (float)left_s;
    if (world->kinds[e->kind[i]].domain == DOMAIN_LAND)
        motion.velocity.y = (e->y[i] - pose.at.y) / left_s; /* the ground between rises evenly */
    return motion;
}

/* Returns the fuel that row i has at the tick: that of all of its stretch was burnt when it began
 * (mover/motion/kinematics.h). */
static double fuel_at(const struct world *world, const struct entities *e, uint32_t i,
                      uint64_t tick)
{
    const struct kind *kind = &world->kinds[e->kind[i]];
    double idle = kind->domain == DOMAIN_AIR ? AIR_IDLE_SHARE : kind->idle_share;
    double share = maths_max(fabs((double)e->throttle[i]), idle);
    double left_l = share * kind->fuel_lps * cruise_left_s(e, i, tick, world_dt_s(world));
    return e->fuel_l[i] > 0.0 ? e->fuel_l[i] + left_l : e->fuel_l[i];
}

/* Writes where row i is at the tick into its columns. */
static void settle(const struct entities *e, const struct world *world,
                   const struct crater_index *craters, uint32_t i, uint64_t tick)
{
    struct cruise_pose pose = cruise_pose_of(world, craters, e, i, tick);
    e->fuel_l[i] = fuel_at(world, e, i, tick);
    entities_set_velocity(e, i, cruise_velocity(e, i, tick, world_dt_s(world)));
    entities_set_position(e, i, pose.at);
    e->heading[i] = pose.heading_rad;
    e->pitch[i] = pose.pitch_rad;
    e->roll[i] = pose.roll_rad;
    e->cruise_tick[i] = 0;
}

bool cruise_pose_end(const struct table_writer *writer, const struct world *world,
                     const struct crater_index *craters, uint32_t i, uint64_t tick, uint64_t now)
{
    if (!cruise_goes(writer->entities, i, tick))
        return false;
    table_note(writer, i, CRUISE_COLUMNS);
    settle(writer->entities, world, craters, i, tick);
    if (tick > now)
        writer->entities->cruise_tick[i] = (uint32_t)tick;
    return true;
}

void cruise_pose_settle_row(const struct entities *own, const struct world *world,
                            const struct crater_index *craters, uint32_t i, uint64_t tick)
{
    if (cruise_goes(own, i, tick))
        settle(own, world, craters, i, tick);
}

void cruise_pose_settle(const struct entities *own, const struct world *world,
                        const struct crater_index *craters, uint32_t used, uint64_t tick)
{
    for (uint32_t i = 0; world->params->cruise && i < used; i++)
        cruise_pose_settle_row(own, world, craters, i, tick);
}
