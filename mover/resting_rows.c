/* Finds the rows that rest, and wakes them. */
#include "mover/resting_rows.h"

#include "mover/agent/attack.h"
#include "mover/agent/neighbour_lists.h"
#include "mover/agent/perception.h"
#include "mover/motion/kinematics.h"
#include "mover/motion/remote_motion.h"
#include "mover/motion/ground/wreck.h"
#include "world/entity/kind.h"
#include "world/entity/row_words.h"
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
                                  .end = calloc(capacity, sizeof *rows->end),
                                  .ends = calloc(words_of(capacity), sizeof *rows->ends)};
    if (rows->resting && rows->turns && rows->cruising && rows->fresh && rows->end && rows->ends &&
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
    free(rows->end);
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

void resting_rows_wake(struct resting_rows *rows, uint32_t block, const uint64_t *bits)
{
    uint64_t *resting = block_of(rows, block);
    for (uint32_t w = 0; w < ROW_BLOCK_WORDS; w++)
        resting[w] &= ~bits[w];
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
        bool is_due =
            step_context_thinks(context, i) ||
            (neighbour_index_divides(aims, (uint32_t)context->tick + context->m->row[i].id) &&
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
        uint32_t k = (uint32_t)__builtin_ctzll(left), end = rows->end[first + k];
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
        uint64_t there = row_words_below(row / 64, block->end);
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
           (!(m->row[i].flags & ENTITY_FLAG_CHASSIS) || m->row[i].jolt_tick == ENTITY_PINNED);
}

/* Returns true if nothing that the row knows lets it do anything else than stand. */
static bool is_at_ease(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    return kinematics_parked(m, i) && is_still(m, i) && m->row[i].target_id == 0 &&
           m->row[i].threat_id == 0 && m->row[i].bumped == 0 && m->row[i].trigger == 0 &&
           !(m->row[i].flags & ENTITY_FLAG_BURST) && context->tick >= m->row[i].until_tick &&
           !perception_hurt_soon(context, i);
}

/* Returns true if row i stands with a gun that is laid on its target, and will until its agent
 * decides or fires. What it decided in this frame it does already. */
static bool stands_laid(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    return m->row[i].target_id != 0 && m->row[i].throttle == 0.0f && m->row[i].steer == 0.0f &&
           m->row[i].traverse == 0.0f && m->row[i].elevate == 0.0f && m->row[i].trigger == 0 &&
           kind->domain == DOMAIN_LAND && kind->munition != KIND_NONE && entities_still(m, i) &&
           m->row[i].threat_id == 0 && m->row[i].bumped == 0 &&
           !(m->row[i].flags & (ENTITY_FLAG_BURST | ENTITY_FLAG_CHASSIS)) &&
           !perception_hurt_soon(context, i);
}

/* Fields by which a decision acts on later ones alone, and fuel that is burnt in a turn. */
#define DECIDED_FIELDS                                                                             \
    (FIELD_BIT(fuel_l) | FIELD_BIT(goal_x) | FIELD_BIT(goal_z) | FIELD_BIT(target_slot) |          \
     FIELD_BIT(target_id) | FIELD_BIT(until_tick) | FIELD_BIT(seen_tick) |                         \
     FIELD_BIT(reload_tick) | FIELD_BIT(traverse) | FIELD_BIT(elevate))

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
    bool flies = context->world->kinds[context->m->row[i].kind].domain == DOMAIN_AIR;
    if (!decided && !only_burns(rows, i))
        return REST_TURNS;
    if (!perception_settled(context, i))
        return REST_TURNS;
    if (!flies)
        return REST_ALL;
    return !(context->m->row[i].flags & ENTITY_FLAG_LANDED) && hover_watch_alone(context, i)
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
        return m->row[i].state == ENTITY_FREE ? REST_ALL : REST_NONE;
    case MOTION_WRECK:
        return wreck_rests(context, i) && m->row[i].trigger == 0 ? REST_ALL : REST_NONE;
    case MOTION_HOLD: /* a gun with a target is laid in the row's turn */
        return is_still(m, i) && m->row[i].trigger == 0 && m->row[i].target_id == 0 ? REST_ALL
                                                                                    : REST_NONE;
    case MOTION_COURSE:
    case MOTION_AGENT:
        return is_at_ease(context, i)    ? rest_of_agent(rows, context, i, motion == MOTION_AGENT)
               : stands_laid(context, i) ? REST_LAID
                                         : REST_NONE;
    case MOTION_CRUISE:
        return REST_CRUISE;
    case MOTION_REMOTE:
        return remote_motion_stands(m, i) && m->row[i].trigger == 0 ? REST_ALL : REST_NONE;
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
    uint64_t fields = entity_differing(&context->m->row[i], &context->committed->entities.row[i]);
    if (rest == REST_HOVERS && only_burns(rows, i))
        fields &= ~FIELD_BIT(fuel_l);
    if (rest == REST_LAID)
        fields &= ~DECIDED_FIELDS;
    return fields != 0;
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
        rows->end[i] = context->m->row[i].cruise_tick;
        if (rows->end[i] < rows->ends[i / 64])
            rows->ends[i / 64] = rows->end[i];
        *resting |= bit;
    } else if (rest == REST_NONE || has_changed(rows, context, i, rest))
        *resting &= ~bit;
    else
        *resting |= bit;
    hover_watch_note(&rows->hovering, context, i, rest == REST_HOVERS);
    *turns = rest == REST_TURNS || rest == REST_LAID ? *turns | bit : *turns & ~bit;
}

_Static_assert(KINEMATICS_HOVER_ROWS == CHECKSUM_ROWS, "a block burns its fuel in one frame");
/* Returns false if row i neither rests nor can begin to: it has an agent or a driver here, and its
 * behaviour is not to stand or to attack. True is possible otherwise. */
static bool may_rest(const struct resting_rows *rows, const struct entities *m, uint32_t i,
                     enum motion motion)
{
    bool thinks = motion == MOTION_COURSE || motion == MOTION_AGENT || motion == MOTION_ALONE;
    return !thinks || m->row[i].behaviour == BEHAVIOUR_IDLE ||
           m->row[i].behaviour == BEHAVIOUR_ATTACK || has_rest(rows, i);
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
    for (uint32_t i = row_block_next(block, block->first); i < block->end && !rows->never;
         i = row_block_next(block, i + 1)) {
        enum motion how = (enum motion)motion[i - block->first];
        if (may_rest(rows, context->m, i, how))
            settle(rows, context, i, how, neighbours, lists);
    }
}
