/* Poses of vehicles that cruise. */
#include "world/cruise_pose.h"

#include "world/entity/cruise.h"
#include "world/params.h"
#include "world/terrain/rest_pose.h"
#include "world/world.h"

#define AIR_IDLE_SHARE 0.2 /* of the fuel at full speed: an aircraft burns no less */

struct cruise_pose cruise_pose_of(const struct world *world, const struct crater_index *craters,
                                  const struct entities *e, uint32_t i, uint64_t tick)
{
    struct cruise_pose pose = {.at = entities_position(e, i),
                               .heading_rad = e->row[i].heading,
                               .pitch_rad = e->row[i].pitch,
                               .roll_rad = e->row[i].roll};
    if (!cruise_goes(e, i, tick))
        return pose;
    double dt_s = world_dt_s(world);
    pose.at = cruise_position(e, i, tick, dt_s);
    pose.heading_rad = cruise_heading(e, i, tick, dt_s);
    if (world->kinds[e->row[i].kind].domain != DOMAIN_LAND) {
        pose.pitch_rad = cruise_pitch(e, i, tick, dt_s);
        pose.roll_rad = cruise_roll(e, i, tick, dt_s);
        return pose;
    }
    struct rest_pose stands = rest_pose_of(&world->terrain, craters, &world->kinds[e->row[i].kind],
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
    motion.turn_rps = (float)e->row[i].cruise_rps;
    motion.gain_mps2 = (float)e->row[i].cruise_mps2;
    motion.climb_mps2 = e->row[i].cruise_climb_mps2;
    motion.pitch_rps = (float)((e->row[i].pitch - pose.pitch_rad) / left_s);
    motion.roll_rps = (float)(maths_wrap_half(e->row[i].roll - pose.roll_rad) / left_s);
    motion.lasts_s = (float)left_s;
    if (world->kinds[e->row[i].kind].domain == DOMAIN_LAND)
        motion.velocity.y =
            (e->row[i].y - pose.at.y) / left_s; /* the ground between rises evenly */
    return motion;
}

/* Returns the fuel that row i has at the tick: that of all of its stretch was burnt when it began
 * (mover/motion/kinematics.h). */
static double fuel_at(const struct world *world, const struct entities *e, uint32_t i,
                      uint64_t tick)
{
    const struct kind *kind = &world->kinds[e->row[i].kind];
    double idle = kind->domain == DOMAIN_AIR ? AIR_IDLE_SHARE : kind->idle_share;
    double share = maths_max(fabs((double)e->row[i].throttle), idle);
    double left_l = share * kind->fuel_lps * cruise_left_s(e, i, tick, world_dt_s(world));
    return e->row[i].fuel_l > 0.0 ? e->row[i].fuel_l + left_l : e->row[i].fuel_l;
}

/* Writes where row i is at the tick into its fields. */
static void settle(const struct entities *e, const struct world *world,
                   const struct crater_index *craters, uint32_t i, uint64_t tick)
{
    struct cruise_pose pose = cruise_pose_of(world, craters, e, i, tick);
    e->row[i].fuel_l = fuel_at(world, e, i, tick);
    entities_set_velocity(e, i, cruise_velocity(e, i, tick, world_dt_s(world)));
    entities_set_position(e, i, pose.at);
    e->row[i].heading = pose.heading_rad;
    e->row[i].pitch = pose.pitch_rad;
    e->row[i].roll = pose.roll_rad;
    e->row[i].cruise_tick = 0;
}

bool cruise_pose_end(const struct table_writer *writer, const struct world *world,
                     const struct crater_index *craters, uint32_t i, uint64_t tick, uint64_t now)
{
    if (!cruise_goes(writer->entities, i, tick))
        return false;
    table_note(writer, i);
    settle(writer->entities, world, craters, i, tick);
    if (tick > now)
        writer->entities->row[i].cruise_tick = (uint32_t)tick;
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
