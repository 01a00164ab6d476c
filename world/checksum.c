/* Checksums by pieces of rows and by entries of lists. */
#include "world/checksum.h"

#include "world/hash.h"

#include <stddef.h>

static uint32_t pieces_of(uint32_t used)
{
    return (used + CHECKSUM_ROWS - 1) / CHECKSUM_ROWS;
}

/* Column by column; a column's hash is chained into the whole. */
void row_hashes_piece(struct row_hashes *hashes, const struct entities *e, uint32_t piece,
                      uint32_t used)
{
    uint32_t first = piece * CHECKSUM_ROWS;
    uint32_t count = used - first < CHECKSUM_ROWS ? used - first : CHECKSUM_ROWS;
    uint64_t hash = 0;
#define X(type, name) hash = XXH3_64bits_withSeed(e->name + first, count * sizeof(type), hash);
    ENTITY_COLUMNS(X)
#undef X
    hashes->piece[piece] = hash;
}

struct all_rows {
    struct row_hashes *hashes;
    const struct entities *entities;
    uint32_t used;
};

static void hash_pieces(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct all_rows *all = context;
    (void)worker;
    for (uint32_t piece = first; piece < end; piece++)
        row_hashes_piece(all->hashes, all->entities, piece, all->used);
}

void row_hashes_all(struct row_hashes *hashes, const struct entities *entities, uint32_t used,
                    struct workers *workers)
{
    struct all_rows all = {hashes, entities, used};
    workers_run(workers, hash_pieces, &all, pieces_of(used), 1);
}

static uint64_t rows_hash(const struct row_hashes *rows, uint32_t used, uint64_t seed)
{
    return XXH3_64bits_withSeed(rows->piece, pieces_of(used) * sizeof rows->piece[0], seed);
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

uint64_t state_checksum_of(const struct state *state, const struct row_hashes *rows,
                           uint64_t fixed_hash, const struct list_hashes *lists)
{
    const uint64_t rest[] = {fixed_hash, lists->crater_hash, lists->dent_hash};
    struct state_head head = *state->head;
    head.checksum = 0;
    return XXH3_64bits_withSeed(&head, sizeof head,
                                rows_hash(rows, head.used, XXH3_64bits(rest, sizeof rest)));
}

uint64_t state_checksum(const struct state *state, uint32_t fixed_count)
{
    struct row_hashes rows;
    struct list_hashes lists = {0};
    row_hashes_all(&rows, &state->entities, state->head->used, NULL);
    list_hashes_extend(&lists, state);
    return state_checksum_of(state, &rows, state_fixed_hash(state, fixed_count), &lists);
}

uint64_t moved_checksum_of(const struct moved *moved, const struct row_hashes *rows)
{
    struct state_head head = *moved->head;
    head.checksum = 0;
    head.mover_ns = 0; /* written after it */
    uint64_t hash = XXH3_64bits(moved->intents, head.intent_count * sizeof *moved->intents);
    return XXH3_64bits_withSeed(&head, sizeof head, rows_hash(rows, head.used, hash));
}

uint64_t moved_checksum(const struct moved *moved)
{
    struct row_hashes rows;
    row_hashes_all(&rows, &moved->entities, moved->head->used, NULL);
    return moved_checksum_of(moved, &rows);
}
