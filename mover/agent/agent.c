/* Agents: what an autonomous vehicle wants. What it notices (perception.c) and its doctrine's table
 * (behaviour_table.c) give its behaviour, the behaviour its goal (goal.c) and what it asks of its
 * body. Rows are thought for independently, from the committed world. */
#include "mover/agent/avoidance.h"
#include "mover/agent/attack.h"
#include "mover/agent/formation_keeping.h"
#include "mover/agent/goal.h"
#include "mover/agent/perception.h"
#include "mover/agent/script_player.h"

#include <stddef.h>

#define CRUISE_SHARE  0.75 /* of full speed, on patrol and route */
#define BACK_OFF_M    80.0
#define REVERSE_SHARE 0.4 /* of its speed, backwards */

static uint32_t after(const struct step_context *move, double seconds)
{
    return (uint32_t)(move->tick + (uint64_t)(seconds / move->dt_s));
}

static void become(const struct step_context *move, uint32_t i, enum behaviour behaviour,
                   enum agent_reason reason)
{
    struct entities *m = move->m;
    if (m->behaviour[i] == behaviour)
        return;
    m->behaviour[i] = (uint8_t)behaviour;
    m->trigger[i] = (uint8_t)((unsigned)(reason + 1) << TRIGGER_REASON_SHIFT);
}

/* --- a change of behaviour ---------------------------------------------------------------------*/

static void begin_attack(const struct step_context *move, uint32_t i, const struct notice *notice,
                         enum behaviour before)
{
    struct entities *m = move->m;
    const struct entities *w = &move->committed->entities;
    uint32_t target = notice->threat != SLOT_NONE ? notice->threat : notice->enemy;
    if (target == SLOT_NONE || (before == BEHAVIOUR_ATTACK && perception_in_sight(move, i)))
        return; /* it has one */
    goal_target(move, i, target, w->id[target]);
    bool seen = target == notice->enemy || perception_sees(move, i, target);
    m->seen_tick[i] = (uint32_t)move->tick - (seen ? 0 : UINT32_MAX / 2);
}

static void begin_flight(const struct step_context *move, uint32_t i, const struct notice *notice)
{
    struct entities *m = move->m;
    const struct entities *w = &move->committed->entities;
    uint32_t from = notice->threat != SLOT_NONE                 ? notice->threat
                    : notice->enemy != SLOT_NONE                ? notice->enemy
                    : notice->percepts & PERCEPTION_BIT(TARGET) ? m->target_slot[i]
                                                                : SLOT_NONE;
    if (from == SLOT_NONE) {
        goal_away(move, i, m->heading[i] + PI, BACK_OFF_M);
        return;
    }
    m->target_slot[i] = from;
    m->target_id[i] = w->id[from];
    goal_cover(move, i, from);
}

static void begin_order(const struct step_context *move, uint32_t i, enum behaviour before)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    m->target_slot[i] = m->target_id[i] = 0;
    if (before == BEHAVIOUR_DRIVEN)
        driver_controls_let_go(m, i);
    if (before == BEHAVIOUR_RESUPPLY) {
        m->rounds[i] = kind->rounds > m->rounds[i] ? kind->rounds : m->rounds[i];
        m->fuel_l[i] = maths_max(kind->fuel_l, m->fuel_l[i]);
    }
    goal_again(move, i);
}

static void take(const struct step_context *move, uint32_t i, const struct behaviour_table_row *row,
                 const struct notice *notice)
{
    struct entities *m = move->m;
    enum behaviour before = (enum behaviour)m->behaviour[i];
    become(move, i, (enum behaviour)(row->to == BEHAVIOUR_TABLE_ORDER ? m->order[i] : row->to),
           (enum agent_reason)row->because);
    if (row->time_s > 0)
        m->until_tick[i] = after(move, row->time_s);
    switch ((enum behaviour)row->to) {
    case BEHAVIOUR_ATTACK:
        begin_attack(move, i, notice, before);
        break;
    case BEHAVIOUR_FLEE:
        begin_flight(move, i, notice);
        break;
    case BEHAVIOUR_BACK_OFF:
        goal_away(move, i, (double)m->bump_heading[i], BACK_OFF_M);
        break;
    case BEHAVIOUR_WITHDRAW:
        m->target_slot[i] = m->target_id[i] = 0;
        goal_base(move, i);
        break;
    case BEHAVIOUR_IDLE: /* it can neither fight nor flee */
        m->order[i] = BEHAVIOUR_IDLE;
        m->target_slot[i] = m->target_id[i] = 0;
        break;
    case BEHAVIOUR_TABLE_ORDER:
        begin_order(move, i, before);
        break;
    default:
        break;
    }
}

/* --- behaviours --------------------------------------------------------------------------------*/

static void wish_goal(const struct step_context *move, uint32_t i, double speed,
                      struct desired_motion *wish)
{
    const struct entities *m = move->m;
    wish->heading_rad = maths_heading(m->goal_x[i] - m->x[i], m->goal_z[i] - m->z[i]);
    wish->speed_mps = speed;
}

/* What it ran into is behind: drives there forwards, or backwards when that is nearer. */
static void wish_back_off(const struct step_context *move, uint32_t i, double speed,
                          struct desired_motion *wish)
{
    const struct entities *m = move->m;
    wish_goal(move, i, speed, wish);
    if (fabs(maths_wrap_half(wish->heading_rad - m->heading[i])) > HALF_PI) {
        wish->heading_rad = maths_wrap_turn(wish->heading_rad + PI);
        wish->speed_mps = -REVERSE_SHARE * speed;
    }
}

/* To cover, and no further. */
static void wish_flee(const struct step_context *move, uint32_t i, const struct kind *kind,
                      struct desired_motion *wish)
{
    wish_goal(move, i, goal_arrived(move, i) ? 0.0 : kind->max_speed_mps, wish);
}

static void wish_withdraw(const struct step_context *move, uint32_t i, const struct kind *kind,
                          struct desired_motion *wish)
{
    if (goal_arrived(move, i)) /* a detour's end */
        goal_base(move, i);
    wish_goal(move, i, kind->max_speed_mps, wish);
}

/* Tank and racks fill evenly. Who cannot stand still goes round the base. */
static void wish_resupply(const struct step_context *move, uint32_t i, const struct kind *kind,
                          struct desired_motion *wish)
{
    struct entities *m = move->m;
    double left = (double)(m->until_tick[i] - (uint32_t)move->tick) * move->dt_s;
    double share = maths_clamp(1.0 - left / BEHAVIOUR_TABLE_RESUPPLY_S, 0.0, 1.0);
    uint32_t rounds = (uint32_t)(share * (double)kind->rounds);
    m->rounds[i] = rounds > m->rounds[i] ? rounds : m->rounds[i];
    m->fuel_l[i] = maths_max(m->fuel_l[i], share * kind->fuel_l);
    if (kind->min_speed_mps > 0.0)
        wish_goal(move, i, kind->min_speed_mps, wish);
}

static void wish_behaviour(const struct step_context *move, uint32_t i, struct desired_motion *wish)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double cruise = CRUISE_SHARE * kind->max_speed_mps;
    switch ((enum behaviour)m->behaviour[i]) {
    case BEHAVIOUR_PATROL:
    case BEHAVIOUR_ROUTE:
        if (goal_arrived(move, i))
            goal_next(move, i);
        wish_goal(move, i, cruise, wish);
        if (m->behaviour[i] == BEHAVIOUR_ROUTE)
            formation_keeping_lane(move, i, wish);
        break;
    case BEHAVIOUR_FOLLOW:
        formation_keeping_wish(move, i, wish);
        break;
    case BEHAVIOUR_ATTACK:
        attack_wish(move, i, &behaviour_table_tables[kind->doctrine], wish);
        break;
    case BEHAVIOUR_FLEE:
        wish_flee(move, i, kind, wish);
        break;
    case BEHAVIOUR_BACK_OFF:
        wish_back_off(move, i, cruise, wish);
        break;
    case BEHAVIOUR_SCRIPT:
        script_player_wish(move, i, wish);
        break;
    case BEHAVIOUR_DRIVEN:
        driver_controls_motion(move, i, wish);
        break;
    case BEHAVIOUR_WITHDRAW:
        wish_withdraw(move, i, kind, wish);
        break;
    case BEHAVIOUR_RESUPPLY:
        wish_resupply(move, i, kind, wish);
        break;
    default:
        break;
    }
}

/* --- its controls ------------------------------------------------------------------------------*/

/* So that it has turned as it wishes by its next thought. */
static void set_controls(const struct step_context *move, uint32_t i, const struct kind *kind,
                         const struct desired_motion *wish)
{
    struct entities *m = move->m;
    double turn = kind->turn_rate_rps * move->dt_s * (double)move->think;
    double off = maths_wrap_half(wish->heading_rad - m->heading[i]);
    m->steer[i] = (float)maths_clamp(off / maths_max(turn, 1e-9), -1.0, 1.0);
    m->throttle[i] = (float)(wish->speed_mps / maths_max(kind->max_speed_mps, 1e-9));
}

void agent_hold(const struct step_context *move, uint32_t i, struct desired_motion *wish)
{
    const struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double turn = kind->turn_rate_rps * move->dt_s;
    *wish = (struct desired_motion){
        .heading_rad = m->heading[i] + (double)m->steer[i] * turn,
        .speed_mps = (double)m->throttle[i] * kind->max_speed_mps,
        .altitude_m = kind->cruise_altitude_m,
    };
}

static void think(const struct step_context *move, uint32_t i, const struct kind *kind,
                  struct desired_motion *wish)
{
    struct entities *m = move->m;
    *wish = (struct desired_motion){.heading_rad = m->heading[i],
                                    .altitude_m = kind->cruise_altitude_m};
    struct notice notice = perception_notice(move, i);
    if (m->order[i] == BEHAVIOUR_SCRIPT)
        notice.percepts &= script_player_minds(move, i);
    const struct behaviour_table_row *row = behaviour_table_next(
        &behaviour_table_tables[kind->doctrine], (enum behaviour)m->behaviour[i], notice.percepts);
    if (row)
        take(move, i, row, &notice);
    wish_behaviour(move, i, wish);
    avoidance_steer(move, i, wish);
}

void agent_think(const struct step_context *move, uint32_t i, struct desired_motion *wish)
{
    const struct kind *kind = &move->world->kinds[move->m->kind[i]];
    think(move, i, kind, wish);
    if (!agent_at_once((enum behaviour)move->m->behaviour[i]))
        set_controls(move, i, kind, wish);
}

void agent_alone(const struct step_context *move, uint32_t i, struct desired_motion *wish)
{
    const struct entities *m = move->m;
    if (agent_at_once((enum behaviour)m->behaviour[i]) || step_context_thinks(move, i) ||
        perception_event(move, i)) {
        agent_think(move, i, wish);
        if (agent_at_once((enum behaviour)m->behaviour[i]))
            return;
    }
    agent_hold(move, i, wish);
    if (((uint32_t)move->tick + m->id[i]) % move->aim == 0 && attack_ready(move, i))
        m->trigger[i] |= TRIGGER_FIRE;
}

void agent_blocked(const struct step_context *move, uint32_t i)
{
    goal_blocked(move, i);
}
