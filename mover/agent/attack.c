/* The manners of fighting (enum manner). */
#include "mover/agent/attack.h"

#include "mover/agent/fire_control.h"
#include "mover/agent/goal.h"
#include "mover/agent/perception.h"
#include "mover/agent/driving/shunting.h"
#include "world/entity/climb_limits.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define HOVER_S         12.0 /* a helicopter's cycle: it hovers, then flies to another side */
#define HOVER_SHARE     0.6  /* share of the cycle in which it hovers */
#define EFFECTIVE_SHARE 0.95 /* of the distance from which its rounds hit and penetrate */
#define TOO_NEAR_SHARE  0.25 /* share of the range: if the target is nearer it backs away */
#define SIDE_RAD        1.7  /* direction to the other side, off its target */
#define ROCKET_SHARE    0.48 /* of the range, from which a helicopter fires rockets */
#define STOP_MPS        5.0  /* the least speed with which it comes to where it hovers */
#define NEARLY_M        50.0 /* so far out of range it begins to lay its gun */
#define BREAK_OFF       0.2  /* share of the range at which a jet's pass ends */
#define BREAK_SHARE     0.6  /* nearer than this share a jet that cannot fire yet turns away */
#define BREAK_RAD       2.1  /* so far off its target */
#define LOW_SHARE       0.4  /* of its usual height, at which a helicopter changes sides */
#define POP_UP_SHARE    1.3  /* and from which it fires */
#define POP_UP_PHASE    0.35 /* share of the cycle in which it waits for a sight of its target */
#define AIMED_RAD       0.02 /* so far off its target it need not turn its hull */
#define AIM_HZ          20.0 /* how often an agent tries to fire a loaded gun */

/* The target where the agent last saw it. */
struct aim {
    double heading, distance;
    bool seen;
};

/* Drives up to a distance from its target. */
static void stand_off(const struct kind *kind, const struct aim *aim, double distance,
                      struct desired_motion *desired)
{
    bool there = aim->seen && aim->distance <= distance;
    desired->heading_rad = aim->heading;
    desired->speed_mps = there ? 0.0 : kind->max_speed_mps;
}

/* Returns how far from its target a helicopter hovers, or from how far it fires [m]: that share of
 * its range, or more before air defence. */
static double hover_m(const struct step_context *context, uint32_t i, double share)
{
    const struct entities *m = context->m;
    return maths_max(share * context->world->kinds[m->row[i].kind].range_m,
                     fire_control_outranges_m(context, i, m->row[i].target_slot));
}

/* Comes to where it hovers no faster than it can stop there. */
static void stop_there(const struct kind *kind, const struct aim *aim, double distance,
                       struct desired_motion *desired)
{
    double way_m = maths_max(aim->distance - distance, 0.0);
    desired->speed_mps =
        maths_min(desired->speed_mps, STOP_MPS + sqrt(2.0 * climb_limits_brake(kind) * way_m));
}

/* A helicopter hovers high enough to see its target, fires, and changes sides behind the crests. */
static void hover(const struct step_context *context, uint32_t i, const struct kind *kind,
                  const struct aim *aim, double distance, struct desired_motion *desired)
{
    double round =
        ((double)context->tick * context->dt_s + (double)(context->m->row[i].id % 12u)) / HOVER_S;
    double phase = round - floor(round);
    bool near = aim->distance <= distance;
    stand_off(kind, aim, distance, desired);
    stop_there(kind, aim, distance, desired);
    desired->altitude_m = (near ? POP_UP_SHARE : LOW_SHARE) * kind->cruise_altitude_m;
    if (near && phase < HOVER_SHARE && !aim->seen)
        desired->speed_mps = phase < POP_UP_PHASE ? 0.0 : desired->speed_mps;
    if (!near || phase < HOVER_SHARE)
        return;
    double side = (uint64_t)floor(round) % 2 ? SIDE_RAD : -SIDE_RAD;
    if (aim->distance < TOO_NEAR_SHARE * kind->range_m)
        side = PI;
    desired->heading_rad = maths_wrap_turn(aim->heading + side);
    desired->speed_mps = 0.5 * kind->max_speed_mps;
    desired->altitude_m = LOW_SHARE * kind->cruise_altitude_m;
}

/* A jet flies to the target from afar and fires. Then it turns away, extends until there is room to
 * turn, and comes back for the next pass. */
static void pass(const struct step_context *context, uint32_t i, const struct kind *kind,
                 const struct aim *aim, double share, struct desired_motion *desired)
{
    const struct entities *m = context->m;
    double heading = m->row[i].heading;
    bool ahead = fabs(maths_wrap_half(aim->heading - heading)) < HALF_PI;
    bool loaded = context->tick >= m->row[i].reload_tick;
    double least = (loaded ? BREAK_OFF : BREAK_SHARE) * kind->range_m;
    bool inbound = ahead ? aim->distance > least : aim->distance > share * kind->range_m;
    desired->heading_rad = inbound ? aim->heading : heading;
    desired->speed_mps = kind->max_speed_mps;
    if (ahead && !inbound)
        desired->heading_rad =
            maths_wrap_turn(aim->heading + (m->row[i].id % 2 ? BREAK_RAD : -BREAK_RAD));
}

/* Returns true if its hull is hidden from its target. It checks that when it looks; between two
 * looks a vehicle that has stopped stays. */
static bool hull_down(const struct step_context *context, uint32_t i, uint32_t target)
{
    if (((uint32_t)context->tick + context->m->row[i].id) % context->look_frames != 0)
        return context->m->row[i].throttle == 0.0f;
    return goal_hull_down(context, i, target);
}

/* A land vehicle does not drive after aircraft, and does not leave a place that hides its hull
 * while it sees a target that is worth its rounds. */
static void await(const struct step_context *context, uint32_t i, const struct aim *aim,
                  struct desired_motion *desired)
{
    const struct kind *kinds = context->world->kinds;
    uint32_t target = context->m->row[i].target_slot;
    if (kinds[context->m->row[i].kind].domain == DOMAIN_LAND &&
        kinds[context->committed->entities.row[target].kind].domain == DOMAIN_AIR)
        desired->speed_mps = 0.0;
    if (desired->speed_mps > 0.0 && aim->seen &&
        kinds[context->m->row[i].kind].domain == DOMAIN_LAND &&
        aim->distance <= fire_control_reach_m(context, i, target) && hull_down(context, i, target))
        desired->speed_mps = 0.0;
}

/* The distance at which it stops before its target: where its rounds hit and penetrate. */
static double stand_off_m(const struct step_context *context, uint32_t i, const struct kind *kind,
                          const struct behaviour_table *table)
{
    return maths_min(table->stand_off * kind->range_m,
                     EFFECTIVE_SHARE *
                         fire_control_effective_m(context, i, context->m->row[i].target_slot));
}

void attack_motion(const struct step_context *context, uint32_t i,
                   const struct behaviour_table *table, struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    struct aim aim = {.seen = perception_in_sight(context, i)};
    if (aim.seen) {
        struct vec3 at = step_context_position(context, w, m->row[i].target_slot);
        m->row[i].goal_x = at.x;
        m->row[i].goal_z = at.z;
    }
    double dx = m->row[i].goal_x - m->row[i].x, dz = m->row[i].goal_z - m->row[i].z;
    aim.heading = maths_heading(dx, dz);
    aim.distance = sqrt(dx * dx + dz * dz);
    switch (table->manner) {
    case MANNER_HOVER:
        hover(context, i, kind, &aim, hover_m(context, i, table->stand_off), desired);
        break;
    case MANNER_PASS:
        pass(context, i, kind, &aim, table->stand_off, desired);
        break;
    default: /* a charge is a stand-off at distance 0 */
        stand_off(kind, &aim, stand_off_m(context, i, kind, table), desired);
        await(context, i, &aim, desired);
        if (desired->speed_mps == 0.0 && shunting_aims_hull(kind))
            (void)shunting_face(context, i, aim.heading, AIMED_RAD, desired);
        break;
    }
}

/* A helicopter fires rockets from near by. They spread too much to hit a vehicle from as far as
 * they reach. */
static double rocket_reach_m(const struct step_context *context, uint32_t i, double reach)
{
    const struct kind *kinds = context->world->kinds;
    const struct kind *kind = &kinds[context->m->row[i].kind];
    bool hovers = behaviour_tables[kind->doctrine].manner == MANNER_HOVER;
    bool guided = kinds[kind->munition].guidance == GUIDANCE_HOMING;
    return hovers && !guided ? maths_min(reach, hover_m(context, i, ROCKET_SHARE)) : reach;
}

uint32_t attack_aim_frames(const struct params *params)
{
    return (uint32_t)maths_max(1.0, params->hz / AIM_HZ);
}

bool attack_ready(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    if (m->row[i].behaviour != BEHAVIOUR_ATTACK || context->tick < m->row[i].reload_tick ||
        !perception_in_sight(context, i) || !perception_armed(context, i))
        return false;
    const struct entities *w = &context->committed->entities;
    uint32_t target = m->row[i].target_slot;
    if (!entities_alive(w, target, m->row[i].target_id) || w->row[target].state != ENTITY_ACTIVE ||
        !fire_control_harms(context, i, target))
        return false;
    double range = rocket_reach_m(context, i, fire_control_reach_m(context, i, target)) + NEARLY_M;
    double dx = m->row[i].goal_x - m->row[i].x, dz = m->row[i].goal_z - m->row[i].z;
    return dx * dx + dz * dz < range * range;
}
