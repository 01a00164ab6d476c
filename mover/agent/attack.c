/* The manners of fighting (enum manner). */
#include "mover/agent/attack.h"

#include "mover/agent/perception.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define HOVER_S        12.0 /* a helicopter's cycle: it hovers, then flies to another side */
#define HOVER_SHARE    0.6  /* share of the cycle in which it hovers */
#define TOO_NEAR_SHARE 0.25 /* share of the range: if the target is nearer it backs away */
#define SIDE_RAD       1.7  /* direction to the other side, off its target */
#define NEARLY_M       50.0 /* so far out of range it begins to lay its gun */
#define BREAK_OFF      0.2  /* share of the range at which a jet's pass ends */
#define AIM_HZ         20.0 /* how often an agent tries to fire a loaded gun */

/* The target where the agent last saw it. */
struct aim {
    double heading, distance;
    bool seen;
};

static void stand_off(const struct kind *kind, const struct aim *aim, double share,
                      struct desired_motion *desired)
{
    bool there = aim->seen && aim->distance <= share * kind->range_m;
    desired->heading_rad = aim->heading;
    desired->speed_mps = there ? 0.0 : kind->max_speed_mps;
}

static void hover(const struct step_context *context, uint32_t i, const struct kind *kind,
                  const struct aim *aim, double share, struct desired_motion *desired)
{
    double round =
        ((double)context->tick * context->dt_s + (double)(context->m->id[i] % 12u)) / HOVER_S;
    double phase = round - floor(round);
    stand_off(kind, aim, share, desired);
    if (desired->speed_mps > 0.0 || phase < HOVER_SHARE)
        return;
    double side = (uint64_t)floor(round) % 2 ? SIDE_RAD : -SIDE_RAD;
    if (aim->distance < TOO_NEAR_SHARE * kind->range_m)
        side = PI;
    desired->heading_rad = maths_wrap_turn(aim->heading + side);
    desired->speed_mps = 0.5 * kind->max_speed_mps;
}

/* A jet flies to the target from afar. Near the target and past it, it flies straight on until
 * there is room to turn. */
static void pass(const struct step_context *context, uint32_t i, const struct kind *kind,
                 const struct aim *aim, double share, struct desired_motion *desired)
{
    double heading = context->m->heading[i];
    bool ahead = fabs(maths_wrap_half(aim->heading - heading)) < HALF_PI;
    bool inbound =
        ahead ? aim->distance > BREAK_OFF * kind->range_m : aim->distance > share * kind->range_m;
    desired->heading_rad = inbound ? aim->heading : heading;
    desired->speed_mps = kind->max_speed_mps;
}

void attack_motion(const struct step_context *context, uint32_t i,
                   const struct behaviour_table *table, struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    struct aim aim = {.seen = perception_in_sight(context, i)};
    if (aim.seen) {
        m->goal_x[i] = w->x[m->target_slot[i]];
        m->goal_z[i] = w->z[m->target_slot[i]];
    }
    double dx = m->goal_x[i] - m->x[i], dz = m->goal_z[i] - m->z[i];
    aim.heading = maths_heading(dx, dz);
    aim.distance = sqrt(dx * dx + dz * dz);
    switch (table->manner) {
    case MANNER_HOVER:
        hover(context, i, kind, &aim, table->stand_off, desired);
        break;
    case MANNER_PASS:
        pass(context, i, kind, &aim, table->stand_off, desired);
        break;
    default: /* a charge is a stand-off at distance 0 */
        stand_off(kind, &aim, table->stand_off, desired);
        break;
    }
}

uint32_t attack_aim_frames(const struct params *params)
{
    return (uint32_t)maths_max(1.0, params->hz / AIM_HZ);
}

bool attack_ready(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    if (m->behaviour[i] != BEHAVIOUR_ATTACK || context->tick < m->reload_tick[i] ||
        !perception_in_sight(context, i) || !perception_armed(context, i))
        return false;
    double range = context->world->kinds[m->kind[i]].range_m + NEARLY_M;
    double dx = m->goal_x[i] - m->x[i], dz = m->goal_z[i] - m->z[i];
    const struct entities *w = &context->committed->entities;
    uint32_t target = m->target_slot[i];
    return dx * dx + dz * dz < range * range && entities_alive(w, target, m->target_id[i]) &&
           w->state[target] == ENTITY_ACTIVE;
}
