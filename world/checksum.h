/* Checksums of what one process leaves in shared memory for another: a world buffer, and the moved
 * table. A process checks them when it takes over, not in every frame.
 *
 * Rows are hashed by block and column. The hashes are kept beside the rows, and the head's checksum
 * covers them. So the writer of a table hashes again only what it changed, and copies from another
 * table only what differs (table_take). Blocks have a fixed size, so that the result does not
 * depend on the number of threads. Lists that only grow are hashed entry by entry. Pure; any
 * thread. */
#ifndef JOLON_WORLD_CHECKSUM_H
#define JOLON_WORLD_CHECKSUM_H

#include "world/column_hash.h"
#include "world/entity/entity.h"
#include "world/entity/table_write.h"
#include "world/runtime/thread_pool.h"
#include "world/state.h"

/* Rows of a block that are taken one by one; more cost as much as the whole block. */
#define ROW_LIST_MAX 128u

/* column_hash() of each column of one block. */
struct block_hashes {
    uint64_t column[ENTITY_COLUMN_COUNT];
};

/* Returns the number of blocks of this many rows; the last one may be short. */
uint32_t block_count(uint32_t rows);

/* Bytes of a table's hashes, up to the next boundary of COLUMN_ALIGN. */
size_t block_hashes_bytes(uint32_t capacity);

/* A few rows of a block, in order. */
struct row_list {
    uint32_t count;
    uint32_t row[ROW_LIST_MAX];
};

/* Lists the rows below `used` that these bits of a block name. Returns false if they are too many
 * for a list: then it pays to go through all rows of the block. */
bool row_list_gather(struct row_list *list, uint32_t block, uint32_t used,
                     const uint64_t bits[ROW_BLOCK_WORDS]);

/* --- a table: rows and the hashes beside them --------------------------------------------------*/

struct table {
    const struct entities *entities;
    struct block_hashes *hashes;
};

static inline struct table state_table(const struct state *state)
{
    return (struct table){&state->entities, state->hashes};
}

static inline struct table moved_table(const struct moved *moved)
{
    return (struct table){&moved->entities, moved->hashes};
}

/* Hashes these columns of one block of the first used rows. */
void table_hash_block(struct table table, uint32_t block, uint32_t used, uint64_t columns);

/* The same by what differs from another table, which has hashes: these rows, and no others. Rows
 * beyond those in use are zero in both. */
void table_hash_rows(struct table table, struct table before, uint32_t block, uint64_t columns,
                     const struct row_list *rows);

/* The columns in which each block of a table was written, and a bit for each row that was. */
struct written {
    const uint64_t *columns;
    const uint64_t *rows; /* of whole blocks */
};

/* Hashes the columns of each block that were written. The first `known` blocks were those of
 * `before`; the others are hashed whole. workers NULL: on this thread. */
void table_hash_written(struct table table, struct table before, uint32_t used, uint32_t known,
                        const struct written *written, struct thread_pool *workers);

/* Hashes all columns of each block. */
void table_hash(struct table table, uint32_t used, struct thread_pool *workers);

/* The columns of a block that are all zero, by their hashes. Another column has that hash with a
 * probability of 2^-64. */
uint64_t table_blank(struct table table, uint32_t block);

/* The columns of this set that are zero in each of these rows. */
uint64_t table_zero(struct table table, uint64_t columns, const uint32_t *rows, uint32_t count);

/* Makes a block of `to` the same as that of `from`, rows and hashes. known: this process
 * wrote to's hashes, so they are those of its rows. Then only columns whose hashes differ are
 * copied. Two different columns have the same hash with a probability of 2^-64. */
void table_take(struct table to, struct table from, uint32_t block, uint32_t used, bool known);

/* The same as table_take with known, if the two blocks differ at most in these rows. */
void table_take_rows(struct table to, struct table from, uint32_t block,
                     const struct row_list *rows);

/* Sets the bits of the rows of a block in which the two tables differ, in those of these columns
 * whose hashes differ. rows: CHECKSUM_ROWS bits, to which these are added. used: rows of both.
 * Stops after the column with which more than `most` bits are set, and returns false. */
bool table_differing(struct table a, struct table b, uint32_t block, uint32_t used,
                     uint64_t columns, uint32_t most, uint64_t *rows);

/* The same without a limit, if the two blocks differ at most in these rows. */
void table_differing_rows(struct table a, struct table b, uint32_t block, uint64_t columns,
                          const struct row_list *rows, uint64_t *bits);

/* Returns the columns in which row i of the two differs, bit by bit. */
uint64_t entities_differing(const struct entities *a, const struct entities *b, uint32_t i);

/* --- checksums ---------------------------------------------------------------------------------*/

/* Running hashes of the lists that only grow; all zero before the first entry. */
struct list_hashes {
    uint32_t craters, dents; /* entries included */
    uint64_t crater_hash, dent_hash;
};

/* Adds the new entries of the state's lists, up to its counts. Begins again when a list is shorter
 * than before. */
void list_hashes_extend(struct list_hashes *hashes, const struct state *state);

/* Hash of a table's block_hashes: of the stored ones, or computed again from the rows. */
uint64_t rows_hash(const struct block_hashes *hashes, uint32_t used);
uint64_t rows_hash_again(const struct entities *entities, uint32_t used);

/* The state's own checksum: head (its checksum as 0), rows, damage of the fixed objects, contacts,
 * craters and dents up to their counts, which must be within their lists. The rows are hashed
 * again. */
uint64_t state_checksum(const struct state *state, uint32_t fixed_count);

/* The same from parts that the caller has already: the hash of the rows, the fixed damage as
 * state_fixed_hash() has it, and the lists up to the state's counts. The contacts change from frame
 * to frame, so their whole list is hashed. */
uint64_t state_fixed_hash(const struct state *state, uint32_t fixed_count);
uint64_t state_checksum_of(const struct state *state, uint64_t rows, uint64_t fixed_hash,
                           const struct list_hashes *lists);

/* Writes the hashes and the checksum of a state that the collider did not make. */
void state_seal(struct state *state, uint32_t fixed_count);

/* Returns true if the checksum and the hashes beside the rows fit the content. */
bool state_whole(const struct state *state, uint32_t fixed_count);

/* The moved table's checksum as the mover stores it: head (its checksum and mover_ns as 0), rows,
 * intents up to their count, which must be within their list. */
uint64_t moved_checksum(const struct moved *moved);
uint64_t moved_checksum_of(const struct moved *moved, uint64_t rows);
bool moved_whole(const struct moved *moved);

#endif
