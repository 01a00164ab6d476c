/* Finds the percepts. Those that are cheap are found with each decision. Looks need lines of sight
 * and are less frequent (mover/README.md). */
#include "mover/agent/perception.h"

#include "mover/agent/fire_control.h"
#include "mover/agent/goal.h"
#include "mover/agent/losses.h"
#include "mover/agent/driving/progress.h"
#include "mover/agent/target_search.h"
#include "mover/context/cruise_start.h"
#include "world/entity/disabled.h"
#include "world/maths/random.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#define THINK_HZ         10.0   /* decisions of each agent */
#define THOUGHTS_A_FRAME 3072u  /* decisions of all agents, about */
#define LOOK_S           1.0    /* between two looks of an agent */
#define LOOKS_A_FRAME    768u   /* of all agents, about */
#define SEEN_LOOKS       2u     /* a target stays in sight for so many looks */
#define ODDS_M           1500.0 /* vehicles in this radius count in the odds */
#define ODDS_MOST        16u    /* of either side: more make no difference */
#define OUTNUMBERED      3u     /* enemies to each friend; the agent is a friend, too */
#define FUEL_MARGIN      1.5    /* times the fuel for the straight path to the base */
#define FUEL_RESERVE     0.03   /* share of the tank, added to it */
#define HURT_FRAMES      1u     /* damage is an event for so many frames */

/* The share of its courage that is left, by its damage. */
static const double courage_left[DAMAGE_COUNT] = {1.0, 0.95, 0.6, 0.3, 0.0};

/* Percepts that test its courage. */
#define TESTS                                                                                      \
    (PERCEPTION_BIT(SHOT) | PERCEPTION_BIT(HURT) | PERCEPTION_BIT(OUTNUMBERED) |                   \
     PERCEPTION_BIT(TIME_OVER) | PERCEPTION_BIT(SUPPRESSED))

static const struct behaviour_table *table_of(const struct step_context *context, uint32_t i)
{
    return &behaviour_tables[context->world->kinds[context->m->row[i].kind].doctrine];
}

uint32_t perception_think_frames(const struct params *params, uint32_t used)
{
    uint32_t think_frames = (uint32_t)maths_max(1.0, params->hz / THINK_HZ);
    return think_frames > used / THOUGHTS_A_FRAME ? think_frames : used / THOUGHTS_A_FRAME;
}

uint32_t perception_look_frames(const struct params *params, uint32_t used)
{
    uint32_t look_frames = (uint32_t)maths_max(1.0, LOOK_S * params->hz);
    uint32_t think_frames = perception_think_frames(params, used);
    look_frames = look_frames > used / LOOKS_A_FRAME ? look_frames : used / LOOKS_A_FRAME;
    return look_frames < think_frames ? think_frames : look_frames / think_frames * think_frames;
}

bool perception_decides(const struct step_context *context, uint32_t i)
{
    if (context->m->row[i].order == BEHAVIOUR_SCRIPT)
        return (context->tick - 1) % context->think_frames == 0;
    return step_context_thinks(context, i);
}

bool perception_looks_out(const struct step_context *context, uint32_t i)
{
    return perception_decides(context, i) || cruise_start_due(context, i, context->think_frames);
}

static bool looks_now(const struct step_context *context, uint32_t i)
{
    return ((uint32_t)context->tick + context->m->row[i].id) % context->look_frames == 0 ||
           cruise_start_due(context, i, context->look_frames);
}

/* --- seeing ------------------------------------------------------------------------------------*/

bool perception_in_sight(const struct step_context *context, uint32_t i)
{
    return (uint32_t)context->tick - context->m->row[i].seen_tick <=
           SEEN_LOOKS * context->look_frames;
}

/* --- odds and courage --------------------------------------------------------------------------*/

static uint32_t count_near(const struct step_context *context, uint32_t i, uint32_t layers)
{
    const struct entities *w = &context->committed->entities;
    struct neighbour_query query =
        neighbour_query_begin(context->neighbours, layers, w->row[i].x, w->row[i].z, ODDS_M);
    uint32_t count = 0;
    while (count < ODDS_MOST && neighbour_query_next(&query))
        count++;
    return count;
}

/* The friends near it, of which it is one itself, and the enemies; at least one each. */
static void odds(const struct step_context *context, uint32_t i, uint32_t *friends,
                 uint32_t *enemies)
{
    uint8_t force = context->committed->entities.row[i].force;
    *friends = force == FORCE_NEUTRAL || force >= FORCE_COUNT
                   ? 1
                   : count_near(context, i, NEIGHBOUR_INDEX_LAYER(force));
    *enemies = count_near(context, i, neighbour_index_enemies((enum force)force));
    *friends = *friends > 0 ? *friends : 1;
    *enemies = *enemies > 0 ? *enemies : 1;
}

static bool brave(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    double courage = context->world->kinds[m->row[i].kind].courage;
    uint32_t friends, enemies;
    odds(context, i, &friends, &enemies);
    if (m->row[i].damage < DAMAGE_COUNT)
        courage *= courage_left[m->row[i].damage];
    courage *= maths_min(1.0, (double)friends / (double)enemies);
    return random_unit(context->world->params->seed, context->tick, m->row[i].id, RANDOM_COURAGE) <
           courage;
}

/* --- its own state -----------------------------------------------------------------------------*/

static bool is_disarmed(const struct step_context *context, uint32_t i)
{
    return disabled_gun(&context->world->kinds[context->m->row[i].kind], context->m, i);
}

bool perception_armed(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    return context->world->kinds[m->row[i].kind].munition != KIND_NONE && m->row[i].rounds > 0 &&
           !(m->row[i].flags & ENTITY_FLAG_HOLD_FIRE) && !is_disarmed(context, i);
}

/* Returns true if its fuel is only just enough for the path to its base. */
static bool low_fuel(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (!(kind->fuel_l > 0.0))
        return false;
    const struct force_base *base = &context->world->params->base[m->row[i].force % FORCE_COUNT];
    double dx = base->x - m->row[i].x, dz = base->z - m->row[i].z;
    double needed_l =
        sqrt(dx * dx + dz * dz) * kind->fuel_lps / maths_max(kind->max_speed_mps, 1e-9);
    return m->row[i].fuel_l < FUEL_MARGIN * needed_l + FUEL_RESERVE * kind->fuel_l;
}

/* Returns true if it has no rounds left; also if it spares its last ones in a fight from which it
 * may go. */
static bool without_rounds(const struct step_context *context, uint32_t i, uint32_t percepts)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (kind->munition == KIND_NONE || kind->rounds == 0)
        return false;
    bool may_go = (percepts & PERCEPTION_BIT(TARGET)) && !(percepts & PERCEPTION_BIT(STAND));
    return m->row[i].rounds == 0 || (m->row[i].behaviour == BEHAVIOUR_ATTACK && may_go &&
                                     fire_control_spares(context, i, m->row[i].target_slot));
}

static bool has_arrived(const struct step_context *context, uint32_t i)
{
    enum behaviour behaviour = (enum behaviour)context->m->row[i].behaviour;
    return behaviour == BEHAVIOUR_WITHDRAW     ? goal_at_base(context, i)
           : behaviour == BEHAVIOUR_REPOSITION ? goal_in_position(context, i)
                                               : false;
}

static uint32_t notice_state(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m, *w = &context->committed->entities;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    uint32_t target = m->row[i].target_slot, percepts = 0;
    uint8_t flags = m->row[i].flags;
    if (kind->fuel_l > 0.0 && m->row[i].fuel_l <= 0.0)
        percepts |= PERCEPTION_BIT(NO_FUEL);
    if (perception_armed(context, i))
        percepts |= PERCEPTION_BIT(ARMED);
    if (flags & ENTITY_FLAG_FIRE_AT_WILL)
        percepts |= PERCEPTION_BIT(AT_WILL);
    if ((flags & ENTITY_FLAG_STAND) || disabled_drive(kind, m, i))
        percepts |= PERCEPTION_BIT(STAND);
    if (m->row[i].target_id != 0)
        percepts |=
            entities_alive(w, target, m->row[i].target_id) && w->row[target].state == ENTITY_ACTIVE
                ? PERCEPTION_BIT(TARGET)
                : PERCEPTION_BIT(TARGET_GONE);
    if (without_rounds(context, i, percepts))
        percepts |= PERCEPTION_BIT(NO_ROUNDS);
    if (context->tick >= m->row[i].until_tick)
        percepts |= PERCEPTION_BIT(TIME_OVER);
    if (m->row[i].behaviour == BEHAVIOUR_DRIVEN && m->row[i].driver != 0 &&
        context->tick > m->row[i].until_tick)
        percepts |= PERCEPTION_BIT(LEASE_OVER);
    if (has_arrived(context, i))
        percepts |= PERCEPTION_BIT(ARRIVED);
    if (m->row[i].behaviour == BEHAVIOUR_ATTACK && fire_control_salvo_over(context, i))
        percepts |= PERCEPTION_BIT(ROUNDS_FIRED);
    if (perception_decides(context, i) && progress_stalled(context, i)) {
        percepts |= PERCEPTION_BIT(STALLED);
        if (progress_gives_up(context, i))
            percepts |= PERCEPTION_BIT(STUCK_FAST);
    }
    return percepts;
}

static bool hurt(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    return (uint32_t)context->tick - m->row[i].changed_tick <= HURT_FRAMES &&
           m->row[i].damage >= DAMAGE_MED;
}

bool perception_hurt_soon(const struct step_context *context, uint32_t i)
{
    return (uint32_t)context->tick + 1 - context->m->row[i].changed_tick <= HURT_FRAMES &&
           context->m->row[i].damage >= DAMAGE_MED;
}

bool perception_event(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    return m->row[i].threat_id != 0 || m->row[i].bumped != 0 || hurt(context, i);
}

/* An aircraft evades the fire of air defence. */
static bool evades(const struct step_context *context, uint32_t i, uint32_t threat)
{
    return threat != SLOT_NONE &&
           context->world->kinds[context->m->row[i].kind].domain == DOMAIN_AIR &&
           fire_control_air_defence(context, threat);
}

static void notice_events(const struct step_context *context, uint32_t i, struct notice *notice)
{
    const struct entities *m = context->m, *w = &context->committed->entities;
    uint32_t slot = m->row[i].threat_slot;
    if (m->row[i].threat_id != 0 && entities_alive(w, slot, m->row[i].threat_id) &&
        w->row[slot].state == ENTITY_ACTIVE) {
        notice->percepts |= PERCEPTION_BIT(SHOT);
        notice->threat = slot;
    }
    if (m->row[i].bumped != 0)
        notice->percepts |= PERCEPTION_BIT(BUMP);
    if (hurt(context, i))
        notice->percepts |= PERCEPTION_BIT(HURT);
    if ((m->row[i].flags & ENTITY_FLAG_BURST) || evades(context, i, notice->threat))
        notice->percepts |= PERCEPTION_BIT(SUPPRESSED);
    m->row[i].threat_slot = m->row[i].threat_id = 0;
    m->row[i].bumped = 0;
    m->row[i].flags &= (uint8_t)~ENTITY_FLAG_BURST;
}

/* --- looks -------------------------------------------------------------------------------------*/

/* Returns true if its table would choose another row with these percepts added. */
static bool matters(const struct step_context *context, uint32_t i, uint32_t percepts,
                    uint32_t also)
{
    return behaviour_table_differs(table_of(context, i),
                                   (enum behaviour)context->m->row[i].behaviour, percepts, also);
}

static void fight_on(const struct step_context *context, uint32_t i, uint32_t enemy)
{
    const struct entities *m = context->m;
    goal_target(context, i, enemy, context->committed->entities.row[enemy].id);
    m->row[i].seen_tick = (uint32_t)context->tick;
    m->row[i].until_tick =
        (uint32_t)(context->tick + (uint64_t)(BEHAVIOUR_TABLE_FIGHT_S / context->dt_s));
}

/* Returns true if it fights the other row, and it is still worth the rounds to fire at it. */
static bool in_reach(const struct step_context *context, uint32_t i, uint32_t other)
{
    const struct entities *w = &context->committed->entities;
    struct vec3 off = vec3_sub(step_context_position(context, w, other), entities_position(w, i));
    double dx = off.x, dz = off.z;
    return fire_control_worth(context, i, other, dx * dx + dz * dz) &&
           fire_control_fights(context, i, other);
}

/* In a fight: looks for its target, and for another enemy if it does not see the target. */
static void watch_target(const struct step_context *context, uint32_t i)
{
    uint32_t seen = context->m->row[i].target_slot;
    if (!in_reach(context, i, seen) || !target_search_sees(context, i, seen))
        seen = target_search(context, i, TARGET_SEARCH_ALERT);
    if (seen != SLOT_NONE)
        fight_on(context, i, seen);
}

/* Its target is gone. If its order is to attack enemies on sight, it looks for the next one at
 * once.
 */
static void next_target(const struct step_context *context, uint32_t i, struct notice *notice)
{
    const uint32_t over = PERCEPTION_BIT(TARGET_GONE) | PERCEPTION_BIT(TIME_OVER);
    uint32_t percepts = notice->percepts & ~over;
    const struct behaviour_table_row *row =
        behaviour_table_next(table_of(context, i), (enum behaviour)context->m->row[i].order,
                             percepts | PERCEPTION_BIT(ENEMY));
    if (!row || row->to != BEHAVIOUR_ATTACK || row->because != REASON_ENEMY_SEEN)
        return;
    uint32_t seen = target_search(context, i, TARGET_SEARCH_ALERT);
    if (seen == SLOT_NONE)
        return;
    fight_on(context, i, seen);
    notice->percepts = percepts | PERCEPTION_BIT(TARGET);
}

static void notice_look(const struct step_context *context, uint32_t i, struct notice *notice)
{
    uint32_t friends, enemies;
    if (low_fuel(context, i))
        notice->percepts |= PERCEPTION_BIT(LOW_FUEL);
    if (context->m->row[i].behaviour == BEHAVIOUR_ATTACK) {
        if (!(notice->percepts & PERCEPTION_BIT(TARGET)))
            return;
        watch_target(context, i);
        odds(context, i, &friends, &enemies);
        if (enemies >= OUTNUMBERED * friends)
            notice->percepts |= PERCEPTION_BIT(OUTNUMBERED);
    } else if (matters(context, i, notice->percepts, PERCEPTION_BIT(ENEMY))) {
        notice->enemy = target_search(context, i, TARGET_SEARCH_CALM);
        if (notice->enemy != SLOT_NONE)
            notice->percepts |= PERCEPTION_BIT(ENEMY);
        if (notice->enemy != SLOT_NONE && !fire_control_fights(context, i, notice->enemy))
            notice->percepts |= PERCEPTION_BIT(OUTGUNNED);
    }
}

/* Returns true if the row is no aircraft: those see what is behind a crest. */
static bool is_on_surface(const struct step_context *context, uint32_t row)
{
    return row != SLOT_NONE &&
           context->world->kinds[context->committed->entities.row[row].kind].domain != DOMAIN_AIR;
}

/* Returns true if it backs off in its flight from a target that it does not fight. */
static bool fled_from(const struct step_context *context, uint32_t i, uint32_t percepts)
{
    return context->m->row[i].behaviour == BEHAVIOUR_BACK_OFF &&
           (percepts & PERCEPTION_BIT(TARGET)) != 0 &&
           !fire_control_fights(context, i, context->m->row[i].target_slot);
}

struct notice perception_notice(const struct step_context *context, uint32_t i)
{
    struct notice notice = {notice_state(context, i), SLOT_NONE, SLOT_NONE};
    notice_events(context, i, &notice);
    if (notice.percepts & PERCEPTION_BIT(NO_FUEL)) { /* no other percept matters now */
        notice.percepts &= PERCEPTION_BIT(NO_FUEL) | PERCEPTION_BIT(LEASE_OVER);
        return notice;
    }
    if (context->m->row[i].behaviour == BEHAVIOUR_ATTACK &&
        (notice.percepts & PERCEPTION_BIT(TARGET_GONE)))
        next_target(context, i, &notice);
    if (looks_now(context, i))
        notice_look(context, i, &notice);
    if ((notice.percepts & PERCEPTION_BIT(SHOT)) &&
        matters(context, i, notice.percepts, PERCEPTION_BIT(LOSSES)) &&
        (losses_half(context, i) || is_disarmed(context, i)))
        notice.percepts |= PERCEPTION_BIT(LOSSES);
    if (notice.threat != SLOT_NONE && !fire_control_fights(context, i, notice.threat)) {
        if (fire_control_suits(context, i, notice.threat))
            notice.percepts |= PERCEPTION_BIT(OUTGUNNED);
        return notice; /* it cannot fire back */
    }
    if (fled_from(context, i, notice.percepts))
        return notice;
    if ((notice.percepts & TESTS) && matters(context, i, notice.percepts, PERCEPTION_BIT(BRAVE)) &&
        ((notice.percepts & PERCEPTION_BIT(STAND)) || brave(context, i)))
        notice.percepts |= PERCEPTION_BIT(BRAVE);
    if (is_on_surface(context, notice.threat) &&
        matters(context, i, notice.percepts, PERCEPTION_BIT(COVER)) &&
        goal_cover_near(context, i, notice.threat))
        notice.percepts |= PERCEPTION_BIT(COVER);
    return notice;
}

bool perception_settled(const struct step_context *context, uint32_t i)
{
    uint32_t percepts = notice_state(context, i);
    enum behaviour behaviour = (enum behaviour)context->m->row[i].behaviour;
    return !behaviour_table_next(table_of(context, i), behaviour, percepts) &&
           !low_fuel(context, i) && !matters(context, i, percepts, PERCEPTION_BIT(ENEMY)) &&
           !matters(context, i, percepts, PERCEPTION_BIT(BRAVE)) &&
           !matters(context, i, percepts, PERCEPTION_BIT(COVER));
}
