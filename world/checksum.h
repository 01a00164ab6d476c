/* Checksums of what one process leaves in shared memory for another: a world buffer, and the moved
 * table. A process checks them when it takes over, not in every frame.
 *
 * Rows are hashed by blocks. The hashes are kept beside the rows, and the head's checksum covers
 * them. They are sums, so the writer of a table adds what the rows that it wrote change
 * (docs/decisions/052-written-rows.md). Blocks have a fixed size, so that the result does not
 * depend on the number of threads. Lists that only grow are hashed entry by entry. Pure; any
 * thread. */
#ifndef JOLON_WORLD_CHECKSUM_H
#define JOLON_WORLD_CHECKSUM_H

#include "world/entity/entity.h"
#include "world/entity/table_write.h"
#include "world/runtime/thread_pool.h"
#include "world/state.h"
#include "world/word_hash.h"

/* Returns the number of blocks of this many rows; the last one may be short. */
uint32_t block_count(uint32_t rows);

/* Bytes of a table's hashes, one for each block, up to the next boundary of TABLE_ALIGN. */
size_t block_hashes_bytes(uint32_t capacity);

/* Bytes of a bit for each row, in whole blocks. */
size_t written_bytes(uint32_t capacity);

/* --- a table: rows and the hashes beside them --------------------------------------------------*/

struct table {
    const struct entities *entities;
    uint64_t *hashes; /* of each block: word_hash() of its rows in use */
};

static inline struct table state_table(const struct state *state)
{
    return (struct table){&state->entities, state->hashes};
}

static inline struct table moved_table(const struct moved *moved)
{
    return (struct table){&moved->entities, moved->hashes};
}

/* Returns by how much the hash of a block changes if a row of it was that before and is this now.
 */
uint64_t entity_hash_change(const struct entities *now, const struct entities *before,
                            uint32_t row);

/* Hashes the blocks of the first used rows, from a block on. workers NULL: on this thread. */
void table_hash(struct table table, uint32_t first, uint32_t used, struct thread_pool *workers);

/* Adds to the hashes what the rows change that are written, if they are those of `before`, from
 * which the table differs at most in these rows. Rows beyond those in use are zero in both.
 * written: a bit for each row, in whole blocks. */
void table_hash_written(struct table table, const struct entities *before, uint32_t used,
                        const uint64_t *written);

/* Makes a block of `to` the same as that of `from`, rows and hash. known: this process wrote
 * to's hash, so it is that of its rows. Then a block whose hash is the same is not copied: two
 * different blocks have the same hash with a probability of 2^-64. */
void table_take(struct table to, struct table from, uint32_t block, uint32_t used, bool known);

/* The same if the two blocks differ at most in the rows of these bits, [ROW_BLOCK_WORDS]. Bits come
 * from shared memory: those beyond the capacity are passed over. */
void table_take_rows(struct table to, struct table from, uint32_t block, const uint64_t *bits);

/* Returns the fields in which two rows differ, bit by bit. */
uint64_t entity_differing(const struct entity *a, const struct entity *b);

/* --- checksums ---------------------------------------------------------------------------------*/

/* Running hashes of the lists that only grow; all zero before the first entry. */
struct list_hashes {
    uint32_t craters, dents; /* entries included */
    uint64_t crater_hash, dent_hash;
};

/* Adds the new entries of the state's lists, up to its counts. Begins again when a list is shorter
 * than before. */
void list_hashes_extend(struct list_hashes *hashes, const struct state *state);

/* Hash of a table's hashes: of the stored ones, or computed again from the rows. */
uint64_t rows_hash(const uint64_t *hashes, uint32_t used);
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

/* Writes the hashes and the checksum of a state that the collider did not make. All its rows count
 * as written. */
void state_seal(struct state *state, uint32_t fixed_count);

/* Returns true if the checksum and the hashes beside the rows fit the content. */
bool state_whole(const struct state *state, uint32_t fixed_count);

/* The moved table's checksum as the mover stores it: head (its checksum and mover_ns as 0), rows,
 * intents up to their count, which must be within their list. */
uint64_t moved_checksum(const struct moved *moved);
uint64_t moved_checksum_of(const struct moved *moved, uint64_t rows);
bool moved_whole(const struct moved *moved);

#endif
