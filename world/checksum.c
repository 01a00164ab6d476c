/* Checksums by blocks and columns of rows and by entries of lists. */
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
    size_t bytes = block_count(capacity) * sizeof(struct block_hashes);
    return (bytes + COLUMN_ALIGN - 1) / COLUMN_ALIGN * COLUMN_ALIGN;
}

static uint32_t block_rows(uint32_t block, uint32_t used)
{
    uint32_t first = block * CHECKSUM_ROWS;
    return used - first < CHECKSUM_ROWS ? used - first : CHECKSUM_ROWS;
}

static const uint8_t cell_bytes[ENTITY_COLUMN_COUNT] = {
#define X(type, name) sizeof(type),
    ENTITY_COLUMNS(X)
#undef X
};

/* The first cell of a block in each column. */
struct cells {
    void *column[ENTITY_COLUMN_COUNT];
};

static struct cells cells_of(const struct entities *e, uint32_t block)
{
    uint32_t first = block * CHECKSUM_ROWS;
    return (struct cells){{
#define X(type, name) e->name + first,
        ENTITY_COLUMNS(X)
#undef X
    }};
}

bool row_list_gather(struct row_list *list, uint32_t block, uint32_t used,
                     const uint64_t bits[ROW_BLOCK_WORDS])
{
    const uint32_t first = block * CHECKSUM_ROWS;
    list->count = 0;
    for (uint32_t w = 0; w < ROW_BLOCK_WORDS; w++) {
        for (uint64_t left = bits[w]; left != 0; left &= left - 1) {
            uint32_t row = first + w * 64 + (uint32_t)__builtin_ctzll(left);
            if (row >= used)
                return true;
            if (list->count == ROW_LIST_MAX)
                return false;
            list->row[list->count++] = row;
        }
    }
    return true;
}

static void hash_columns(const struct entities *e, uint32_t block, uint32_t used, uint64_t columns,
                         struct block_hashes *hashes)
{
    const struct cells cells = cells_of(e, block);
    uint32_t rows = block_rows(block, used);
    for (uint32_t c = 0; c < ENTITY_COLUMN_COUNT; c++) {
        if (columns >> c & 1)
            hashes->column[c] = column_hash(cells.column[c], (size_t)rows * cell_bytes[c]);
    }
}

void table_hash_block(struct table table, uint32_t block, uint32_t used, uint64_t columns)
{
    hash_columns(table.entities, block, used, columns, &table.hashes[block]);
}

/* Returns by how much the hash of a column of a block changes with these rows. */
static uint64_t change_of(const uint64_t *column, const uint64_t *before, uint32_t first,
                          uint8_t bytes, const struct row_list *rows)
{
    const uint32_t rows_a_word = sizeof *column / bytes;
    uint64_t change = 0;
    uint32_t last = UINT32_MAX;
    for (uint32_t n = 0; n < rows->count; n++) {
        uint32_t place = (rows->row[n] - first) / rows_a_word;
        if (place == last || column[place] == before[place])
            continue;
        const uint64_t key = column_hash_key(place);
        change += column_hash_word(column[place], key) - column_hash_word(before[place], key);
        last = place;
    }
    return change;
}

void table_hash_rows(struct table table, struct table before, uint32_t block, uint64_t columns,
                     const struct row_list *rows)
{
    const struct cells cells = cells_of(table.entities, block);
    const struct cells old = cells_of(before.entities, block);
    for (uint64_t left = columns; left != 0; left &= left - 1) {
        int c = __builtin_ctzll(left);
        table.hashes[block].column[c] =
            before.hashes[block].column[c] +
            change_of(cells.column[c], old.column[c], block * CHECKSUM_ROWS, cell_bytes[c], rows);
    }
}

struct hashing {
    struct table table, before;
    uint32_t used, known;
    const struct written *written; /* NULL: all columns, of all rows */
};

static void hash_blocks(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct hashing *job = context;
    struct row_list rows;
    (void)worker;
    for (uint32_t block = first; block < end; block++) {
        const struct written *written = job->written;
        uint64_t columns = written ? written->columns[block] : COLUMNS_ALL;
        if (columns == 0)
            continue;
        if (written && block < job->known &&
            row_list_gather(&rows, block, job->used, &written->rows[block * ROW_BLOCK_WORDS]))
            table_hash_rows(job->table, job->before, block, columns, &rows);
        else
            table_hash_block(job->table, block, job->used, columns);
    }
}

void table_hash(struct table table, uint32_t used, struct thread_pool *workers)
{
    struct hashing job = {.table = table, .used = used};
    thread_pool_run(workers, hash_blocks, &job, block_count(used), BLOCKS_A_WORKER);
}

void table_hash_written(struct table table, struct table before, uint32_t used, uint32_t known,
                        const struct written *written, struct thread_pool *workers)
{
    struct hashing job = {table, before, used, known, written};
    thread_pool_run(workers, hash_blocks, &job, block_count(used), BLOCKS_A_WORKER);
}

uint64_t table_blank(struct table table, uint32_t block)
{
    uint64_t columns = 0;
    for (uint32_t c = 0; c < ENTITY_COLUMN_COUNT; c++)
        columns |= (uint64_t)(table.hashes[block].column[c] == COLUMN_HASH_BLANK) << c;
    return columns;
}

/* Returns the bits that are set in any of the rows of one column. */
static uint64_t gather(const void *column, uint8_t bytes, const uint32_t *rows, uint32_t count)
{
    uint64_t all = 0;
    for (uint32_t n = 0; n < count; n++) {
        if (bytes == 8)
            all |= ((const uint64_t *)column)[rows[n]];
        else if (bytes == 4)
            all |= ((const uint32_t *)column)[rows[n]];
        else if (bytes == 2)
            all |= ((const uint16_t *)column)[rows[n]];
        else
            all |= ((const uint8_t *)column)[rows[n]];
    }
    return all;
}

uint64_t table_zero(struct table table, uint64_t columns, const uint32_t *rows, uint32_t count)
{
    const struct cells cells = cells_of(table.entities, 0);
    for (uint64_t left = columns; left != 0; left &= left - 1) {
        int c = __builtin_ctzll(left);
        if (gather(cells.column[c], cell_bytes[c], rows, count) != 0)
            columns &= ~((uint64_t)1 << c);
    }
    return columns;
}

void table_take(struct table to, struct table from, uint32_t block, uint32_t used, bool known)
{
    struct block_hashes *has = &to.hashes[block];
    const struct block_hashes *wants = &from.hashes[block];
    if (known && memcmp(has, wants, sizeof *has) == 0)
        return;
    const struct cells into = cells_of(to.entities, block);
    const struct cells source = cells_of(from.entities, block);
    uint32_t rows = block_rows(block, used);
    for (uint32_t c = 0; c < ENTITY_COLUMN_COUNT; c++) {
        if (!known || has->column[c] != wants->column[c])
            memcpy(into.column[c], source.column[c], (size_t)rows * cell_bytes[c]);
    }
    *has = *wants;
}

#define TAKE_CELLS(type)                                                                           \
    for (uint32_t n = 0; n < rows->count; n++)                                                     \
    ((type *)to)[rows->row[n]] = ((const type *)from)[rows->row[n]]

/* Copies the cells of these rows of one column. */
static void take_cells(void *to, const void *from, uint8_t bytes, const struct row_list *rows)
{
    if (bytes == 8)
        TAKE_CELLS(uint64_t);
    else if (bytes == 4)
        TAKE_CELLS(uint32_t);
    else if (bytes == 2)
        TAKE_CELLS(uint16_t);
    else
        TAKE_CELLS(uint8_t);
}

void table_take_rows(struct table to, struct table from, uint32_t block,
                     const struct row_list *rows)
{
    struct block_hashes *has = &to.hashes[block];
    const struct block_hashes *wants = &from.hashes[block];
    const struct cells into = cells_of(to.entities, 0), source = cells_of(from.entities, 0);
    for (uint32_t c = 0; c < ENTITY_COLUMN_COUNT; c++) {
        if (has->column[c] != wants->column[c])
            take_cells(into.column[c], source.column[c], cell_bytes[c], rows);
    }
    *has = *wants;
}

/* Returns a bit for each of up to 64 cells that differ, of one size. */
#define CELLS_DIFFER(type)                                                                         \
    for (uint32_t i = 0; i < count; i++)                                                           \
    differ |= (uint64_t)(((const type *)p)[i] != ((const type *)q)[i]) << i

static uint64_t cells_differing(const void *p, const void *q, size_t bytes, uint32_t count)
{
    uint64_t differ = 0;
    if (memcmp(p, q, count * bytes) == 0)
        return 0;
    if (bytes == 8)
        CELLS_DIFFER(uint64_t);
    else if (bytes == 4)
        CELLS_DIFFER(uint32_t);
    else if (bytes == 2)
        CELLS_DIFFER(uint16_t);
    else
        CELLS_DIFFER(uint8_t);
    return differ;
}

bool table_differing(struct table a, struct table b, uint32_t block, uint32_t used,
                     uint64_t columns, uint32_t most, uint64_t *rows)
{
    const struct cells one = cells_of(a.entities, block), other = cells_of(b.entities, block);
    uint32_t count = block_rows(block, used);
    for (; columns != 0; columns &= columns - 1) {
        int c = __builtin_ctzll(columns);
        const uint8_t *p = one.column[c], *q = other.column[c];
        size_t bytes = cell_bytes[c];
        uint32_t set = 0;
        if (a.hashes[block].column[c] == b.hashes[block].column[c])
            continue;
        for (uint32_t i = 0; i < count; i += 64) {
            rows[i / 64] |= cells_differing(p + i * bytes, q + i * bytes, bytes,
                                            count - i < 64 ? count - i : 64);
            set += (uint32_t)__builtin_popcountll(rows[i / 64]);
        }
        if (set > most)
            return false;
    }
    return true;
}

#define NOTE_CELLS(type)                                                                           \
    for (uint32_t n = 0; n < rows->count; n++) {                                                   \
        uint32_t i = rows->row[n], k = i % CHECKSUM_ROWS;                                          \
        bits[k / 64] |= (uint64_t)(((const type *)a)[i] != ((const type *)b)[i]) << k % 64;        \
    }

/* Sets the bits of those of these rows of one column that differ. */
static void note_cells(const void *a, const void *b, uint8_t bytes, const struct row_list *rows,
                       uint64_t *bits)
{
    if (bytes == 8)
        NOTE_CELLS(uint64_t)
    else if (bytes == 4)
        NOTE_CELLS(uint32_t)
    else if (bytes == 2)
        NOTE_CELLS(uint16_t)
    else
        NOTE_CELLS(uint8_t)
}

void table_differing_rows(struct table a, struct table b, uint32_t block, uint64_t columns,
                          const struct row_list *rows, uint64_t *bits)
{
    const struct cells one = cells_of(a.entities, 0), other = cells_of(b.entities, 0);
    for (; columns != 0; columns &= columns - 1) {
        int c = __builtin_ctzll(columns);
        if (a.hashes[block].column[c] != b.hashes[block].column[c])
            note_cells(one.column[c], other.column[c], cell_bytes[c], rows, bits);
    }
}

/* Bits, not values: two zeros of different signs differ. */
#define DIFFERS(type, name)                                                                        \
    columns |= (uint64_t)(memcmp((const unsigned char *)&a->name[i],                               \
                                 (const unsigned char *)&b->name[i], sizeof(type)) != 0)           \
               << COLUMN_##name;

uint64_t entities_differing(const struct entities *a, const struct entities *b, uint32_t i)
{
    uint64_t columns = 0;
    ENTITY_COLUMNS(DIFFERS)
    return columns;
}

/* --- checksums ---------------------------------------------------------------------------------*/

/* Each block's hashes are chained into the whole. */
static uint64_t add_block(uint64_t hash, const struct block_hashes *hashes)
{
    return XXH3_64bits_withSeed(hashes, sizeof *hashes, hash);
}

uint64_t rows_hash(const struct block_hashes *hashes, uint32_t used)
{
    uint64_t hash = 0;
    for (uint32_t block = 0; block < block_count(used); block++)
        hash = add_block(hash, &hashes[block]);
    return hash;
}

uint64_t rows_hash_again(const struct entities *entities, uint32_t used)
{
    uint64_t hash = 0;
    for (uint32_t block = 0; block < block_count(used); block++) {
        struct block_hashes hashes;
        hash_columns(entities, block, used, COLUMNS_ALL, &hashes);
        hash = add_block(hash, &hashes);
    }
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
    table_hash(state_table(state), used, NULL);
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
