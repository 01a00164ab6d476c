/* Changes the behaviour of agents, and sets their controls. */
#include "mover/agent/agent.h"

#include "mover/agent/aircraft_separation.h"
#include "mover/agent/attack.h"
#include "mover/agent/avoidance.h"
#include "mover/agent/fire_control.h"
#include "mover/agent/flight/terrain_following.h"
#include "mover/agent/formation_keeping.h"
#include "mover/agent/goal.h"
#include "mover/agent/landing_place.h"
#include "mover/agent/mission_route.h"
#include "mover/agent/perception.h"
#include "mover/agent/driving/progress.h"
#include "mover/agent/ship_course.h"
#include "mover/agent/driving/shunting.h"
#include "mover/agent/script_player.h"
#include "mover/agent/smoke_screen.h"
#include "mover/agent/target_search.h"
#include "mover/agent/driver_controls.h"
#include "mover/context/cruise_start.h"
#include "world/entity/disabled.h"
#include "world/state.h"
#include "world/world.h"
#include <stddef.h>

#define CRUISE_SHARE  0.75 /* share of full speed on patrol and route */
#define BACK_OFF_M    80.0
#define BACK_OFF_MPS  3.0   /* backwards, at most */
#define REST_S        8.0   /* who is stuck again stands so long or twice as long */
#define REVERSE_SHARE 0.4   /* share of the speed when it drives backwards */
#define REVERSE_M     150.0 /* so far a tank drives backwards into cover */
#define LOW_SHARE     0.4   /* of its usual height, at which an aircraft evades */
#define SLOWS_MPS2    2.0   /* a helicopter slows down so gently for its place at the base */
#define OVER_PLACE_M  6.0   /* and sets down from there */
#define LEVEL_LEAST   0.6   /* of its usual height, the lowest level over its base */
#define LEVEL_STEP    0.1   /* from level to level */
#define HOLDING_RPS                                                                                \
    0.052 /* an aeroplane without an order flies circles: 3 degrees/s, two minutes */
#define HOLDING_SHARE 1.6 /* at so many times its stalling speed: 1.2 km of radius for a jet */

/* An aircraft must bank before it turns and a ship's rudder is slow: they take this time for the
 * angle that is left, or they would swing about the heading that they want. */
#define SETTLE_AIR_S 1.2
#define SETTLE_SEA_S 6.0

/* A driver who travels corrects the course and the speed only when they are further off than this,
 * and one who stands the heading. So a decision that confirms them leaves the controls as they are.
 */
#define COURSE_OFF_RAD 0.005 /* 5 m beside a goal a kilometre ahead */
#define SPEED_OFF      0.01f /* of full speed */

static uint32_t after(const struct step_context *context, double seconds)
{
    return (uint32_t)(context->tick + (uint64_t)(seconds / context->dt_s));
}

static void become(const struct step_context *context, uint32_t i, enum behaviour behaviour,
                   enum agent_reason reason)
{
    struct entities *m = context->m;
    if (m->row[i].behaviour == behaviour)
        return;
    m->row[i].behaviour = (uint8_t)behaviour;
    m->row[i].trigger = (uint8_t)((unsigned)(reason + 1) << TRIGGER_REASON_SHIFT);
}

/* --- a change of behaviour ---------------------------------------------------------------------*/

static void begin_attack(const struct step_context *context, uint32_t i,
                         const struct notice *notice, enum behaviour before)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    uint32_t target = notice->threat != SLOT_NONE ? notice->threat : notice->enemy;
    if (before == BEHAVIOUR_REPOSITION) /* it turns to its target again */
        target = m->row[i].target_slot;
    if (target == SLOT_NONE || !fire_control_fights(context, i, target) ||
        (before == BEHAVIOUR_ATTACK && perception_in_sight(context, i)))
        return; /* it keeps its target */
    goal_target(context, i, target, w->row[target].id);
    bool seen = target == notice->enemy || target_search_sees(context, i, target);
    m->row[i].seen_tick = (uint32_t)context->tick - (seen ? 0 : UINT32_MAX / 2);
}

static void begin_flight(const struct step_context *context, uint32_t i,
                         const struct notice *notice)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    uint32_t from = notice->threat != SLOT_NONE                 ? notice->threat
                    : notice->enemy != SLOT_NONE                ? notice->enemy
                    : notice->percepts & PERCEPTION_BIT(TARGET) ? m->row[i].target_slot
                                                                : SLOT_NONE;
    if (from == SLOT_NONE) {
        goal_away(context, i, m->row[i].heading + PI, BACK_OFF_M);
        return;
    }
    m->row[i].target_slot = from;
    m->row[i].target_id = w->row[from].id;
    goal_cover(context, i, from);
    if (notice->threat != SLOT_NONE)
        smoke_screen_fire(context, i);
}

/* To another place from which it can fire at its target, or at who has just fired at it. */
static void begin_reposition(const struct step_context *context, uint32_t i,
                             const struct behaviour_table_row *row, const struct notice *notice)
{
    struct entities *m = context->m;
    if (row->because == REASON_FIRED_UPON) {
        goal_target(context, i, notice->threat,
                    context->committed->entities.row[notice->threat].id);
        m->row[i].seen_tick = (uint32_t)context->tick - UINT32_MAX / 2;
        smoke_screen_fire(context, i);
    }
    goal_position(context, i, m->row[i].target_slot);
}

static void begin_order(const struct step_context *context, uint32_t i, enum behaviour before)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    m->row[i].target_slot = m->row[i].target_id = 0;
    if (before == BEHAVIOUR_DRIVEN)
        driver_controls_release(m, i);
    if (before == BEHAVIOUR_RESUPPLY) {
        m->row[i].rounds = kind->rounds > m->row[i].rounds ? kind->rounds : m->row[i].rounds;
        m->row[i].fuel_l = maths_max(kind->fuel_l, m->row[i].fuel_l);
    }
    goal_resume(context, i);
}

/* It backs off: from what it ran into, or from where it did not get on. */
static void begin_back_off(const struct step_context *context, uint32_t i,
                           const struct behaviour_table_row *row, enum behaviour before)
{
    struct entities *m = context->m;
    if (row->because != REASON_STUCK) {
        goal_away(context, i, (double)m->row[i].bump_heading, BACK_OFF_M);
        return;
    }
    goal_away(context, i, progress_way_out(context, i, before == BEHAVIOUR_BACK_OFF), BACK_OFF_M);
    m->row[i].until_tick =
        after(context, progress_stuck(context, i) ? REST_S + (double)(m->row[i].id % 8)
                                                  : row->time_s + (double)(m->row[i].id % 4));
}

static void take(const struct step_context *context, uint32_t i,
                 const struct behaviour_table_row *row, const struct notice *notice)
{
    struct entities *m = context->m;
    enum behaviour before = (enum behaviour)m->row[i].behaviour;
    become(context, i,
           (enum behaviour)(row->to == BEHAVIOUR_TABLE_ORDER ? m->row[i].order : row->to),
           (enum agent_reason)row->because);
    if (row->time_s > 0)
        m->row[i].until_tick = after(context, row->time_s);
    switch ((enum behaviour)row->to) {
    case BEHAVIOUR_ATTACK:
        begin_attack(context, i, notice, before);
        break;
    case BEHAVIOUR_FLEE:
        begin_flight(context, i, notice);
        break;
    case BEHAVIOUR_BACK_OFF:
        begin_back_off(context, i, row, before);
        break;
    case BEHAVIOUR_REPOSITION:
        begin_reposition(context, i, row, notice);
        break;
    case BEHAVIOUR_WITHDRAW:
        m->row[i].target_slot = m->row[i].target_id = 0;
        goal_base(context, i);
        break;
    case BEHAVIOUR_IDLE: /* without fuel, or stuck fast, it cannot carry out its order */
        m->row[i].order = BEHAVIOUR_IDLE;
        m->row[i].target_slot = m->row[i].target_id = 0;
        break;
    case BEHAVIOUR_TABLE_ORDER:
        begin_order(context, i, before);
        break;
    default:
        break;
    }
}

/* --- behaviours --------------------------------------------------------------------------------*/

/* Returns the way to its goal on the map [m]. */
static double way_to_goal(const struct entities *m, uint32_t i)
{
    double dx = m->row[i].goal_x - m->row[i].x, dz = m->row[i].goal_z - m->row[i].z;
    return sqrt(dx * dx + dz * dz);
}

static void drive_to_goal(const struct step_context *context, uint32_t i, double speed,
                          struct desired_motion *desired)
{
    const struct entities *m = context->m;
    desired->heading_rad =
        maths_heading(m->row[i].goal_x - m->row[i].x, m->row[i].goal_z - m->row[i].z);
    desired->speed_mps = speed;
}

/* Drives forwards, or backwards where that needs a smaller turn. */
static void drive_either_way(const struct step_context *context, uint32_t i, double speed,
                             struct desired_motion *desired)
{
    const struct entities *m = context->m;
    drive_to_goal(context, i, speed, desired);
    if (fabs(maths_wrap_half(desired->heading_rad - m->row[i].heading)) > HALF_PI) {
        desired->heading_rad = maths_wrap_turn(desired->heading_rad + PI);
        desired->speed_mps = -REVERSE_SHARE * speed;
    }
}

/* Drives to cover and stops there. A tank that has not far to go keeps its front to the enemy. An
 * aircraft flies low. */
static void drive_to_cover(const struct step_context *context, uint32_t i, const struct kind *kind,
                           struct desired_motion *desired)
{
    const struct entities *m = context->m;
    double dx = m->row[i].goal_x - m->row[i].x, dz = m->row[i].goal_z - m->row[i].z;
    bool near = dx * dx + dz * dz < REVERSE_M * REVERSE_M;
    double speed = goal_arrived(context, i) ? 0.0 : kind->max_speed_mps;
    if (kind->doctrine == DOCTRINE_ARMOUR && near)
        drive_either_way(context, i, speed, desired);
    else
        drive_to_goal(context, i, speed, desired);
    desired->altitude_m = LOW_SHARE * kind->cruise_altitude_m;
}

/* Drives to a firing position, no faster than it can stop there. */
static void drive_to_position(const struct step_context *context, uint32_t i,
                              const struct kind *kind, struct desired_motion *desired)
{
    const struct entities *m = context->m;
    double stops = sqrt(2.0 * kind->acceleration_mps2 * way_to_goal(m, i));
    drive_either_way(context, i, CRUISE_SHARE * kind->max_speed_mps, desired);
    if (goal_in_position(context, i))
        stops = 0.0;
    desired->speed_mps = maths_clamp(desired->speed_mps, -stops, stops);
}

/* Over its base each of eight aeroplanes has a level of its own. */
static void hold_level(const struct step_context *context, uint32_t i, const struct kind *kind,
                       struct desired_motion *desired)
{
    double level = LEVEL_LEAST + LEVEL_STEP * (double)(context->m->row[i].id % 8);
    if (kind->min_speed_mps > 0.0)
        desired->altitude_m = level * kind->cruise_altitude_m;
}

static void drive_to_base(const struct step_context *context, uint32_t i, const struct kind *kind,
                          struct desired_motion *desired)
{
    double speed = kind->max_speed_mps;
    if (goal_arrived(context, i)) /* at the end of a detour */
        goal_base(context, i);
    if (kind_hovers(kind))
        speed = maths_min(speed, sqrt(2.0 * SLOWS_MPS2 * way_to_goal(context->m, i)));
    drive_to_goal(context, i, speed, desired);
    hold_level(context, i, kind, desired);
}

/* Flies to its place at the base and sets down there, if the place is clear. */
static void land_at_base(const struct step_context *context, uint32_t i,
                         struct desired_motion *desired)
{
    const struct entities *m = context->m;
    goal_base(context, i);
    double way = way_to_goal(m, i);
    bool down = (m->row[i].flags & ENTITY_FLAG_LANDED) != 0;
    if (!down && way > OVER_PLACE_M)
        drive_to_goal(context, i, maths_min(sqrt(2.0 * SLOWS_MPS2 * way), 0.5 * way), desired);
    else if (down || landing_place_is_clear(context, i))
        desired->altitude_m = 0.0;
}

/* Fuel and rounds fill up evenly. A helicopter stands on the ground meanwhile, and an aircraft that
 * cannot hover circles over the base. */
static void drive_resupply(const struct step_context *context, uint32_t i, const struct kind *kind,
                           struct desired_motion *desired)
{
    struct entities *m = context->m;
    double left = (double)(m->row[i].until_tick - (uint32_t)context->tick) * context->dt_s;
    double all = behaviour_tables[kind->doctrine].resupply_s;
    double share = maths_clamp(1.0 - left / all, 0.0, 1.0);
    uint32_t rounds = (uint32_t)(share * (double)kind->rounds);
    m->row[i].rounds = rounds > m->row[i].rounds ? rounds : m->row[i].rounds;
    m->row[i].fuel_l = maths_max(m->row[i].fuel_l, share * kind->fuel_l);
    if (kind->min_speed_mps > 0.0)
        drive_to_goal(context, i, kind->min_speed_mps, desired);
    hold_level(context, i, kind, desired);
    if (kind_hovers(kind))
        land_at_base(context, i, desired);
}

static double settle_s(const struct kind *kind)
{
    return kind->domain == DOMAIN_AIR   ? SETTLE_AIR_S
           : kind->domain == DOMAIN_SEA ? SETTLE_SEA_S
                                        : 0;
}

/* The time [s] in which its steering completes a turn: that until its next decision, or more. */
static double turn_s(const struct step_context *context, uint32_t i, const struct kind *kind)
{
    return maths_max(context->dt_s * (double)cruise_start_think_frames(context, i), settle_s(kind));
}

static bool is_aeroplane(const struct kind *kind)
{
    return kind->domain == DOMAIN_AIR && kind->min_speed_mps > 0.0;
}

/* An aeroplane cannot stop. Without an order it circles where it is, at its usual height. */
static void fly_holding_turn(const struct step_context *context, uint32_t i,
                             const struct kind *kind, struct desired_motion *desired)
{
    if (!is_aeroplane(kind))
        return;
    desired->speed_mps = HOLDING_SHARE * kind->min_speed_mps;
    desired->heading_rad += HOLDING_RPS * turn_s(context, i, kind);
}

/* Keeps to the right of its route, unless it has a place of its own at its points. */
static void keep_route(const struct step_context *context, uint32_t i,
                       struct desired_motion *desired)
{
    const struct route *route = &context->world->routes[context->m->row[i].order_arg];
    if (!route->once || (route->spread_m <= 0.0f && context->m->row[i].leg >= 2))
        formation_keeping_route(context, i, desired);
    if (route->once)
        mission_route_pace(context, i, route, desired);
}

/* Drives from goal to goal. Where all of them are one place it stops there. */
static void drive_order(const struct step_context *context, uint32_t i, double speed_mps,
                        struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (goal_arrived(context, i))
        goal_next(context, i);
    if (goal_is_place(context, i)) {
        if (goal_arrived(context, i))
            return;
        speed_mps = maths_min(speed_mps, sqrt(2.0 * kind->acceleration_mps2 * way_to_goal(m, i)));
    }
    drive_to_goal(context, i, speed_mps, desired);
    if (m->row[i].behaviour == BEHAVIOUR_ROUTE)
        keep_route(context, i, desired);
}

static void drive_by_behaviour(const struct step_context *context, uint32_t i,
                               struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double cruise = CRUISE_SHARE * kind->max_speed_mps;
    switch ((enum behaviour)m->row[i].behaviour) {
    case BEHAVIOUR_IDLE:
        fly_holding_turn(context, i, kind, desired);
        break;
    case BEHAVIOUR_PATROL:
    case BEHAVIOUR_ROUTE:
        drive_order(context, i, cruise, desired);
        break;
    case BEHAVIOUR_FOLLOW:
        formation_keeping_follow(context, i, desired);
        break;
    case BEHAVIOUR_ATTACK:
        attack_motion(context, i, &behaviour_tables[kind->doctrine], desired);
        break;
    case BEHAVIOUR_FLEE:
        drive_to_cover(context, i, kind, desired);
        break;
    case BEHAVIOUR_REPOSITION:
        drive_to_position(context, i, kind, desired);
        break;
    case BEHAVIOUR_BACK_OFF:
        drive_either_way(context, i, cruise, desired);
        desired->speed_mps = maths_max(desired->speed_mps, -BACK_OFF_MPS);
        break;
    case BEHAVIOUR_SCRIPT:
        script_player_motion(context, i, desired);
        break;
    case BEHAVIOUR_DRIVEN:
        driver_controls_motion(context, i, desired);
        break;
    case BEHAVIOUR_WITHDRAW:
        drive_to_base(context, i, kind, desired);
        break;
    case BEHAVIOUR_RESUPPLY:
        drive_resupply(context, i, kind, desired);
        break;
    default:
        break;
    }
}

/* --- its controls ------------------------------------------------------------------------------*/

static float throttle_for(const struct kind *kind, const struct desired_motion *desired)
{
    return (float)(desired->speed_mps / maths_max(kind->max_speed_mps, 1e-9));
}

/* Returns true if a land vehicle is on its way, and neither fights nor has to stop at a place. */
static bool travels(const struct entities *m, uint32_t i, const struct kind *kind)
{
    return kind->domain == DOMAIN_LAND &&
           (m->row[i].behaviour == BEHAVIOUR_PATROL || m->row[i].behaviour == BEHAVIOUR_ROUTE ||
            m->row[i].behaviour == BEHAVIOUR_WITHDRAW);
}

/* Sets the steering so that the turn is complete at its next decision. The climb of an agent is its
 * height over the usual one, less 1. */
static void set_controls(const struct step_context *context, uint32_t i, const struct kind *kind,
                         const struct desired_motion *desired)
{
    struct entities *m = context->m;
    double turn = kind->turn_rate_rps * turn_s(context, i, kind);
    double off = maths_wrap_half(desired->heading_rad - m->row[i].heading);
    float throttle = throttle_for(kind, desired);
    bool holds = travels(m, i, kind) && throttle != 0.0f;
    bool stands = kind->domain == DOMAIN_LAND && throttle == 0.0f;
    if ((holds || stands) && fabs(off) <= COURSE_OFF_RAD)
        off = 0.0;
    if (stands && !kind->tracked) /* wheels turn no vehicle that stands */
        off = 0.0;
    m->row[i].steer = (float)maths_clamp(off / maths_max(turn, 1e-9), -1.0, 1.0);
    if (!holds || fabsf(throttle - m->row[i].throttle) > SPEED_OFF)
        m->row[i].throttle = throttle;
    m->row[i].climb = 0.0f;
    if (kind->cruise_altitude_m > 0.0)
        m->row[i].climb =
            (float)maths_max(desired->altitude_m / kind->cruise_altitude_m - 1.0, -1.0);
}

void agent_controls_motion(const struct step_context *context, uint32_t i,
                           struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double turn = kind->turn_rate_rps * context->dt_s;
    *desired = (struct desired_motion){
        .heading_rad = m->row[i].heading + (double)m->row[i].steer * turn,
        .speed_mps = (double)m->row[i].throttle * kind->max_speed_mps,
        .altitude_m = kind->cruise_altitude_m * (1.0 + (double)m->row[i].climb),
        .held = true,
        .turn = (double)m->row[i].steer,
    };
}

/* A crew that takes cover from a burst stays there until it would fire again. Another burst keeps
 * one in cover there. */
static void suppress(const struct step_context *context, uint32_t i,
                     const struct behaviour_table_row *row)
{
    struct entities *m = context->m;
    if (context->world->kinds[m->row[i].kind].domain != DOMAIN_LAND)
        return;
    double time_s = fire_control_suppress(context, i);
    uint32_t until = after(context, time_s);
    if ((row && row->because == REASON_SUPPRESSED) ||
        (m->row[i].behaviour == BEHAVIOUR_FLEE && until > m->row[i].until_tick))
        m->row[i].until_tick = until;
}

/* Keeps an aircraft from others and from the ground. */
static void fly_clear(const struct step_context *context, uint32_t i,
                      struct desired_motion *desired)
{
    double highest_m = aircraft_separation_keep(context, i, desired);
    if (is_aeroplane(&context->world->kinds[context->m->row[i].kind]))
        terrain_following_steer(context, i, highest_m, desired);
    else
        terrain_following_hover(context, i, desired);
}

static void think(const struct step_context *context, uint32_t i, const struct kind *kind,
                  struct desired_motion *desired)
{
    struct entities *m = context->m;
    *desired = (struct desired_motion){.heading_rad = m->row[i].heading,
                                       .altitude_m = kind->cruise_altitude_m};
    struct notice notice = perception_notice(context, i);
    if (m->row[i].order == BEHAVIOUR_SCRIPT)
        notice.percepts &= script_player_percepts(context, i);
    const struct behaviour_table_row *row = behaviour_table_next(
        &behaviour_tables[kind->doctrine], (enum behaviour)m->row[i].behaviour, notice.percepts);
    if (row)
        take(context, i, row, &notice);
    if (notice.percepts & PERCEPTION_BIT(SUPPRESSED))
        suppress(context, i, row);
    drive_by_behaviour(context, i, desired);
    if (kind->domain != DOMAIN_AIR && !desired->driven && progress_rests(context, i))
        desired->speed_mps = 0.0;
    if (kind->domain == DOMAIN_SEA && !desired->driven &&
        m->row[i].behaviour != BEHAVIOUR_SCRIPT) /* a script's author has chosen the course */
        ship_course_keep(context, i, desired);
    avoidance_steer(context, i, desired);
    if (kind->domain == DOMAIN_AIR && !desired->driven)
        fly_clear(context, i, desired);
    if (disabled_drive(kind, m, i)) {
        desired->heading_rad = m->row[i].heading;
        desired->speed_mps = desired->turn = 0.0;
    }
}

void agent_think(const struct step_context *context, uint32_t i, struct desired_motion *desired)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    think(context, i, kind, desired);
    if (!agent_thinks_each_frame((enum behaviour)context->m->row[i].behaviour))
        set_controls(context, i, kind, desired);
    else if (context->m->row[i].behaviour == BEHAVIOUR_SCRIPT && !desired->driven)
        context->m->row[i].throttle = throttle_for(kind, desired); /* progress.c compares with it */
}

void agent_direct(const struct step_context *context, uint32_t i, struct desired_motion *desired)
{
    const struct entities *m = context->m;
    if (agent_thinks_each_frame((enum behaviour)m->row[i].behaviour) ||
        perception_decides(context, i) || perception_event(context, i)) {
        agent_think(context, i, desired);
        if (agent_thinks_each_frame((enum behaviour)m->row[i].behaviour))
            return;
    }
    agent_controls_motion(context, i, desired);
    if (((uint32_t)context->tick + m->row[i].id) % context->aim_frames == 0 &&
        attack_ready(context, i))
        m->row[i].trigger |= TRIGGER_FIRE;
}
