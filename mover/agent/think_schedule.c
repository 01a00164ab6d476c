/* Sorts the rows of a block by how they move, and lets agents decide and fire. */
#include "mover/agent/think_schedule.h"

#include "mover/agent/agent.h"
#include "mover/agent/attack.h"
#include "mover/agent/perception.h"
#include "mover/motion/spin.h"
#include "mover/context/cruise_start.h"
#include "world/entity/formation.h"
#include "world/entity/remote.h"
#include "world/state.h"
#include "world/world.h"

#include <string.h>

struct think_schedule {
    uint32_t count;
    uint32_t row[CHECKSUM_ROWS];
};

/* --- how rows move -----------------------------------------------------------------------------*/

/* Returns true if it follows a leader on a script. It continues the script when it has to lead. */
static bool follows_script(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    return m->row[i].order == BEHAVIOUR_FOLLOW &&
           m->row[i].order_arg < context->world->counts.formations &&
           agent_thinks_each_frame(
               (enum behaviour)context->world->formations[m->row[i].order_arg].order);
}

/* Behaviours, and orders, of agents that decide in their turns, whatever else the row is. */
#define BEHAVIOUR_BIT(name) (1u << BEHAVIOUR_##name)
#define IN_TURNS                                                                                   \
    (BEHAVIOUR_BIT(IDLE) | BEHAVIOUR_BIT(PATROL) | BEHAVIOUR_BIT(ROUTE) | BEHAVIOUR_BIT(ATTACK) |  \
     BEHAVIOUR_BIT(FLEE) | BEHAVIOUR_BIT(BACK_OFF) | BEHAVIOUR_BIT(WITHDRAW) |                     \
     BEHAVIOUR_BIT(RESUPPLY) | BEHAVIOUR_BIT(REPOSITION))

/* Returns how a row moves that existed before this frame. */
static enum motion motion_of(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    if (m->row[i].state == ENTITY_ACTIVE && IN_TURNS >> m->row[i].behaviour & 1u &&
        IN_TURNS >> m->row[i].order & 1u)
        return MOTION_AGENT; /* as most rows */
    if (m->row[i].state == ENTITY_FREE)
        return MOTION_NONE;
    if (remote_is(m, i))
        return MOTION_REMOTE;
    if (m->row[i].state == ENTITY_WRECK)
        return MOTION_WRECK;
    if (m->row[i].behaviour == BEHAVIOUR_FLIGHT)
        return MOTION_FLIGHT;
    if (m->row[i].behaviour == BEHAVIOUR_HOLD)
        return MOTION_HOLD;
    return agent_thinks_each_frame((enum behaviour)m->row[i].behaviour) ||
                   agent_thinks_each_frame((enum behaviour)m->row[i].order) ||
                   follows_script(context, i)
               ? MOTION_ALONE
               : MOTION_AGENT;
}

/* Returns true if a command of this frame made the row. */
static bool is_new(const struct step_context *context, uint32_t i)
{
    const struct entities *w = &context->committed->entities;
    return w->row[i].state == ENTITY_FREE || context->m->row[i].id != w->row[i].id;
}

/* Returns true if its spin turns the row before it moves. Land vehicles that spin are bodies on
 * their springs (mover/motion/chassis.h), and aircraft that have landed are bodies too. */
static bool spins_first(const struct step_context *context, enum motion how, uint32_t i)
{
    enum domain domain = (enum domain)context->world->kinds[context->m->row[i].kind].domain;
    bool body = domain != DOMAIN_SEA && (context->m->row[i].flags & ENTITY_FLAG_CHASSIS) != 0;
    return (how == MOTION_HOLD && !body) ||
           (how > MOTION_HOLD && how != MOTION_REMOTE && domain != DOMAIN_LAND && !body);
}

/* Returns false if perception_event() finds none. */
static bool has_event(const struct entities *m, uint32_t i)
{
    return m->row[i].threat_id != 0 || m->row[i].bumped != 0 || m->row[i].damage != DAMAGE_NONE;
}

#define ROWS_AHEAD 8 /* from the prefetch of a row to its use */

/* Asks for the next row from `row` on that is moved. Returns that after it. */
static uint32_t prefetch_next(const struct step_context *context, const struct row_block *block,
                              uint32_t row)
{
    row = row_block_next(block, row);
    if (row >= block->end)
        return row;
    entity_prefetch(&context->m->row[row]);
    entity_prefetch(&context->committed->entities.row[row]);
    return row + 1;
}

static void sort(const struct step_context *context, const struct row_block *block, uint8_t *motion,
                 struct think_schedule *thinkers)
{
    const struct entities *m = context->m;
    const bool begins = context->cruise_frames > 1;
    uint32_t ahead = block->first;
    thinkers->count = 0;
    for (int n = 0; n < ROWS_AHEAD; n++)
        ahead = prefetch_next(context, block, ahead);
    if (!block->all)
        memset(motion, MOTION_NONE, block->end - block->first);
    for (uint32_t i = row_block_next(block, block->first); i < block->end;
         i = row_block_next(block, i + 1)) {
        ahead = prefetch_next(context, block, ahead);
        enum motion how = is_new(context, i) ? MOTION_NONE : motion_of(context, i);
        m->row[i].trigger = 0;
        if (entities_spins(m, i) && spins_first(context, how, i))
            spin_row(context, i);
        if (how == MOTION_HOLD) { /* it reacts to nothing */
            m->row[i].bumped = 0;
            m->row[i].threat_slot = m->row[i].threat_id = 0;
        }
        if (cruise_goes(m, i, context->tick - 1))
            how = MOTION_CRUISE;
        if (how == MOTION_AGENT) {
            if (step_context_thinks(context, i) ||
                (begins && cruise_start_due(context, i, context->think_frames)) ||
                (has_event(m, i) && perception_event(context, i)))
                thinkers->row[thinkers->count++] = i;
            else
                how = MOTION_COURSE;
        }
        motion[i - block->first] = (uint8_t)how;
    }
}

/* --- decisions and shots -----------------------------------------------------------------------*/

#define CELLS_AHEAD   6u /* from the prefetch of an agent's cell of neighbours to its decision */
#define ENTRIES_AHEAD 3u /* and from that of the entries */

#define AHEAD_S 3.0 /* it looks at the ground so far on its way, and at that between */

/* Asks for what decisions to come read of the agents' neighbours, and of the ground. */
static void prefetch_around(const struct step_context *context,
                            const struct think_schedule *thinkers, uint32_t n)
{
    const struct entity *row = context->m->row;
    if (n + CELLS_AHEAD < thinkers->count) {
        const struct entity *later = &row[thinkers->row[n + CELLS_AHEAD]];
        const struct terrain *terrain = &context->world->terrain;
        neighbour_index_prefetch_cell(context->neighbours, later->x, later->z);
        terrain_prefetch(terrain, later->x, later->z);
        terrain_prefetch(terrain, later->x + AHEAD_S * later->vx, later->z + AHEAD_S * later->vz);
    }
    if (n + ENTRIES_AHEAD < thinkers->count) {
        const struct entity *next = &row[thinkers->row[n + ENTRIES_AHEAD]];
        neighbour_index_prefetch_entries(context->neighbours, next->x, next->z);
    }
}

static void think(const struct step_context *context, const struct think_schedule *thinkers)
{
    for (uint32_t n = 0; n < thinkers->count; n++) {
        struct desired_motion desired;
        prefetch_around(context, thinkers, n);
        agent_think(context, thinkers->row[n], &desired);
    }
}

static void aim(const struct step_context *context, const struct row_block *block,
                const uint8_t *motion)
{
    const struct entities *m = context->m;
    uint64_t divisor = neighbour_index_divisor(context->aim_frames);
    for (uint32_t i = row_block_next(block, block->first); i < block->end;
         i = row_block_next(block, i + 1)) {
        enum motion how = (enum motion)motion[i - block->first];
        if ((how == MOTION_COURSE || how == MOTION_AGENT) &&
            m->row[i].behaviour == BEHAVIOUR_ATTACK &&
            neighbour_index_divides(divisor, (uint32_t)context->tick + m->row[i].id) &&
            attack_ready(context, i))
            m->row[i].trigger |= TRIGGER_FIRE;
    }
}

void think_schedule_run(const struct step_context *context, const struct row_block *block,
                        uint8_t motion[CHECKSUM_ROWS])
{
    struct think_schedule thinkers;
    sort(context, block, motion, &thinkers);
    think(context, &thinkers);
    aim(context, block, motion);
}
