/* Which rows rest, and the index of their records. */
#include "collider/broad_phase/resting_records.h"

#include "collider/motion/ground_impact.h"
#include "world/entity/entity.h"
#include "world/entity/row_words.h"

#include <stdlib.h>
#include <string.h>

#define LOOK_FRAMES 64u /* from one look at the rows to the next */

/* When more rows of a block than one in so many move, the records of all are made. */
#define MOVING_SHARE 4u

#define POSE_FIELDS                                                                                \
    (FIELD_BIT(x) | FIELD_BIT(y) | FIELD_BIT(z) | FIELD_BIT(heading) | FIELD_BIT(pitch) |          \
     FIELD_BIT(roll) | FIELD_BIT(turret) | FIELD_BIT(gun) | FIELD_BIT(id) | FIELD_BIT(kind) |      \
     FIELD_BIT(state) | FIELD_BIT(behaviour) | FIELD_BIT(flags) | FIELD_BIT(cruise_tick) |         \
     FIELD_BIT(cruise_rps) | FIELD_BIT(cruise_mps2) | FIELD_BIT(cruise_climb_mps2) |               \
     FIELD_BIT(cruise_pitch_rps) | FIELD_BIT(cruise_roll_rps))

bool resting_records_pose_differs(const struct entity *a, const struct entity *b)
{
    uint64_t fields = 0;
    if (memcmp((const unsigned char *)&a->x, (const unsigned char *)&b->x, sizeof a->x) != 0)
        return true; /* as of most that move */
#define X(type, name)                                                                              \
    fields |= (POSE_FIELDS & FIELD_BIT(name)) *                                                    \
              (uint64_t)(memcmp((const unsigned char *)&a->name, (const unsigned char *)&b->name,  \
                                sizeof(type)) != 0);
    ENTITY_FIELDS(X)
#undef X
    return fields != 0;
}

int resting_records_init(struct resting_records *resting, uint32_t rows)
{
    uint32_t blocks = (rows + RESTING_RECORDS_ROWS - 1) / RESTING_RECORDS_ROWS;
    uint32_t words = blocks * RESTING_RECORDS_WORDS;
    *resting = (struct resting_records){.words = words};
    resting->kept = calloc(words, sizeof *resting->kept);
    resting->moved = calloc(words, sizeof *resting->moved);
    resting->written = calloc(words, sizeof *resting->written);
    resting->flies = calloc(words, sizeof *resting->flies);
    resting->awake = calloc(words, sizeof *resting->awake);
    return resting->kept && resting->moved && resting->written && resting->flies &&
                   resting->awake && sweep_worker_init(&resting->sweeper, rows, 1) == 0 &&
                   query_index_init(&resting->index, rows) == 0
               ? 0
               : -1;
}

void resting_records_free(struct resting_records *resting)
{
    sweep_worker_free(&resting->sweeper);
    query_index_free(&resting->index);
    free(resting->kept);
    free(resting->moved);
    free(resting->written);
    free(resting->flies);
    free(resting->awake);
    *resting = (struct resting_records){0};
}

void resting_records_forget(struct resting_records *resting)
{
    memset(resting->kept, 0, resting->words * sizeof *resting->kept);
}

void resting_records_begin(struct resting_records *resting, const struct method_input *input)
{
    uint32_t craters = input->craters ? input->craters->count : 0;
    for (uint32_t w = input->rows / 64; w * 64 < resting->rows; w++)
        resting->kept[w] &= row_words_below(w, input->rows);
    for (uint32_t w = 0; craters != resting->craters && w < resting->words; w++)
        resting->kept[w] &= ~resting->flies[w];
    resting->craters = craters;
    resting->rows = input->rows;
}

uint32_t resting_records_note(struct resting_records *resting, uint32_t block,
                              const struct moving_rows *moving, const uint64_t *held,
                              uint64_t bin[RESTING_RECORDS_WORDS])
{
    uint32_t count = 0;
    for (uint32_t w = 0; w < RESTING_RECORDS_WORDS; w++) {
        uint32_t word = block * RESTING_RECORDS_WORDS + w;
        uint64_t moves = moving->all ? UINT64_MAX : moving->row[w] | resting->written[word];
        resting->written[word] = 0;
        resting->awake[word] = moves;
        resting->kept[word] &= ~moves;
        resting->moved[word] |= moves | held[word];
        bin[w] =
            row_words_below(word, resting->rows) & ~resting->kept[word] & (moves | ~held[word]);
        if (bin[w] != 0) /* a call where the processor may not count bits */
            count += (uint32_t)__builtin_popcountll(bin[w]);
    }
    return count;
}

/* --- the index ---------------------------------------------------------------------------------*/

/* Returns true if so few rows of the block move that the others are worth keeping. */
static bool few_move(const struct resting_records *resting, uint32_t block)
{
    uint32_t count = 0;
    for (uint32_t w = 0; w < RESTING_RECORDS_WORDS; w++) {
        uint32_t word = block * RESTING_RECORDS_WORDS + w;
        count += (uint32_t)__builtin_popcountll(resting->moved[word] &
                                                row_words_below(word, resting->rows));
    }
    return count <= RESTING_RECORDS_ROWS / MOVING_SHARE;
}

static uint32_t blocks_of(uint32_t rows)
{
    return (rows + RESTING_RECORDS_ROWS - 1) / RESTING_RECORDS_ROWS;
}

/* Counts the rows that are kept and those that could be, and begins to note which move. Marks as
 * moved what is not to be kept. */
static void look(struct resting_records *resting, uint64_t *held, uint64_t *fresh)
{
    *held = *fresh = 0;
    for (uint32_t block = 0; block < blocks_of(resting->rows); block++) {
        bool few = few_move(resting, block);
        for (uint32_t w = 0; w < RESTING_RECORDS_WORDS; w++) {
            uint32_t word = block * RESTING_RECORDS_WORDS + w;
            uint64_t there = row_words_below(word, resting->rows);
            if (!few)
                resting->moved[word] |= ~resting->kept[word];
            *held += (uint64_t)__builtin_popcountll(resting->kept[word]);
            *fresh += (uint64_t)__builtin_popcountll(there & ~resting->kept[word] &
                                                     ~resting->moved[word]);
        }
    }
}

/* Notes which of these rows are aircraft, and returns those that may be kept: a round may end its
 * life without moving. */
static uint64_t sort_out(struct resting_records *resting, const struct body_boxes *rows,
                         uint32_t word, uint64_t bits)
{
    const struct entities *e = rows->input->entities;
    uint64_t flies = 0, rounds = 0;
    for (uint64_t left = bits; left != 0; left &= left - 1) {
        uint32_t i = word * 64 + (uint32_t)__builtin_ctzll(left);
        uint64_t bit = left & -left;
        if (e->row[i].state == ENTITY_FREE)
            continue;
        rounds |= e->row[i].behaviour == BEHAVIOUR_FLIGHT ? bit : 0;
        flies |= rows->flags[e->row[i].kind] & BIN_AIR ? bit : 0;
    }
    resting->flies[word] = flies;
    return bits & ~rounds;
}

/* Lets the rows go that touch the ground: they are tested in each frame. */
static void let_grounded_go(struct resting_records *resting, const struct body_boxes *rows)
{
    const struct pair_list *fliers = &resting->sweeper.fliers;
    for (uint32_t n = 0; n < fliers->count; n++) {
        uint32_t row = fliers->pair[n].a;
        double toi;
        if (!rows->motion || ground_impact_row(rows->input, rows->motion, row, &toi))
            resting->kept[row / 64] &= ~((uint64_t)1 << row % 64);
    }
}

static void build(struct resting_records *resting, const struct body_boxes *rows)
{
    struct sweep_worker *sweeper = &resting->sweeper;
    const struct strip_bins *bins = &sweeper->bins;
    strip_bins_clear(&sweeper->bins);
    sweeper->fliers.count = 0;
    for (uint32_t word = 0; word * 64 < resting->rows; word++) {
        uint64_t bits =
            row_words_below(word, resting->rows) & (resting->kept[word] | ~resting->moved[word]);
        resting->kept[word] = sort_out(resting, rows, word, bits);
        if (resting->kept[word] != 0)
            body_boxes_bin_some(rows, sweeper, word * 64, resting->kept[word]);
    }
    let_grounded_go(resting, rows);
    query_index_build(&resting->index, &bins, 1);
    if (!resting->index.built)
        resting_records_forget(resting);
}

/* A row that rests and is not kept costs a record in each frame. Building the index costs one for
 * each row in it. So it is built when the first has come to as much. */
void resting_records_end(struct resting_records *resting, const struct body_boxes *rows)
{
    uint64_t held, fresh;
    if (resting->never || ++resting->frames < LOOK_FRAMES)
        return;
    resting->frames = 0;
    look(resting, &held, &fresh);
    resting->waste += fresh * LOOK_FRAMES;
    if (fresh > 0 && resting->waste >= held + fresh) {
        build(resting, rows);
        resting->waste = 0;
    }
    memset(resting->moved, 0, resting->words * sizeof *resting->moved);
}
