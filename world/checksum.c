/* Checksums by blocks of rows and by entries of lists. */
#include "world/checksum.h"

#include "world/entity/dent.h"
#include "world/entity/event.h"
#include "world/entity/persistent_contact.h"
#include "world/maths/hash.h"
#include "world/state.h"
#include "world/terrain/crater.h"

#include <stddef.h>
#include <string.h>

#define BLOCKS_A_WORKER 2u /* at a time */

/* --- blocks ------------------------------------------------------------------------------------*/

uint32_t block_count(uint32_t rows)
{
    return (rows + CHECKSUM_ROWS - 1) / CHECKSUM_ROWS;
}

size_t block_hashes_bytes(uint32_t capacity)
{
    size_t bytes = block_count(capacity) * sizeof(uint64_t);
    return (bytes + TABLE_ALIGN - 1) / TABLE_ALIGN * TABLE_ALIGN;
}

size_t written_bytes(uint32_t capacity)
{
    return block_count(capacity) * ROW_BLOCK_BYTES;
}

static uint32_t block_rows(uint32_t block, uint32_t used)
{
    uint32_t first = block * CHECKSUM_ROWS;
    return used - first < CHECKSUM_ROWS ? used - first : CHECKSUM_ROWS;
}

static const uint64_t *words_of(const struct entities *e, uint32_t row)
{
    return (const uint64_t *)(const void *)&e->row[row];
}

static uint64_t block_hash(const struct entities *e, uint32_t block, uint32_t used)
{
    return word_hash(words_of(e, block * CHECKSUM_ROWS),
                     (size_t)block_rows(block, used) * ENTITY_WORDS);
}

uint64_t entity_hash_change(const struct entities *now, const struct entities *before, uint32_t row)
{
    return word_hash_change(words_of(now, row), words_of(before, row), ENTITY_WORDS,
                            (uint64_t)(row % CHECKSUM_ROWS) * ENTITY_WORDS);
}

struct hashing {
    struct table table;
    uint32_t used;
};

static void hash_blocks(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct hashing *job = context;
    (void)worker;
    for (uint32_t block = first; block < end; block++)
        job->table.hashes[block] = block_hash(job->table.entities, block, job->used);
}

void table_hash(struct table table, uint32_t first, uint32_t used, struct thread_pool *workers)
{
    struct hashing job = {table, used};
    if (first == 0)
        thread_pool_run(workers, hash_blocks, &job, block_count(used), BLOCKS_A_WORKER);
    else if (first < block_count(used))
        hash_blocks(&job, first, block_count(used), 0);
}

void table_hash_written(struct table table, const struct entities *before, uint32_t used,
                        const uint64_t *written)
{
    for (uint32_t w = 0; w * 64 < used; w++) {
        for (uint64_t left = written[w]; left != 0; left &= left - 1) {
            uint32_t row = w * 64 + (uint32_t)__builtin_ctzll(left);
            if (row >= used)
                break;
            table.hashes[row / CHECKSUM_ROWS] += entity_hash_change(table.entities, before, row);
        }
    }
}

void table_take(struct table to, struct table from, uint32_t block, uint32_t used, bool known)
{
    if (known && to.hashes[block] == from.hashes[block])
        return;
    entities_copy(to.entities, from.entities, block * CHECKSUM_ROWS, block_rows(block, used));
    to.hashes[block] = from.hashes[block];
}

#define ROWS_AHEAD 4u /* from the prefetch of a row to its copy */

void table_take_rows(struct table to, struct table from, uint32_t block, const uint64_t *bits)
{
    uint32_t row[CHECKSUM_ROWS], count = 0;
    for (uint32_t w = 0; w < ROW_BLOCK_WORDS; w++) {
        for (uint64_t left = bits[w]; left != 0; left &= left - 1) {
            uint32_t next = block * CHECKSUM_ROWS + w * 64 + (uint32_t)__builtin_ctzll(left);
            if (next < to.entities->capacity)
                row[count++] = next;
        }
    }
    for (uint32_t n = 0; n < count + ROWS_AHEAD; n++) {
        if (n < count) {
            entity_prefetch(&to.entities->row[row[n]]);
            entity_prefetch(&from.entities->row[row[n]]);
        }
        if (n >= ROWS_AHEAD)
            to.entities->row[row[n - ROWS_AHEAD]] = from.entities->row[row[n - ROWS_AHEAD]];
    }
    to.hashes[block] = from.hashes[block];
}

/* Bits, not values: two zeros of different signs differ. */
#define DIFFERS(type, name)                                                                        \
    fields |= (uint64_t)(memcmp((const unsigned char *)&a->name, (const unsigned char *)&b->name,  \
                                sizeof(type)) != 0)                                                \
              << FIELD_##name;

uint64_t entity_differing(const struct entity *a, const struct entity *b)
{
    uint64_t fields = 0;
    if (memcmp((const unsigned char *)a, (const unsigned char *)b, sizeof *a) == 0)
        return 0;
    ENTITY_FIELDS(DIFFERS)
    return fields;
}

/* --- checksums ---------------------------------------------------------------------------------*/

/* The hashes of the blocks are chained into the whole. */
static uint64_t add_block(uint64_t hash, uint64_t block)
{
    return XXH3_64bits_withSeed(&block, sizeof block, hash);
}

uint64_t rows_hash(const uint64_t *hashes, uint32_t used)
{
    uint64_t hash = 0;
    for (uint32_t block = 0; block < block_count(used); block++)
        hash = add_block(hash, hashes[block]);
    return hash;
}

uint64_t rows_hash_again(const struct entities *entities, uint32_t used)
{
    uint64_t hash = 0;
    for (uint32_t block = 0; block < block_count(used); block++)
        hash = add_block(hash, block_hash(entities, block, used));
    return hash;
}

void list_hashes_extend(struct list_hashes *hashes, const struct state *state)
{
    const struct state_head *head = state->head;
    if (hashes->craters > head->crater_count || hashes->dents > head->dent_count)
        *hashes = (struct list_hashes){0};
    for (; hashes->craters < head->crater_count; hashes->craters++)
        hashes->crater_hash = XXH3_64bits_withSeed(&state->craters[hashes->craters],
                                                   sizeof *state->craters, hashes->crater_hash);
    for (; hashes->dents < head->dent_count; hashes->dents++)
        hashes->dent_hash = XXH3_64bits_withSeed(&state->dents[hashes->dents], sizeof *state->dents,
                                                 hashes->dent_hash);
}

uint64_t state_fixed_hash(const struct state *state, uint32_t fixed_count)
{
    return XXH3_64bits(state->fixed_damage, fixed_count);
}

uint64_t state_checksum_of(const struct state *state, uint64_t rows, uint64_t fixed_hash,
                           const struct list_hashes *lists)
{
    struct state_head head = *state->head;
    const uint64_t rest[] = {
        rows, fixed_hash,
        XXH3_64bits(state->contacts, head.contact_count * sizeof *state->contacts),
        lists->crater_hash, lists->dent_hash};
    head.checksum = 0;
    return XXH3_64bits_withSeed(&head, state_head_bytes(&head), XXH3_64bits(rest, sizeof rest));
}

/* Returns the checksum for this hash of the rows. */
static uint64_t checksum_with(const struct state *state, uint64_t rows, uint32_t fixed_count)
{
    struct list_hashes lists = {0};
    list_hashes_extend(&lists, state);
    return state_checksum_of(state, rows, state_fixed_hash(state, fixed_count), &lists);
}

uint64_t state_checksum(const struct state *state, uint32_t fixed_count)
{
    return checksum_with(state, rows_hash_again(&state->entities, state->head->used), fixed_count);
}

void state_seal(struct state *state, uint32_t fixed_count)
{
    uint32_t used = state->head->used;
    table_hash(state_table(state), 0, used, NULL);
    for (uint32_t row = 0; state->written && row < used; row++)
        state->written[row / 64] |= (uint64_t)1 << row % 64;
    state->head->checksum = checksum_with(state, rows_hash(state->hashes, used), fixed_count);
}

bool state_whole(const struct state *state, uint32_t fixed_count)
{
    uint32_t used = state->head->used;
    uint64_t rows = rows_hash_again(&state->entities, used);
    return rows == rows_hash(state->hashes, used) &&
           checksum_with(state, rows, fixed_count) == state->head->checksum;
}

uint64_t moved_checksum_of(const struct moved *moved, uint64_t rows)
{
    struct state_head head = *moved->head;
    head.checksum = 0;
    head.mover_ns = 0; /* written after it */
    const uint64_t rest[] = {
        rows, XXH3_64bits(moved->intents, head.intent_count * sizeof *moved->intents)};
    return XXH3_64bits_withSeed(&head, state_head_bytes(&head), XXH3_64bits(rest, sizeof rest));
}

uint64_t moved_checksum(const struct moved *moved)
{
    return moved_checksum_of(moved, rows_hash_again(&moved->entities, moved->head->used));
}

bool moved_whole(const struct moved *moved)
{
    uint32_t used = moved->head->used;
    uint64_t rows = rows_hash_again(&moved->entities, used);
    return rows == rows_hash(moved->hashes, used) &&
           moved_checksum_of(moved, rows) == moved->head->checksum;
}
