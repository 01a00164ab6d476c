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
    struct table committed, moved;
    const struct state_head *head; /* of moved */
    uint64_t *changed;             /* [CHECKSUM_BLOCKS] columns to hash again */
    uint64_t *written;             /* struct moved */
    bool known;                    /* is_own() */
};

/* Columns that only commands, shots, collisions and hard landings change. */
#define STILL_COLUMNS                                                                              \
    (COLUMN_BIT(harm_j) | COLUMN_BIT(bump_heading) | COLUMN_BIT(id) | COLUMN_BIT(owner_id) |       \
     COLUMN_BIT(born_tick) | COLUMN_BIT(changed_tick) | COLUMN_BIT(kind) | COLUMN_BIT(state) |     \
     COLUMN_BIT(force) | COLUMN_BIT(damage))

/* Columns that motion changes, and those that laying a gun changes. */
#define MOTION_COLUMNS                                                                             \
    (COLUMN_BIT(x) | COLUMN_BIT(y) | COLUMN_BIT(z) | COLUMN_BIT(vx) | COLUMN_BIT(vy) |             \
     COLUMN_BIT(vz) | COLUMN_BIT(heading) | COLUMN_BIT(pitch) | COLUMN_BIT(roll) |                 \
     COLUMN_BIT(fuel_l) | COLUMN_BIT(cruise_rps) | COLUMN_BIT(cruise_mps2) |                       \
     COLUMN_BIT(cruise_tick))
#define LAID_COLUMNS (GUN_COLUMNS | COLUMN_BIT(trigger))

/* Returns the columns of the block that were zero in every row and still are. Only rows that did
 * more than move can have written to them. */
static uint64_t still_blank(const struct rows *rows, const struct row_block *block,
                            const uint8_t motion[CHECKSUM_ROWS])
{
    uint64_t columns = block->blank & ~STILL_COLUMNS & ~MOTION_COLUMNS;
    uint32_t row[CHECKSUM_ROWS], count = 0;
    /* Of the rows that only move no row begins to spin in a step. A row that spins may change its
     * axis. */
    if (!row_block_lacks(block, SPIN_COLUMNS))
        columns &= ~SPIN_COLUMNS;
    if (!row_block_lacks(block, GUN_COLUMNS))
        columns &= ~LAID_COLUMNS;
    for (uint32_t i = block->first; i < block->end; i++) {
        enum motion how = (enum motion)motion[i - block->first];
        if (how != MOTION_NONE && how != MOTION_HOLD && how != MOTION_COURSE)
            row[count++] = i;
    }
    return table_zero(rows->moved, columns, row, count);
}

/* Notes that the rows of the block that are awake are written, and lists all that are. Returns
 * false if they are many, or if the committed table may not be that from which the moved one was
 * made. */
static bool list_written(const struct rows *rows, const struct row_block *block,
                         struct row_list *list)
{
    uint64_t *written = rows->written + block->first / 64;
    for (uint32_t w = 0; w < ROW_BLOCK_WORDS; w++)
        written[w] |= block->awake[w];
    return rows->known &&
           row_list_gather(list, block->first / CHECKSUM_ROWS, rows->head->used, written);
}

/* Moves the rows of the block that are awake, finds out which rest from now on, and hashes the
 * block while it is in the processor's cache. */
static void move_awake(const struct rows *rows, struct row_block *block)
{
    const struct step_context *context = rows->context;
    uint32_t number = block->first / CHECKSUM_ROWS;
    uint64_t *changed = &rows->changed[number];
    uint8_t motion[CHECKSUM_ROWS];
    struct row_list list;
    block->changed = *changed;
    block->blank = ~*changed & table_blank(rows->committed, number);
    bool harmed = row_block_move(context, block, motion);
    resting_rows_settle(&rows->mover->resting, context, block, motion, &rows->mover->neighbours,
                        &rows->mover->neighbour_lists);
    if (list_written(rows, block, &list))
        table_hash_rows(rows->moved, rows->committed, number, COLUMNS_ALL, &list);
    else {
        *changed |= COLUMNS_ALL & ~STILL_COLUMNS & ~still_blank(rows, block, motion);
        if (harmed)
            *changed |= COLUMN_BIT(harm_j);
        table_hash_block(rows->moved, number, rows->head->used, *changed);
    }
    *changed = 0;
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
        if (awake == 0)
            continue;
        atomic_fetch_add_explicit(&rows->mover->moved_rows, awake, memory_order_relaxed);
        move_awake(rows, &block);
    }
}

/* Copies the committed rows, notes that none is written yet, and wakes those that differ from what
 * this process left. The hashes of a table whose content is unknown must all be computed. */
static void take_blocks(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct rows *rows = context;
    struct resting_rows *resting = &rows->mover->resting;
    uint32_t used = rows->context->committed->head->used;
    (void)worker;
    for (uint32_t block = first; block < end; block++) {
        if (rows->known)
            resting_rows_wake_differing(resting, rows->moved, rows->committed, block, used);
        else
            resting_rows_wake_block(resting, block);
        table_take(rows->moved, rows->committed, block, used, rows->known);
        memset(rows->written + block * ROW_BLOCK_WORDS, 0, ROW_BLOCK_BYTES);
        rows->changed[block] = rows->known ? 0 : COLUMNS_ALL;
    }
}

/* A block whose column of triggers has the hash of zeros is passed over, unless the serial part has
 * written to it. */
static void pull_triggers(struct serial_context *context, const struct rows *rows)
{
    uint32_t used = context->step->committed->head->used;
    for (uint32_t first = 0; first < used; first += CHECKSUM_ROWS) {
        uint32_t block = first / CHECKSUM_ROWS;
        bool blank = rows->moved.hashes[block].column[COLUMN_trigger] == COLUMN_HASH_BLANK;
        if (!blank || rows->changed[block] & COLUMN_BIT(trigger))
            triggers_pull(context, first,
                          used - first < CHECKSUM_ROWS ? used : first + CHECKSUM_ROWS);
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

/* Hashes the columns that the serial part changed, and returns the checksum of the table. */
static uint64_t checksum(const struct rows *rows, const struct moved *moved)
{
    struct mover *mover = rows->mover;
    const struct written written = {mover->changed, moved->written};
    uint32_t used = moved->head->used;
    uint32_t known = rows->known ? block_count(rows->context->committed->head->used) : 0;
    table_hash_written(rows->moved, rows->committed, used, known, &written, mover->workers);
    memset(mover->changed, 0, sizeof mover->changed);
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
        .writer = {&moved->entities, mover->changed, mover->resting.resting, moved->written},
        .remotes = &mover->remotes};
    struct rows rows = {.context = &context,
                        .mover = mover,
                        .committed = state_table(committed),
                        .moved = moved_table(moved),
                        .head = head,
                        .changed = mover->changed,
                        .written = moved->written,
                        .known = is_own(mover, committed, moved)};
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
    mover->left = head->checksum = checksum(&rows, moved);
}
