/* Checksums of what one process leaves in shared memory for another: a world buffer, and the moved
 * table. They are looked at by whoever takes over, not in every frame.
 *
 * Rows are hashed in pieces of fixed size, so that threads can share the work and the result does
 * not depend on how many there are; lists that only grow are hashed entry by entry, so that a frame
 * costs what it added. Pure; any thread. */
#ifndef JOLON_WORLD_CHECKSUM_H
#define JOLON_WORLD_CHECKSUM_H

#include "world/workers.h"
#include "world/world.h"

#define CHECKSUM_ROWS   2048u /* of a piece: they fit a second-level cache */
#define CHECKSUM_PIECES (CAPACITY_MAX / CHECKSUM_ROWS)

/* Hash of each piece of the first used rows; what lies behind them means nothing. */
struct row_hashes {
    uint64_t piece[CHECKSUM_PIECES];
};

/* Hashes one piece, or all of them on the workers (NULL: alone). */
void row_hashes_piece(struct row_hashes *hashes, const struct entities *entities, uint32_t piece,
                      uint32_t used);
void row_hashes_all(struct row_hashes *hashes, const struct entities *entities, uint32_t used,
                    struct workers *workers);

/* Running hashes of the lists that only grow; all zero before the first entry. */
struct list_hashes {
    uint32_t craters, dents; /* entries that are in */
    uint64_t crater_hash, dent_hash;
};

/* Takes in what the state's lists have more, up to its counts; begins anew when they have less. */
void list_hashes_extend(struct list_hashes *hashes, const struct state *state);

/* The state's own checksum as the collider stores it: head (its checksum as 0), rows, damage of the
 * fixed objects, craters and dents up to their counts, which must be within their lists. */
uint64_t state_checksum(const struct state *state, uint32_t fixed_count);

/* The same of parts, for a writer that knows what has not changed: rows of the state, fixed damage
 * as state_fixed_hash() has it, and the lists up to the state's counts. */
uint64_t state_fixed_hash(const struct state *state, uint32_t fixed_count);
uint64_t state_checksum_of(const struct state *state, const struct row_hashes *rows,
                           uint64_t fixed_hash, const struct list_hashes *lists);

/* The moved table's checksum as the mover stores it: head (its checksum and mover_ns as 0), rows,
 * intents up to their count, which must be within their list. */
uint64_t moved_checksum(const struct moved *moved);
uint64_t moved_checksum_of(const struct moved *moved, const struct row_hashes *rows);

#endif
