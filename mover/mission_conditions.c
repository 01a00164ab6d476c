/* Conditions read the moved table and the battle as it is in this frame. */
#include "mover/mission_conditions.h"

#include "world/entity/kind.h"
#include "world/state.h"
#include "world/world.h"

#define THERE_M   150.0 /* so near to the end of a route or to an area */
#define ROUNDED_M 1.0   /* more than the index of neighbours rounds */
#define STRONGER  3u    /* times the enemy's vehicles: who holds an objective */

/* --- who is where ------------------------------------------------------------------------------*/

bool mission_conditions_active(const struct serial_context *context, uint32_t slot)
{
    const struct entities *m = &context->moved->entities;
    return entities_alive(m, slot, slot + 1) && m->row[slot].state == ENTITY_ACTIVE;
}

static bool within(const struct objective *objective, struct vec3 at)
{
    return at.x >= objective->x0 && at.x <= objective->x1 && at.z >= objective->z0 &&
           at.z <= objective->z1;
}

/* Counts the vehicles of each force that were in the objective when the frame began, by the index
 * of neighbours: those elsewhere cost nothing. */
static void count_present(const struct step_context *step, const struct objective *objective,
                          uint32_t present[FORCE_COUNT])
{
    const struct entities *w = &step->committed->entities;
    const struct kind *kinds = step->world->kinds;
    const struct neighbour_index_entry *entry;
    double wide_m = objective->x1 - objective->x0, deep_m = objective->z1 - objective->z0;
    struct neighbour_query query = neighbour_query_begin(
        step->neighbours, NEIGHBOUR_INDEX_LIVING, objective->x0 + 0.5 * wide_m,
        objective->z0 + 0.5 * deep_m, 0.5 * sqrt(wide_m * wide_m + deep_m * deep_m) + ROUNDED_M);
    while ((entry = neighbour_query_next(&query))) {
        uint32_t row = entry->row;
        enum domain domain = (enum domain)kinds[w->row[row].kind].domain;
        if ((domain == DOMAIN_LAND || domain == DOMAIN_SEA) &&
            within(objective, step_context_position(step, w, row)))
            present[w->row[row].force % FORCE_COUNT]++;
    }
}

enum force mission_conditions_count(const struct serial_context *context, uint32_t objective)
{
    struct objective_state *state = &context->moved->head->battle.objective[objective];
    uint32_t present[FORCE_COUNT] = {0};
    enum force before = (enum force)state->owner;
    count_present(context->step, &context->step->world->objectives[objective], present);
    for (int force = 0; force < FORCE_COUNT; force++)
        state->present[force] =
            (uint16_t)(present[force] < UINT16_MAX ? present[force] : UINT16_MAX);
    for (uint32_t force = FORCE_BLUE; force <= FORCE_RED; force++) {
        uint32_t enemy = force == FORCE_BLUE ? FORCE_RED : FORCE_BLUE;
        if (present[force] > 0 && present[force] >= STRONGER * present[enemy])
            state->owner = (uint8_t)force;
    }
    if (state->owner != (uint8_t)before)
        state->since_tick = (uint32_t)context->step->tick;
    return before;
}

uint32_t mission_conditions_able(const struct serial_context *context,
                                 const struct mission *mission)
{
    const uint32_t *member = context->step->world->mission_members + mission->first_member;
    uint32_t able = 0;
    for (uint32_t n = 0; n < mission->member_count; n++)
        able += mission_conditions_active(context, member[n]);
    return able;
}

bool mission_conditions_there(const struct serial_context *context,
                              const struct battle_phase *phase, uint32_t row)
{
    const struct world *world = context->step->world;
    const struct entities *m = &context->moved->entities;
    const struct vec3 at = step_context_position(context->step, m, row);
    const double x = at.x, z = at.z;
    if (phase->route != MISSION_NONE) {
        const struct route *route = &world->routes[phase->route];
        const struct route_point *end = &world->route_points[route->first + route->count - 1];
        return fabs(x - end->x) <= (double)route->last_x_m + THERE_M &&
               fabs(z - end->z) <= (double)route->last_z_m + THERE_M;
    }
    if (phase->area == MISSION_NONE)
        return true;
    const struct area *area = &world->areas[phase->area];
    return x >= area->x0 - THERE_M && x <= area->x1 + THERE_M && z >= area->z0 - THERE_M &&
           z <= area->z1 + THERE_M;
}

/* --- conditions --------------------------------------------------------------------------------*/

static bool arrived(const struct serial_context *context, const struct mission *mission,
                    const struct battle_phase *phase, double share)
{
    const uint32_t *member = context->step->world->mission_members + mission->first_member;
    uint32_t able = 0, there = 0;
    for (uint32_t n = 0; n < mission->member_count; n++) {
        if (!mission_conditions_active(context, member[n]))
            continue;
        able++;
        there += mission_conditions_there(context, phase, member[n]);
    }
    return (double)there >= share * (double)able;
}

static bool phase_is_over(const struct serial_context *context,
                          const struct mission_conditions *conditions)
{
    const struct mission_state *other =
        &context->moved->head->battle.mission[conditions->after_mission];
    uint32_t phase = other->resume > 0 ? other->resume - 1u : other->phase;
    return phase > conditions->after_phase;
}

static bool has_passed(const struct serial_context *context, uint32_t since_tick, double seconds)
{
    uint32_t ticks = (uint32_t)context->step->tick - since_tick;
    return seconds >= 0.0 && (double)ticks * context->step->dt_s >= seconds;
}

static bool is_given(const struct mission_conditions *conditions, enum mission_condition condition)
{
    switch (condition) {
    case MISSION_IF_FOR:
        return conditions->for_s >= 0.0;
    case MISSION_IF_AT:
        return conditions->at_s >= 0.0;
    case MISSION_IF_ARRIVED:
        return conditions->arrived > 0.0;
    case MISSION_IF_TAKEN:
        return conditions->taken != MISSION_NONE;
    case MISSION_IF_LOST:
        return conditions->lost != MISSION_NONE;
    case MISSION_IF_BELOW:
        return conditions->below > 0.0;
    case MISSION_IF_ENEMY_IN:
        return conditions->enemy_in != MISSION_NONE;
    default:
        return conditions->after_mission != MISSION_NONE;
    }
}

static bool enemy_is_in(const struct battle_state *battle, uint32_t force, uint32_t objective)
{
    uint32_t enemy = force == FORCE_BLUE ? FORCE_RED : FORCE_BLUE;
    return battle->objective[objective].present[enemy] > 0;
}

/* Returns true if a condition that is given holds. */
static bool holds(const struct serial_context *context, uint32_t index,
                  const struct battle_phase *phase, const struct mission_conditions *conditions,
                  enum mission_condition condition)
{
    const struct mission *mission = &context->step->world->missions[index];
    const struct battle_state *battle = &context->moved->head->battle;
    const struct mission_state *state = &battle->mission[index];
    switch (condition) {
    case MISSION_IF_FOR:
        return has_passed(context, state->since_tick, conditions->for_s);
    case MISSION_IF_AT:
        return has_passed(context, battle->round_tick, conditions->at_s);
    case MISSION_IF_ARRIVED:
        return arrived(context, mission, phase, conditions->arrived);
    case MISSION_IF_TAKEN:
        return battle->objective[conditions->taken].owner == mission->force;
    case MISSION_IF_LOST:
        return battle->objective[conditions->lost].owner != mission->force;
    case MISSION_IF_BELOW:
        return (double)state->able < conditions->below * (double)state->begun;
    case MISSION_IF_ENEMY_IN:
        return enemy_is_in(battle, mission->force, conditions->enemy_in);
    default:
        return phase_is_over(context, conditions);
    }
}

bool mission_conditions_hold(const struct serial_context *context, uint32_t index,
                             const struct battle_phase *phase,
                             const struct mission_conditions *conditions)
{
    const bool all = (conditions->logic & MISSION_ALL) != 0;
    bool any_given = false;
    for (int n = 0; n < MISSION_CONDITION_COUNT; n++) {
        enum mission_condition condition = (enum mission_condition)n;
        if (!is_given(conditions, condition))
            continue;
        any_given = true;
        bool negated = (conditions->logic >> n & 1u) != 0;
        if ((holds(context, index, phase, conditions, condition) != negated) != all)
            return !all;
    }
    return all && any_given;
}
