/* Agents: what an autonomous vehicle wants. Small states, each change with its reason; rows are
 * thought for independently, from the committed world. */
#include "mover/move.h"

#include "world/random.h"
#include "world/square.h"

#define CRUISE_SHARE      0.75 /* of full speed, on patrol and route */
#define ARRIVED_M         25.0
#define FIGHT_S           45.0 /* an attack without a further shot at it ends */
#define FLEE_S            30.0
#define FLEE_M            2000.0
#define BACK_OFF_S        2.5
#define BACK_OFF_M        80.0
#define STAND_OFF_SHARE   0.5  /* of its range: how near an attacker goes */
#define AIM_CONE_RAD      0.35 /* aircraft and ships fire ahead only */
#define GOAL_DRAWS        8
#define SIGHTINGS_A_FRAME 65536.0 /* distance checks all agents may spend together */

static double unit(const struct move *move, uint32_t i, enum random_purpose purpose)
{
    return random_unit(move->world->params->seed, move->tick, move->m->id[i], purpose);
}

static uint32_t after(const struct move *move, double seconds)
{
    return (uint32_t)(move->tick + (uint64_t)(seconds / move->dt_s));
}

static void become(const struct move *move, uint32_t i, enum behaviour behaviour,
                   enum agent_reason reason)
{
    struct entities *m = move->m;
    if (m->behaviour[i] == behaviour)
        return;
    m->behaviour[i] = (uint8_t)behaviour;
    m->trigger[i] = (uint8_t)((unsigned)(reason + 1) << TRIGGER_REASON_SHIFT);
}

static bool goal_suits(const struct move *move, uint32_t i, double x, double z)
{
    const struct kind *kind = &move->world->kinds[move->m->kind[i]];
    bool water = cover_is_water(terrain_cover(&move->world->terrain, x, z));
    return kind->domain == DOMAIN_AIR || (kind->domain == DOMAIN_SEA) == water;
}

/* A new goal of its patrol: a random point of its area, on ground that it can use. */
static void patrol_goal(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct area *area = &move->world->areas[m->order_arg[i]];
    for (int draw = 0; draw < GOAL_DRAWS; draw++) {
        double u = unit(move, i, RANDOM_GOAL_X) + (double)draw * 0.618033988749895;
        double v = unit(move, i, RANDOM_GOAL_Z) + (double)draw * 0.754877666246693;
        m->goal_x[i] = area->x0 + (area->x1 - area->x0) * (u - floor(u));
        m->goal_z[i] = area->z0 + (area->z1 - area->z0) * (v - floor(v));
        if (goal_suits(move, i, m->goal_x[i], m->goal_z[i]))
            return;
    }
}

static void route_goal(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct route *route = &move->world->routes[m->order_arg[i]];
    uint32_t leg = m->leg[i] % route->count;
    m->goal_x[i] = move->world->route_points[route->first + leg].x;
    m->goal_z[i] = move->world->route_points[route->first + leg].z;
    m->leg[i] = (leg + 1) % route->count;
}

static void next_goal(const struct move *move, uint32_t i)
{
    if (move->m->behaviour[i] == BEHAVIOUR_PATROL)
        patrol_goal(move, i);
    else if (move->m->behaviour[i] == BEHAVIOUR_ROUTE)
        route_goal(move, i);
}

/* An interrupted route goes on to the point that it was heading for. */
static void same_leg(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    if (m->behaviour[i] == BEHAVIOUR_ROUTE) {
        uint32_t count = move->world->routes[m->order_arg[i]].count;
        m->leg[i] = (m->leg[i] + count - 1) % count;
    }
}

static void back_to_order(const struct move *move, uint32_t i, enum agent_reason reason)
{
    struct entities *m = move->m;
    become(move, i, (enum behaviour)m->order[i], reason);
    m->target_slot[i] = m->target_id[i] = 0;
    same_leg(move, i);
    next_goal(move, i);
}

static void away_goal(const struct move *move, uint32_t i, double heading, double distance)
{
    struct entities *m = move->m;
    double sine, cosine;
    maths_sincos(heading, &sine, &cosine);
    m->goal_x[i] = maths_clamp(m->x[i] + distance * sine, 0.0, WORLD_SIDE_M);
    m->goal_z[i] = maths_clamp(m->z[i] - distance * cosine, 0.0, WORLD_SIDE_M);
}

static bool enemies(const struct entities *w, uint32_t a, uint32_t b)
{
    return w->force[a] != FORCE_NEUTRAL && w->force[b] != FORCE_NEUTRAL &&
           w->force[a] != w->force[b];
}

static bool can_shoot(const struct move *move, uint32_t i)
{
    return move->world->kinds[move->m->kind[i]].munition != KIND_NONE && move->m->rounds[i] > 0;
}

/* Fired upon (thesis row 9): returns fire or flees. */
static void hear_threat(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct entities *w = &move->committed->entities;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    uint32_t slot = m->threat_slot[i], id = m->threat_id[i];
    m->threat_slot[i] = m->threat_id[i] = 0;
    if (!entities_alive(w, slot, id) || w->state[slot] != ENTITY_ACTIVE)
        return;
    if (m->behaviour[i] == BEHAVIOUR_ATTACK) { /* fights on; the fight lasts longer */
        m->until_tick[i] = after(move, FIGHT_S);
        return;
    }
    m->target_slot[i] = slot;
    m->target_id[i] = id;
    if (can_shoot(move, i) && unit(move, i, RANDOM_COURAGE) < kind->courage) {
        become(move, i, BEHAVIOUR_ATTACK, REASON_FIRED_UPON);
        m->until_tick[i] = after(move, FIGHT_S);
        return;
    }
    become(move, i, BEHAVIOUR_FLEE, REASON_FIRED_UPON);
    m->until_tick[i] = after(move, FLEE_S);
    away_goal(move, i, maths_heading(m->x[i] - w->x[slot], m->z[i] - w->z[slot]), FLEE_M);
}

/* Looks for the nearest enemy within range. Agents look in turns: once a second each while all
 * together stay within SIGHTINGS_A_FRAME, else less often. */
static void look_out(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct entities *w = &move->committed->entities;
    uint32_t used = move->committed->head->used;
    double turns =
        maths_max(move->world->params->hz, (double)used * (double)used / SIGHTINGS_A_FRAME);
    if ((move->tick + m->id[i]) % (uint64_t)turns != 0)
        return;
    double range = move->world->kinds[m->kind[i]].range_m;
    double nearest = range * range;
    uint32_t found = SLOT_NONE;
    for (uint32_t j = 0; j < used; j++) {
        double dx = w->x[j] - w->x[i], dz = w->z[j] - w->z[i];
        double square = dx * dx + dz * dz;
        if (square < nearest && w->state[j] == ENTITY_ACTIVE && enemies(w, i, j) &&
            w->behaviour[j] != BEHAVIOUR_FLIGHT) {
            nearest = square;
            found = j;
        }
    }
    if (found == SLOT_NONE)
        return;
    m->target_slot[i] = found;
    m->target_id[i] = w->id[found];
    become(move, i, BEHAVIOUR_ATTACK, REASON_ENEMY_SEEN);
    m->until_tick[i] = after(move, FIGHT_S);
}

static void wish_goal(const struct move *move, uint32_t i, double speed, struct wish *wish)
{
    const struct entities *m = move->m;
    double dx = m->goal_x[i] - m->x[i], dz = m->goal_z[i] - m->z[i];
    wish->heading_rad = maths_heading(dx, dz);
    wish->speed_mps = speed;
}

/* What it ran into is behind: drives there forwards, or backwards when that is nearer. */
static void wish_back_off(const struct move *move, uint32_t i, double speed, struct wish *wish)
{
    const struct entities *m = move->m;
    wish_goal(move, i, speed, wish);
    if (fabs(maths_wrap_half(wish->heading_rad - m->heading[i])) > HALF_PI) {
        wish->heading_rad = maths_wrap_turn(wish->heading_rad + PI);
        wish->speed_mps = -0.4 * speed;
    }
}

static void attack(const struct move *move, uint32_t i, struct wish *wish)
{
    struct entities *m = move->m;
    const struct entities *w = &move->committed->entities;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    uint32_t target = m->target_slot[i];
    if (!entities_alive(w, target, m->target_id[i]) || w->state[target] != ENTITY_ACTIVE) {
        back_to_order(move, i, REASON_TARGET_GONE);
        return;
    }
    if (!can_shoot(move, i)) {
        become(move, i, BEHAVIOUR_FLEE, REASON_OUT_OF_ROUNDS);
        m->until_tick[i] = after(move, FLEE_S);
        away_goal(move, i, maths_heading(m->x[i] - w->x[target], m->z[i] - w->z[target]), FLEE_M);
        return;
    }
    if (move->tick >= m->until_tick[i]) {
        back_to_order(move, i, REASON_TIME_OVER);
        return;
    }
    double dx = w->x[target] - m->x[i], dz = w->z[target] - m->z[i];
    double distance = sqrt(dx * dx + dz * dz);
    m->goal_x[i] = w->x[target];
    m->goal_z[i] = w->z[target];
    wish_goal(move, i, distance > STAND_OFF_SHARE * kind->range_m ? kind->max_speed_mps : 0.0,
              wish);
    bool aimed = kind->domain == DOMAIN_LAND || /* it has a turret */
                 fabs(maths_wrap_half(wish->heading_rad - m->heading[i])) < AIM_CONE_RAD;
    if (distance < kind->range_m && aimed && move->tick >= m->reload_tick[i])
        m->trigger[i] |= TRIGGER_FIRE;
}

void move_let_go(const struct entities *m, uint32_t i)
{
    m->throttle[i] = m->steer[i] = m->climb[i] = 0.0f;
    m->traverse[i] = m->elevate[i] = m->brake[i] = 0.0f;
    m->flags[i] &= (uint8_t)~ENTITY_GEAR_MASK;
    m->driver[i] = 0;
}

static void wish_driven(const struct move *move, uint32_t i, struct wish *wish)
{
    const struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double throttle = (double)m->throttle[i];
    wish->heading_rad =
        maths_wrap_turn(m->heading[i] + (double)m->steer[i] * kind->turn_rate_rps * move->dt_s);
    wish->speed_mps = kind->max_speed_mps * (throttle < 0.0 ? 0.4 * throttle : throttle);
    if (kind->domain == DOMAIN_AIR)
        wish->altitude_m = m->y[i] - pose_ground(move, m->x[i], m->z[i]) +
                           (double)m->climb[i] * kind->climb_rate_mps / 0.8;
}

static bool arrived(const struct move *move, uint32_t i)
{
    const struct entities *m = move->m;
    double dx = m->goal_x[i] - m->x[i], dz = m->goal_z[i] - m->z[i];
    double near = ARRIVED_M + move->world->kinds[m->kind[i]].radius_m;
    /* A fast body cannot turn tighter than speed over turn rate. */
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    if (kind->min_speed_mps > 0.0)
        near = maths_max(near, 2.0 * kind->max_speed_mps / maths_max(kind->turn_rate_rps, 0.01));
    return dx * dx + dz * dz < near * near;
}

/* Reactions, before the behaviour itself: shots, bumps, an empty tank. */
static void react(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    bool bumped = m->bumped[i] != 0;
    m->bumped[i] = 0;
    if (kind->fuel_l > 0.0 && m->fuel_l[i] <= 0.0) { /* it can neither fight nor flee */
        m->order[i] = BEHAVIOUR_IDLE;
        m->threat_slot[i] = m->threat_id[i] = 0;
        become(move, i, BEHAVIOUR_IDLE, REASON_OUT_OF_FUEL);
        return;
    }
    if (m->threat_id[i] != 0)
        hear_threat(move, i);
    else if (bumped && m->behaviour[i] != BEHAVIOUR_IDLE) {
        become(move, i, BEHAVIOUR_BACK_OFF, REASON_COLLISION);
        m->until_tick[i] = after(move, BACK_OFF_S);
        away_goal(move, i, (double)m->bump_heading[i], BACK_OFF_M);
    }
}

bool agent_think(const struct move *move, uint32_t i, struct wish *wish)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double cruise = CRUISE_SHARE * kind->max_speed_mps;
    if (m->behaviour[i] == BEHAVIOUR_HOLD) {
        m->bumped[i] = 0;
        m->threat_slot[i] = m->threat_id[i] = 0;
        return false;
    }
    *wish = (struct wish){m->heading[i], 0.0, kind->cruise_altitude_m};
    if (m->behaviour[i] == BEHAVIOUR_DRIVEN) {
        m->bumped[i] = 0;
        m->threat_slot[i] = m->threat_id[i] = 0;
        if (m->driver[i] != 0 && move->tick > m->until_tick[i]) {
            move_let_go(m, i);
            back_to_order(move, i, REASON_LEASE_OVER);
        } else {
            wish_driven(move, i, wish);
            return true;
        }
    }
    react(move, i);
    if ((m->flags[i] & ENTITY_FLAG_FIRE_AT_WILL) && can_shoot(move, i) &&
        (m->behaviour[i] == BEHAVIOUR_PATROL || m->behaviour[i] == BEHAVIOUR_ROUTE ||
         m->behaviour[i] == BEHAVIOUR_IDLE))
        look_out(move, i);
    switch ((enum behaviour)m->behaviour[i]) {
    case BEHAVIOUR_PATROL:
    case BEHAVIOUR_ROUTE:
        if (arrived(move, i))
            next_goal(move, i);
        wish_goal(move, i, cruise, wish);
        break;
    case BEHAVIOUR_ATTACK:
        attack(move, i, wish);
        break;
    case BEHAVIOUR_FLEE:
        wish_goal(move, i, kind->max_speed_mps, wish);
        if (move->tick >= m->until_tick[i])
            back_to_order(move, i, REASON_TIME_OVER);
        break;
    case BEHAVIOUR_BACK_OFF:
        wish_back_off(move, i, cruise, wish);
        if (move->tick >= m->until_tick[i])
            back_to_order(move, i, REASON_TIME_OVER);
        break;
    default:
        break;
    }
    return true;
}

void agent_blocked(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    if (m->behaviour[i] == BEHAVIOUR_FLEE) /* any way out is good */
        away_goal(move, i, TWO_PI * unit(move, i, RANDOM_GOAL_X), FLEE_M);
    else
        next_goal(move, i);
}
