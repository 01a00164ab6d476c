/* Turns: two passes over a piece, the thinkers and who is about to fire. */
#include "mover/agent/think_schedule.h"

#include "mover/agent/attack.h"
#include "mover/agent/perception.h"

#include <string.h>

/* Without these nothing happened to anybody: perception_event(). */
#define EVENT_COLUMNS (COLUMN_BIT(threat_id) | COLUMN_BIT(bumped) | COLUMN_BIT(damage))

struct think_schedule {
    uint32_t count;
    uint32_t row[CHECKSUM_ROWS];
};

/* --- who ---------------------------------------------------------------------------------------*/

/* Follows one on a script, which it goes on with when it has to lead. */
static bool follows_script(const struct step_context *move, uint32_t i)
{
    const struct entities *m = move->m;
    return m->order[i] == BEHAVIOUR_FOLLOW && m->order_arg[i] < move->world->counts.formations &&
           agent_at_once((enum behaviour)move->world->formations[m->order_arg[i]].order);
}

/* Of a row that was there before this frame. */
static enum motion motion_of(const struct step_context *move, uint32_t i)
{
    const struct entities *m = move->m;
    if (m->state[i] == ENTITY_FREE)
        return MOTION_NONE;
    if (m->state[i] == ENTITY_WRECK)
        return MOTION_WRECK;
    if (m->behaviour[i] == BEHAVIOUR_FLIGHT)
        return MOTION_FLIGHT;
    if (m->behaviour[i] == BEHAVIOUR_HOLD)
        return MOTION_HOLD;
    return agent_at_once((enum behaviour)m->behaviour[i]) ||
                   agent_at_once((enum behaviour)m->order[i]) || follows_script(move, i)
               ? MOTION_ALONE
               : MOTION_AGENT;
}

/* Commands made rows, or removed some. */
static bool is_new(const struct step_context *move, uint32_t i)
{
    const struct entities *w = &move->committed->entities;
    return w->state[i] == ENTITY_FREE || move->m->id[i] != w->id[i];
}

static void sort(const struct step_context *move, const struct row_block *piece, uint8_t *motion,
                 struct think_schedule *thinkers)
{
    const struct entities *m = move->m;
    const bool news = (piece->changed & COLUMN_BIT(id)) != 0;
    const bool spins = !piece_lacks(piece, SPIN_COLUMNS);
    const bool events = !piece_lacks(piece, EVENT_COLUMNS);
    thinkers->count = 0;
    for (uint32_t i = piece->first; i < piece->end; i++) {
        enum motion how = news && is_new(move, i) ? MOTION_NONE : motion_of(move, i);
        if (how >= MOTION_HOLD && spins)
            spin_row(move, i);
        if (how == MOTION_HOLD) { /* it notices nothing */
            m->bumped[i] = 0;
            m->threat_slot[i] = m->threat_id[i] = 0;
        }
        if (how == MOTION_AGENT) {
            if (step_context_thinks(move, i) || (events && perception_event(move, i)))
                thinkers->row[thinkers->count++] = i;
            else
                how = MOTION_COURSE;
        }
        motion[i - piece->first] = (uint8_t)how;
    }
}

/* --- they think --------------------------------------------------------------------------------*/

static void think(const struct step_context *move, const struct think_schedule *thinkers)
{
    for (uint32_t n = 0; n < thinkers->count; n++) {
        struct desired_motion wish;
        agent_think(move, thinkers->row[n], &wish);
    }
}

/* --- and fire ----------------------------------------------------------------------------------*/

static void aim(const struct step_context *move, const struct row_block *piece,
                const uint8_t *motion)
{
    const struct entities *m = move->m;
    uint64_t divisor = neighbour_index_divisor(move->aim);
    for (uint32_t i = piece->first; i < piece->end; i++) {
        enum motion how = (enum motion)motion[i - piece->first];
        if ((how == MOTION_COURSE || how == MOTION_AGENT) && m->behaviour[i] == BEHAVIOUR_ATTACK &&
            neighbour_index_divides(divisor, (uint32_t)move->tick + m->id[i]) &&
            attack_ready(move, i))
            m->trigger[i] |= TRIGGER_FIRE;
    }
}

void think_schedule_take(const struct step_context *move, const struct row_block *piece,
                         uint8_t motion[CHECKSUM_ROWS])
{
    struct think_schedule thinkers;
    if (!piece_lacks(piece, COLUMN_BIT(trigger)))
        memset(move->m->trigger + piece->first, 0, piece->end - piece->first);
    sort(move, piece, motion, &thinkers);
    think(move, &thinkers);
    aim(move, piece, motion);
}
