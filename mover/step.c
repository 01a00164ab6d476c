/* The step: take the committed table, apply commands, move every row in parallel, then do serially
 * what changes other rows. */
#include "mover/step.h"

#include "mover/agent/attack.h"
#include "mover/agent/perception.h"
#include "mover/agent/think_schedule.h"
#include "mover/context/cruise_start.h"
#include "mover/mission.h"
#include "mover/motion/projectile.h"
#include "mover/row_block_move.h"
#include "mover/triggers.h"
#include "mover/weapon/fire_mission.h"
#include "mover/weapon/scenario_fires.h"
#include "mover/weapon/spawn.h"
#include "world/entity/table_write.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#include <string.h>

#define BLOCKS_A_WORKER 2u
#define ROWS_A_WORKER   (BLOCKS_A_WORKER * CHECKSUM_ROWS)

struct rows {
    const struct step_context *context;
    struct mover *mover; /* its caches */
    const struct state *committed;
    struct moved *moved;
    bool known; /* is_own() */
};

/* Notes which of the rows that were moved ask for something, and adds to the hash of their block by
 * how much they change it, while they are in the processor's cache. */
static void note_moved(const struct rows *rows, const struct row_block *block)
{
    const struct entities *m = rows->context->m, *w = &rows->committed->entities;
    uint64_t *asks = rows->mover->asks + block->first / 64, change = 0;
    memset(asks, 0, ROW_BLOCK_BYTES);
    for (uint32_t i = row_block_next(block, block->first); i < block->end;
         i = row_block_next(block, i + 1)) {
        asks[(i - block->first) / 64] |= (uint64_t)(m->row[i].trigger != 0) << i % 64;
        rows->mover->change[i] = entity_hash_change(m, w, i);
        change += rows->mover->change[i];
    }
    rows->moved->hashes[block->first / CHECKSUM_ROWS] += change;
}

/* Moves the rows of the block that are awake, and finds out which rest from now on. */
static void move_awake(const struct rows *rows, struct row_block *block)
{
    const struct step_context *context = rows->context;
    uint64_t *written = rows->moved->written + block->first / 64;
    uint8_t motion[CHECKSUM_ROWS];
    row_block_move(context, block, motion);
    resting_rows_settle(&rows->mover->resting, context, block, motion, &rows->mover->neighbours,
                        &rows->mover->neighbour_lists);
    note_moved(rows, block);
    memcpy(written, block->awake, sizeof block->awake);
}

/* Moves the committed rows; a row that a command has spawned moves from the next frame on. A block
 * in which all rows rest is not touched. */
static void move_rows(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct rows *rows = context;
    (void)worker;
    for (; first < end; first += CHECKSUM_ROWS) {
        struct row_block block = {.first = first,
                                  .end = end - first < CHECKSUM_ROWS ? end : first + CHECKSUM_ROWS};
        uint32_t awake = resting_rows_awake(&rows->mover->resting, rows->context, &block);
        if (awake == 0) {
            memset(rows->mover->asks + first / 64, 0, ROW_BLOCK_BYTES);
            continue;
        }
        atomic_fetch_add_explicit(&rows->mover->moved_rows, awake, memory_order_relaxed);
        move_awake(rows, &block);
    }
}

/* Copies the committed rows, notes that none is written yet, and wakes those that differ from what
 * this process left: they are the ones that the collider wrote. */
static void take_blocks(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct rows *rows = context;
    const struct table committed = state_table(rows->committed), moved = moved_table(rows->moved);
    struct resting_rows *resting = &rows->mover->resting;
    (void)worker;
    for (uint32_t block = first; block < end; block++) {
        const uint64_t *written = rows->committed->written + block * ROW_BLOCK_WORDS;
        if (rows->known) {
            resting_rows_wake(resting, block, written);
            table_take_rows(moved, committed, block, written);
        } else {
            resting_rows_wake_block(resting, block);
            table_take(moved, committed, block, rows->committed->head->used, false);
        }
        memset(rows->moved->written + block * ROW_BLOCK_WORDS, 0, ROW_BLOCK_BYTES);
    }
}

/* Does what rows ask for, in their order. */
static void pull_triggers(struct serial_context *context, const struct rows *rows)
{
    uint32_t used = context->step->committed->head->used;
    for (uint32_t w = 0; w * 64 < used; w++) {
        for (uint64_t left = rows->mover->asks[w]; left != 0; left &= left - 1)
            triggers_pull(context, w * 64 + (uint32_t)__builtin_ctzll(left));
    }
}

static void begin_head(struct moved *moved, const struct state_head *committed)
{
    *moved->head = *committed;
    moved->head->frame = committed->frame + 1;
    moved->head->intent_count = 0;
    moved->head->advanced = 0;
    moved->head->checksum = 0;
}

/* Returns true if the moved table is the one that this process left for the frame that is now
 * committed. Then it differs from that frame only where collisions changed rows. */
static bool is_own(const struct mover *mover, const struct state *committed,
                   const struct moved *moved)
{
    return mover->left != 0 && moved->head->checksum == mover->left &&
           moved->head->frame == committed->head->frame &&
           moved->head->used == committed->head->used;
}

/* Adds to the hashes by how much the rows change them that the serial part wrote, instead of how
 * much these had changed them when they were moved. */
static void note_serial(const struct rows *rows)
{
    const struct mover *mover = rows->mover;
    const struct moved *moved = rows->moved;
    for (uint32_t w = 0; w < block_count(moved->entities.capacity) * ROW_BLOCK_WORDS; w++) {
        for (uint64_t left = mover->serial[w]; left != 0; left &= left - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(left);
            uint64_t before = moved->written[w] & left & -left ? mover->change[row] : 0;
            moved->hashes[row / CHECKSUM_ROWS] +=
                entity_hash_change(&moved->entities, &rows->committed->entities, row) - before;
        }
        moved->written[w] |= mover->serial[w];
        mover->serial[w] = 0;
    }
}

/* Hashes what is not hashed yet, and returns the checksum of the table. */
static uint64_t checksum(const struct rows *rows)
{
    const struct moved *moved = rows->moved;
    uint32_t used = moved->head->used;
    uint32_t known = rows->known ? block_count(rows->committed->head->used) : 0;
    note_serial(rows);
    table_hash(moved_table(moved), known, used, rows->mover->workers);
    return moved_checksum_of(moved, rows_hash(moved->hashes, used));
}

struct step_context mover_context(const struct mover *mover, const struct state *committed,
                                  struct moved *moved)
{
    const struct params *params = mover->world->params;
    uint32_t used = committed->head->used;
    uint64_t tick = committed->head->tick + 1;
    bool cruises = params->cruise && params->collision.method == METHOD_SWEPT;
    uint32_t stretch = cruises ? cruise_frames(params->dt_s) : 1;
    uint32_t thinks = perception_think_frames(params, used);
    thinks = thinks > mover->decides_every ? thinks : mover->decides_every;
    uint32_t longest = cruises ? cruise_start_longest(params->dt_s, thinks) : 1;
    return (struct step_context){
        .world = mover->world,
        .committed = committed,
        .m = &moved->entities,
        .craters = &mover->craters,
        .neighbours = &mover->neighbours,
        .neighbour_lists = &mover->neighbour_lists,
        .line_of_sight = &mover->line_of_sight,
        .ground_marks = &mover->ground_marks,
        .slopes = &mover->slopes,
        .avoidance = &mover->avoidance,
        .firing_tables = mover->firing_tables,
        .terrain_entries = mover->terrain_entries,
        .terrain_entries_ahead = mover->terrain_entries_ahead,
        .tick = tick,
        .think_frames = thinks,
        .look_frames = perception_look_frames(params, used),
        .aim_frames = attack_aim_frames(params),
        .cruise_frames = longest,
        .cruise_short = stretch,
        .cruise_phase = (uint32_t)(tick % longest),
        .cruise_group_bits = cruise_start_group_bits(params->capacity),
        .dt_s = params->dt_s,
        .wind = projectile_wind(params),
    };
}

static void index_neighbours(struct mover *mover, const struct step_context *context)
{
    const struct state *committed = context->committed;
    const struct neighbour_index_frame frame = {.committed = &committed->entities,
                                                .side_m = mover->world->terrain.squares.world_m,
                                                .used = committed->head->used,
                                                .tick = (uint32_t)context->tick,
                                                .think_frames = context->think_frames,
                                                .resting = mover->resting.resting,
                                                .fresh = mover->resting.fresh};
    neighbour_index_update(&mover->neighbours, &frame, mover->workers);
    neighbour_lists_gather(&mover->neighbour_lists, &mover->neighbours, mover->world,
                           &mover->avoidance, avoidance_ahead(context), mover->workers);
}

void mover_step(struct mover *mover, const struct state *committed, struct moved *moved,
                const struct command_source sources[COMMAND_RING_COUNT])
{
    struct state_head *head = moved->head;
    const struct step_context context = mover_context(mover, committed, moved);
    struct serial_context serial_context = {
        .step = &context,
        .moved = moved,
        .writer = {&moved->entities, mover->resting.resting, mover->serial},
        .remotes = &mover->remotes};
    struct rows rows = {&context, mover, committed, moved, is_own(mover, committed, moved)};
    uint32_t used = committed->head->used;
    mover->moved_rows = 0;
    crater_index_update(&mover->craters, committed->head->crater_count);
    begin_head(moved, committed->head);
    if (!rows.known)
        table_clear_unused(&moved->entities, used, moved->entities.capacity);
    thread_pool_run(mover->workers, take_blocks, &rows, block_count(used), BLOCKS_A_WORKER);
    memset(moved->written + block_count(used) * ROW_BLOCK_WORDS, 0,
           (block_count(moved->entities.capacity) - block_count(used)) * ROW_BLOCK_BYTES);
    command_apply_all(&serial_context, sources);
    if (!head->paused || head->steps_left > 0) {
        if (head->paused)
            head->steps_left--;
        head->advanced = 1;
        head->tick = context.tick;
        index_neighbours(mover, &context);
        mover->line_of_sight.fixed_damage = committed->fixed_damage;
        ground_marks_update(&mover->ground_marks, mover->world, committed);
        resting_rows_wake_craters(&mover->resting, &context);
        resting_rows_wake_hovering(&mover->resting, &context);
        thread_pool_run(mover->workers, move_rows, &rows, used, ROWS_A_WORKER);
        scenario_fires_run(&serial_context);
        fire_mission_run(&serial_context);
        pull_triggers(&serial_context, &rows);
        mission_step(&serial_context);
        spawn_fall_back(&serial_context);
    }
    mover->left = head->checksum = checksum(&rows);
}
