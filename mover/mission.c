/* Goes through missions and objectives in turns. A phase's orders are written into the fields that
 * agents obey: order, its argument, and whom to fire at. A vehicle that fights, flees or goes for
 * rounds obeys when it has done so; orders to withdraw and to resupply end a fight. */
#include "mover/mission.h"

#include "mover/mission_barrage.h"
#include "mover/mission_conditions.h"
#include "world/entity/event.h"
#include "world/entity/kind.h"
#include "world/entity/mission.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#include <string.h>

#define SUPPLY_S 20.0 /* in which empty racks and an empty tank fill up */

/* --- events ------------------------------------------------------------------------------------*/

static struct event_mission *tell(struct serial_context *context, enum mission_news news,
                                  uint32_t force, const char *name, const char *phase)
{
    struct event *event = serial_context_intent(context, EVENT_MISSION);
    if (!event)
        return NULL;
    event->mission.news = news;
    event->mission.round = context->moved->head->battle.round;
    event->mission.force = force;
    memcpy(event->mission.name, name, sizeof event->mission.name);
    memcpy(event->mission.phase, phase, sizeof event->mission.phase);
    return &event->mission;
}

static const char no_name[ENTITY_NAME_MAX] = "";

/* --- orders ------------------------------------------------------------------------------------*/

static enum behaviour order_of(const struct battle_phase *phase)
{
    switch ((enum mission_order)phase->order) {
    case MISSION_HOLD:
    case MISSION_RESERVE:
    case MISSION_BARRAGE:
        return BEHAVIOUR_IDLE;
    case MISSION_PATROL:
    case MISSION_STRIKE:
        return BEHAVIOUR_PATROL;
    default:
        return BEHAVIOUR_ROUTE;
    }
}

/* Returns true if the row begins with a new order at once. */
static bool obeys_at_once(const struct entities *m, uint32_t row, const struct battle_phase *phase)
{
    switch ((enum behaviour)m->row[row].behaviour) {
    case BEHAVIOUR_IDLE:
    case BEHAVIOUR_PATROL:
    case BEHAVIOUR_ROUTE:
        return true;
    case BEHAVIOUR_ATTACK:
    case BEHAVIOUR_FLEE:
        return phase->order == MISSION_WITHDRAW || phase->order == MISSION_RESUPPLY;
    default:
        return false;
    }
}

static void change_behaviour(struct serial_context *context, uint32_t row, enum behaviour to)
{
    uint8_t from = context->moved->entities.row[row].behaviour;
    struct event *event = from != to ? serial_context_intent(context, EVENT_AGENT) : NULL;
    if (event) {
        event->agent = (struct event_agent){serial_context_party(context, row), from, (uint32_t)to,
                                            REASON_COMMAND};
        context->moved->head->tally.agent_changes++;
    }
    table_set_behaviour(&context->writer, row, (uint8_t)to);
    table_set_target(&context->writer, row, 0, 0);
    /* It has arrived, so its agent chooses the next goal. */
    table_set_goal_x(&context->writer, row, context->moved->entities.row[row].x);
    table_set_goal_z(&context->writer, row, context->moved->entities.row[row].z);
}

/* Followers keep their places in their formation, whose leader obeys. */
static void give_order(struct serial_context *context, const struct battle_phase *phase,
                       uint32_t row)
{
    const struct entities *m = &context->moved->entities;
    const struct table_writer *writer = &context->writer;
    enum behaviour order = order_of(phase);
    const uint32_t engage = ENTITY_FLAG_FIRE_AT_WILL | ENTITY_FLAG_HOLD_FIRE;
    if (m->row[row].behaviour == BEHAVIOUR_HOLD || m->row[row].order == BEHAVIOUR_SCRIPT)
        return;
    table_set_flags(writer, row, (uint8_t)((m->row[row].flags & ~engage) | phase->engage));
    if (m->row[row].order == BEHAVIOUR_FOLLOW)
        return;
    table_set_order(writer, row, (uint8_t)order);
    table_set_order_arg(writer, row,
                        order == BEHAVIOUR_ROUTE  ? phase->route
                        : order == BEHAVIOUR_IDLE ? 0
                                                  : phase->area);
    table_set_leg(writer, row, 0);
    if (obeys_at_once(m, row, phase))
        change_behaviour(context, row, order);
}

static const struct battle_phase *phase_of(const struct serial_context *context, uint32_t index)
{
    const struct world *world = context->step->world;
    uint32_t phase = context->moved->head->battle.mission[index].phase;
    return &world->mission_phases[world->missions[index].first_phase + phase];
}

static void begin_phase(struct serial_context *context, uint32_t index, uint32_t number)
{
    const struct world *world = context->step->world;
    const struct mission *mission = &world->missions[index];
    struct mission_state *state = &context->moved->head->battle.mission[index];
    const uint32_t *member = world->mission_members + mission->first_member;
    state->phase = (uint16_t)number;
    state->since_tick = (uint32_t)context->step->tick;
    const struct battle_phase *phase = phase_of(context, index);
    tell(context, number < mission->phase_count ? MISSION_NEWS_PHASE : MISSION_NEWS_REACTION,
         mission->force, mission->name, phase->name);
    for (uint32_t n = 0; n < mission->member_count; n++) {
        if (mission_conditions_active(context, member[n]))
            give_order(context, phase, member[n]);
    }
}

/* --- what a phase does each second -------------------------------------------------------------*/

static void supply(struct serial_context *context, const struct battle_phase *phase, uint32_t row)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kind = &context->step->world->kinds[m->row[row].kind];
    if (!mission_conditions_there(context, phase, row))
        return;
    uint32_t rounds = m->row[row].rounds + (uint32_t)ceil((double)kind->rounds / SUPPLY_S);
    double fuel = m->row[row].fuel_l + kind->fuel_l / SUPPLY_S;
    if (m->row[row].rounds < kind->rounds)
        table_set_rounds(&context->writer, row, rounds < kind->rounds ? rounds : kind->rounds);
    if (m->row[row].fuel_l < kind->fuel_l)
        table_set_fuel_l(&context->writer, row, maths_min(fuel, kind->fuel_l));
}

static void work(struct serial_context *context, uint32_t index, uint32_t second_ticks)
{
    const struct world *world = context->step->world;
    const struct mission *mission = &world->missions[index];
    const struct battle_phase *phase = phase_of(context, index);
    const uint32_t *member = world->mission_members + mission->first_member;
    if (phase->order == MISSION_BARRAGE)
        mission_barrage(context, index, phase, second_ticks);
    for (uint32_t n = 0; n < mission->member_count && phase->order == MISSION_RESUPPLY; n++) {
        if (mission_conditions_active(context, member[n]))
            supply(context, phase, member[n]);
    }
}

/* --- from phase to phase -----------------------------------------------------------------------*/

/* Begins the first reaction whose time has come. Returns false if there is none. */
static bool react(struct serial_context *context, uint32_t index)
{
    const struct world *world = context->step->world;
    const struct mission *mission = &world->missions[index];
    struct mission_state *state = &context->moved->head->battle.mission[index];
    const struct battle_phase *reaction =
        &world->mission_phases[mission->first_phase + mission->phase_count];
    for (uint32_t n = 0; n < mission->reaction_count; n++) {
        if ((state->reacted >> n & 1u) ||
            !mission_conditions_hold(context, index, phase_of(context, index), &reaction[n].when))
            continue;
        state->reacted |= 1u << n;
        state->resume = (uint16_t)(state->phase + 1u);
        begin_phase(context, index, mission->phase_count + n);
        return true;
    }
    return false;
}

static void go_on(struct serial_context *context, uint32_t index)
{
    const struct mission *mission = &context->step->world->missions[index];
    struct mission_state *state = &context->moved->head->battle.mission[index];
    const struct battle_phase *phase = phase_of(context, index);
    uint32_t ticks = (uint32_t)context->step->tick - state->since_tick;
    if (state->resume == 0 && react(context, index))
        return;
    if ((double)ticks * context->step->dt_s < phase->at_least_s ||
        !mission_conditions_hold(context, index, phase, &phase->until))
        return;
    if (state->resume > 0) {
        uint32_t resumed = state->resume - 1u;
        state->resume = 0;
        begin_phase(context, index, resumed);
    } else if (state->phase + 1u < mission->phase_count) {
        begin_phase(context, index, state->phase + 1u);
    }
}

/* --- the battle --------------------------------------------------------------------------------*/

static void count_forces(const struct serial_context *context, uint32_t able[FORCE_COUNT])
{
    const struct entities *m = &context->moved->entities;
    memset(able, 0, FORCE_COUNT * sizeof *able);
    for (uint32_t row = 0; row < context->moved->head->used; row++) {
        if (m->row[row].state == ENTITY_ACTIVE && m->row[row].behaviour != BEHAVIOUR_FLIGHT)
            able[m->row[row].force % FORCE_COUNT]++;
    }
}

/* Between two battles the vehicles of missions get rounds and fuel. */
static void refill(struct serial_context *context, const struct mission *mission)
{
    const struct world *world = context->step->world;
    const struct entities *m = &context->moved->entities;
    const uint32_t *member = world->mission_members + mission->first_member;
    for (uint32_t n = 0; n < mission->member_count; n++) {
        const uint32_t row = member[n];
        if (!mission_conditions_active(context, row))
            continue;
        const struct kind *kind = &world->kinds[m->row[row].kind];
        if (m->row[row].rounds < kind->rounds)
            table_set_rounds(&context->writer, row, kind->rounds);
        if (m->row[row].fuel_l < kind->fuel_l)
            table_set_fuel_l(&context->writer, row, kind->fuel_l);
    }
}

static void begin_battle(struct serial_context *context)
{
    const struct world *world = context->step->world;
    struct battle_state *battle = &context->moved->head->battle;
    *battle = (struct battle_state){.round = battle->round + 1,
                                    .round_tick = (uint32_t)context->step->tick};
    count_forces(context, battle->begun);
    tell(context, MISSION_NEWS_AGAIN, FORCE_NEUTRAL, no_name, no_name);
    for (uint32_t o = 0; o < world->counts.objectives; o++) {
        battle->objective[o].owner = (uint8_t)world->objectives[o].owner;
        battle->objective[o].since_tick = battle->round_tick;
    }
    for (uint32_t index = 0; index < world->counts.missions; index++) {
        struct mission_state *state = &battle->mission[index];
        state->able = state->begun =
            (uint16_t)mission_conditions_able(context, &world->missions[index]);
        if (battle->round > 1)
            refill(context, &world->missions[index]);
        begin_phase(context, index, 0);
    }
}

/* Who holds more objectives wins; with as many, who has the greater share of its vehicles left. */
static uint32_t winner_of(const struct battle_state *battle, const uint32_t held[FORCE_COUNT])
{
    if (held[FORCE_BLUE] != held[FORCE_RED])
        return held[FORCE_BLUE] > held[FORCE_RED] ? FORCE_BLUE : FORCE_RED;
    uint64_t blue = (uint64_t)battle->able[FORCE_BLUE] * battle->begun[FORCE_RED];
    uint64_t red = (uint64_t)battle->able[FORCE_RED] * battle->begun[FORCE_BLUE];
    return blue > red ? FORCE_BLUE : red > blue ? FORCE_RED : FORCE_NEUTRAL;
}

static void end_battle(struct serial_context *context)
{
    struct battle_state *battle = &context->moved->head->battle;
    uint32_t held[FORCE_COUNT] = {0};
    for (uint32_t o = 0; o < context->step->world->counts.objectives; o++)
        held[battle->objective[o].owner % FORCE_COUNT]++;
    count_forces(context, battle->able);
    battle->ended_tick = (uint32_t)context->step->tick;
    battle->winner = winner_of(battle, held);
    struct event_mission *event =
        tell(context, MISSION_NEWS_RESULT, battle->winner, no_name, no_name);
    for (int force = 0; event && force < FORCE_COUNT; force++) {
        event->held[force] = held[force];
        event->lost[force] = battle->begun[force] > battle->able[force]
                                 ? battle->begun[force] - battle->able[force]
                                 : 0;
    }
}

/* Ends the battle, or begins it again. Returns true if all missions have begun in this frame. */
static bool keep_time(struct serial_context *context)
{
    const struct battle_params *params = &context->step->world->params->battle;
    struct battle_state *battle = &context->moved->head->battle;
    double seconds =
        (double)((uint32_t)context->step->tick - battle->round_tick) * context->step->dt_s;
    if (battle->round == 0 || (params->again_s > 0.0 && seconds >= params->again_s)) {
        begin_battle(context);
        return true;
    }
    if (battle->ended_tick == 0 && params->end_s > 0.0 && seconds >= params->end_s)
        end_battle(context);
    return false;
}

static void take_turn(struct serial_context *context, uint32_t index, uint32_t second_ticks)
{
    const struct mission *mission = &context->step->world->missions[index];
    context->moved->head->battle.mission[index].able =
        (uint16_t)mission_conditions_able(context, mission);
    go_on(context, index);
    work(context, index, second_ticks);
}

static void look_at(struct serial_context *context, uint32_t index)
{
    const struct objective *objective = &context->step->world->objectives[index];
    enum force before = mission_conditions_count(context, index);
    uint32_t owner = context->moved->head->battle.objective[index].owner;
    struct event_mission *event = owner != (uint32_t)before ? tell(context, MISSION_NEWS_OBJECTIVE,
                                                                   owner, objective->name, no_name)
                                                            : NULL;
    if (event)
        event->from = before;
}

void mission_step(struct serial_context *context)
{
    const struct world *world = context->step->world;
    uint32_t second = (uint32_t)maths_max(1.0, floor(world->params->hz + 0.5));
    uint32_t turn = (uint32_t)(context->step->tick % second);
    if (world->counts.missions == 0 || keep_time(context))
        return;
    for (uint32_t o = 0; o < world->counts.objectives; o++) {
        if (o * 7 % second == turn)
            look_at(context, o);
    }
    for (uint32_t index = 0; index < world->counts.missions; index++) {
        if ((index * 5 + 3) % second == turn)
            take_turn(context, index, second);
    }
}
