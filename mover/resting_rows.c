/* Finds the rows that rest, and wakes them. */
#include "mover/resting_rows.h"

#include "mover/agent/attack.h"
#include "mover/agent/neighbour_lists.h"
#include "mover/agent/perception.h"
#include "mover/motion/kinematics.h"
#include "mover/motion/remote_motion.h"
#include "mover/motion/ground/wreck.h"
#include "world/entity/kind.h"
#include "world/state.h"
#include "world/terrain/crater.h"
#include "world/world.h"

#include <stdlib.h>
#include <string.h>

/* A crater wakes all rows whose middle is so near to its rim: more than the half diagonal of any
 * body, and of what a query rounds. */
#define CRATER_NEAR_M 200.0

static size_t words_of(uint32_t capacity)
{
    return (capacity + CHECKSUM_ROWS - 1) / CHECKSUM_ROWS * ROW_BLOCK_WORDS;
}

int resting_rows_init(struct resting_rows *rows, uint32_t capacity, double side_m)
{
    *rows = (struct resting_rows){.resting = calloc(words_of(capacity), sizeof *rows->resting),
                                  .turns = calloc(words_of(capacity), sizeof *rows->turns),
                                  .cruising = calloc(words_of(capacity), sizeof *rows->cruising),
                                  .fresh = calloc(words_of(capacity), sizeof *rows->fresh),
                                  .ends = calloc(words_of(capacity), sizeof *rows->ends)};
    if (rows->resting && rows->turns && rows->cruising && rows->fresh && rows->ends &&
        hover_watch_init(&rows->hovering, (uint32_t)words_of(capacity), side_m) == 0)
        return 0;
    resting_rows_free(rows);
    return -1;
}

void resting_rows_free(struct resting_rows *rows)
{
    free(rows->resting);
    free(rows->turns);
    free(rows->cruising);
    free(rows->fresh);
    free(rows->ends);
    hover_watch_free(&rows->hovering);
    *rows = (struct resting_rows){0};
}

/* --- waking ------------------------------------------------------------------------------------*/

static uint64_t *block_of(const struct resting_rows *rows, uint32_t block)
{
    return rows->resting + block * ROW_BLOCK_WORDS;
}

void resting_rows_wake_block(struct resting_rows *rows, uint32_t block)
{
    memset(block_of(rows, block), 0, ROW_BLOCK_BYTES);
}

void resting_rows_wake_differing(struct resting_rows *rows, struct table moved,
                                 struct table committed, uint32_t block, uint32_t used)
{
    uint64_t *resting = block_of(rows, block), differ[ROW_BLOCK_WORDS] = {0}, any = 0;
    for (uint32_t w = 0; w < ROW_BLOCK_WORDS; w++)
        any |= resting[w];
    if (any == 0 ||
        memcmp(&moved.hashes[block], &committed.hashes[block], sizeof *moved.hashes) == 0)
        return;
    table_differing(moved, committed, block, used, COLUMNS_ALL, CHECKSUM_ROWS, differ);
    for (uint32_t w = 0; w < ROW_BLOCK_WORDS; w++)
        resting[w] &= ~differ[w];
}

static void wake_near(struct resting_rows *rows, const struct step_context *context,
                      const struct crater *crater)
{
    const struct neighbour_index_entry *entry;
    double reach = CRATER_RIM * (double)crater->radius_m + CRATER_NEAR_M;
    struct neighbour_query query = neighbour_query_begin(context->neighbours, NEIGHBOUR_INDEX_ALL,
                                                         crater->x, crater->z, reach);
    while ((entry = neighbour_query_next(&query)) != NULL)
        rows->resting[entry->row / 64] &= ~((uint64_t)1 << entry->row % 64);
}

void resting_rows_wake_craters(struct resting_rows *rows, const struct step_context *context)
{
    uint32_t count = context->committed->head->crater_count;
    uint32_t used = context->committed->head->used;
    for (uint32_t block = 0; rows->craters > count && block < block_count(used); block++)
        resting_rows_wake_block(rows, block); /* the world was set back */
    for (; rows->craters < count; rows->craters++)
        wake_near(rows, context, &context->craters->craters[rows->craters]);
    rows->craters = count;
}

void resting_rows_wake_hovering(struct resting_rows *rows, const struct step_context *context)
{
    hover_watch_wake(&rows->hovering, rows->resting, rows->cruising, context);
}

/* --- this frame's rows -------------------------------------------------------------------------*/

/* Returns those of the rows of a word that decide in this frame, or may fire. */
static uint64_t due_of(const struct step_context *context, uint32_t first, uint64_t word)
{
    const uint64_t aims = neighbour_index_divisor(context->aim_frames);
    uint64_t due = 0;
    for (; word != 0; word &= word - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(word), i = first + k;
        bool is_due = step_context_thinks(context, i) ||
                      (neighbour_index_divides(aims, (uint32_t)context->tick + context->m->id[i]) &&
                       attack_ready(context, i));
        due |= (uint64_t)is_due << k;
    }
    return due;
}

/* Returns those of the cruising rows of a word whose stretches have ended, and notes when the next
 * one of the others ends. */
static uint64_t ended_of(const struct resting_rows *rows, const struct step_context *context,
                         uint32_t first)
{
    uint64_t ended = 0;
    uint32_t next = UINT32_MAX;
    for (uint64_t left = rows->cruising[first / 64]; left != 0; left &= left - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(left), end = context->m->cruise_tick[first + k];
        if (end < context->tick)
            ended |= left & -left;
        else
            next = end < next ? end : next;
    }
    rows->ends[first / 64] = next;
    return ended;
}

uint32_t resting_rows_awake(const struct resting_rows *rows, const struct step_context *context,
                            struct row_block *block)
{
    bool burns = kinematics_hover_burns(context, block->first);
    uint32_t count = 0;
    for (uint32_t w = 0; w < ROW_BLOCK_WORDS; w++) {
        uint32_t row = block->first + w * 64;
        block->awake[w] = 0;
        if (row >= block->end)
            continue;
        uint64_t there = UINT64_MAX >> (block->end - row < 64 ? 64 - (block->end - row) : 0);
        uint64_t resting = rows->resting[row / 64], turns = rows->turns[row / 64];
        uint64_t due = due_of(context, row, there & resting & turns);
        /* An aircraft that rests only between its turns hovers as well. */
        due |= burns ? rows->hovering.hovers[row / 64] | turns : 0;
        if (rows->cruising[row / 64] != 0 && rows->ends[row / 64] < context->tick)
            due |= ended_of(rows, context, row);
        rows->fresh[row / 64] = 0;
        block->awake[w] = there & (~resting | due);
        if (block->awake[w] != 0) /* a call where the processor may not count bits */
            count += (uint32_t)__builtin_popcountll(block->awake[w]);
    }
    block->all = count == block->end - block->first;
    return count;
}

/* --- coming to rest ----------------------------------------------------------------------------*/

static bool is_still(const struct entities *m, uint32_t i)
{
    return entities_still(m, i) &&
           (!(m->flags[i] & ENTITY_FLAG_CHASSIS) || m->jolt_tick[i] == ENTITY_PINNED);
}

/* Returns true if nothing that the row knows lets it do anything else than stand. */
static bool is_at_ease(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    return kinematics_parked(m, i) && is_still(m, i) && m->target_id[i] == 0 &&
           m->threat_id[i] == 0 && m->bumped[i] == 0 && m->trigger[i] == 0 &&
           !(m->flags[i] & ENTITY_FLAG_BURST) && context->tick >= m->until_tick[i] &&
           !perception_hurt_soon(context, i);
}

/* Returns true if row i stands with a gun that is laid on its target, and will until its agent
 * decides or fires. What it decided in this frame it does already. */
static bool stands_laid(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    return m->target_id[i] != 0 && m->throttle[i] == 0.0f && m->steer[i] == 0.0f &&
           m->traverse[i] == 0.0f && m->elevate[i] == 0.0f && m->trigger[i] == 0 &&
           kind->domain == DOMAIN_LAND && kind->munition != KIND_NONE && entities_still(m, i) &&
           m->threat_id[i] == 0 && m->bumped[i] == 0 &&
           !(m->flags[i] & (ENTITY_FLAG_BURST | ENTITY_FLAG_CHASSIS)) &&
           !perception_hurt_soon(context, i);
}

/* Columns by which a decision acts on later ones alone, and fuel that is burnt in a turn. */
#define DECIDED_COLUMNS                                                                            \
    (COLUMN_BIT(fuel_l) | COLUMN_BIT(goal_x) | COLUMN_BIT(goal_z) | COLUMN_BIT(target_slot) |      \
     COLUMN_BIT(target_id) | COLUMN_BIT(until_tick) | COLUMN_BIT(seen_tick) |                      \
     COLUMN_BIT(reload_tick) | COLUMN_BIT(traverse) | COLUMN_BIT(elevate))

enum rest { REST_NONE, REST_TURNS, REST_LAID, REST_HOVERS, REST_CRUISE, REST_ALL };

static bool has_rest(const struct resting_rows *rows, uint32_t i)
{
    return rows->resting[i / 64] >> i % 64 & 1;
}

/* Returns true if row i is at rest in the air, and moves only because it burns fuel. */
static bool only_burns(const struct resting_rows *rows, uint32_t i)
{
    return has_rest(rows, i) && hover_watch_hovers(&rows->hovering, i);
}

/* Returns how an agent rests that is at ease. decided: in this frame. */
static enum rest rest_of_agent(const struct resting_rows *rows, const struct step_context *context,
                               uint32_t i, bool decided)
{
    bool flies = context->world->kinds[context->m->kind[i]].domain == DOMAIN_AIR;
    if (!decided && !only_burns(rows, i))
        return REST_TURNS;
    if (!perception_settled(context, i))
        return REST_TURNS;
    if (!flies)
        return REST_ALL;
    return !(context->m->flags[i] & ENTITY_FLAG_LANDED) && hover_watch_alone(context, i)
               ? REST_HOVERS
               : REST_TURNS;
}

/* Returns how row i rests if moving it has changed nothing. */
static enum rest rest_of(const struct resting_rows *rows, const struct step_context *context,
                         uint32_t i, enum motion motion)
{
    const struct entities *m = context->m;
    switch (motion) {
    case MOTION_NONE:
        return m->state[i] == ENTITY_FREE ? REST_ALL : REST_NONE;
    case MOTION_WRECK:
        return wreck_rests(context, i) && m->trigger[i] == 0 ? REST_ALL : REST_NONE;
    case MOTION_HOLD: /* a gun with a target is laid in the row's turn */
        return is_still(m, i) && m->trigger[i] == 0 && m->target_id[i] == 0 ? REST_ALL : REST_NONE;
    case MOTION_COURSE:
    case MOTION_AGENT:
        return is_at_ease(context, i)    ? rest_of_agent(rows, context, i, motion == MOTION_AGENT)
               : stands_laid(context, i) ? REST_LAID
                                         : REST_NONE;
    case MOTION_CRUISE:
        return REST_CRUISE;
    case MOTION_REMOTE:
        return remote_motion_stands(m, i) && m->trigger[i] == 0 ? REST_ALL : REST_NONE;
    case MOTION_FLIGHT:
    case MOTION_ALONE:
        break;
    }
    return REST_NONE;
}

/* Returns true if moving row i has changed something that may go on to change. */
static bool has_changed(const struct resting_rows *rows, const struct step_context *context,
                        uint32_t i, enum rest rest)
{
    uint64_t columns = entities_differing(context->m, &context->committed->entities, i);
    if (rest == REST_HOVERS && only_burns(rows, i))
        columns &= ~COLUMN_BIT(fuel_l);
    if (rest == REST_LAID)
        columns &= ~DECIDED_COLUMNS;
    return columns != 0;
}

static void settle_row(struct resting_rows *rows, const struct step_context *context, uint32_t i,
                       enum motion motion)
{
    const uint64_t bit = (uint64_t)1 << i % 64;
    uint64_t *resting = &rows->resting[i / 64], *turns = &rows->turns[i / 64];
    enum rest rest = rest_of(rows, context, i, motion);
    if (rest == REST_NONE && !(*resting & bit))
        return;
    rows->cruising[i / 64] &= ~bit;
    if (rest == REST_CRUISE) { /* whatever has changed, it changes no more */
        rows->cruising[i / 64] |= bit;
        rows->fresh[i / 64] |= bit;
        if (context->m->cruise_tick[i] < rows->ends[i / 64])
            rows->ends[i / 64] = context->m->cruise_tick[i];
        *resting |= bit;
    } else if (rest == REST_NONE || has_changed(rows, context, i, rest))
        *resting &= ~bit;
    else
        *resting |= bit;
    hover_watch_note(&rows->hovering, context, i, rest == REST_HOVERS);
    *turns = rest == REST_TURNS || rest == REST_LAID ? *turns | bit : *turns & ~bit;
}

_Static_assert(KINEMATICS_HOVER_ROWS == CHECKSUM_ROWS, "a block burns its fuel in one frame");
_Static_assert(BEHAVIOUR_IDLE == 0 && MOTION_HOLD < 4 && MOTION_COURSE >= 4 &&
                   MOTION_REMOTE > MOTION_ALONE && MOTION_CRUISE > MOTION_REMOTE &&
                   MOTION_CRUISE < 0x80,
               "may_rest() compares bytes");

/* Returns false if none of eight rows rests or can begin to: all have an agent or a driver here,
 * and no behaviour is to stand or to attack. True is possible otherwise. first: a multiple of 8. */
static bool may_rest(const struct resting_rows *rows, const struct entities *m, uint32_t first,
                     const uint8_t *motion)
{
    const uint64_t ones = UINT64_C(0x0101010101010101), tops = ones << 7;
    uint64_t how, behaviour;
    memcpy(&how, motion, sizeof how);
    memcpy(&behaviour, m->behaviour + first, sizeof behaviour);
    uint64_t no_agent = (how - 4 * ones) & ~how & tops; /* a byte is below 4 */
    uint64_t idle = (behaviour - ones) & ~behaviour & tops;
    uint64_t other = behaviour ^ BEHAVIOUR_ATTACK * ones;
    uint64_t attack = (other - ones) & ~other & tops;
    uint64_t remote = (how + (0x80 - MOTION_REMOTE) * ones) & tops;
    return (no_agent | idle | attack | remote | (rows->resting[first / 64] >> first % 64 & 0xff)) !=
           0;
}

static void settle(struct resting_rows *rows, const struct step_context *context, uint32_t i,
                   enum motion motion, struct neighbour_index *neighbours,
                   struct neighbour_lists *lists)
{
    bool rested = has_rest(rows, i);
    settle_row(rows, context, i, motion);
    if (rested || !has_rest(rows, i))
        return;
    neighbour_index_rests(neighbours, i);
    neighbour_lists_none(lists, i);
}

void resting_rows_settle(struct resting_rows *rows, const struct step_context *context,
                         const struct row_block *block, const uint8_t *motion,
                         struct neighbour_index *neighbours, struct neighbour_lists *lists)
{
    uint32_t i = row_block_next(block, block->first);
    while (i < block->end && !rows->never) {
        uint32_t k = i - block->first;
        if (k % 8 == 0 && i + 8 <= block->end && !may_rest(rows, context->m, i, motion + k)) {
            i = row_block_next(block, i + 8);
            continue;
        }
        settle(rows, context, i, (enum motion)motion[k], neighbours, lists);
        i = row_block_next(block, i + 1);
    }
}
