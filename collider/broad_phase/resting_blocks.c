/* Which blocks rest, and the index of their records. */
#include "collider/broad_phase/resting_blocks.h"

#include <string.h>

/* A block that has rested for so many frames is expected to rest on. */
#define RESTED_LEAST 16u

/* Frames from one building of the index to the next: it costs as much as some frames in which all
 * of its rows are in the strips. */
#define BUILT_LEAST 64u

int resting_blocks_init(struct resting_blocks *resting, uint32_t rows)
{
    memset(resting, 0, sizeof *resting);
    resting->frames = BUILT_LEAST;
    return sweep_worker_init(&resting->sweeper, rows, 1) == 0 &&
                   query_index_init(&resting->index, rows) == 0
               ? 0
               : -1;
}

void resting_blocks_free(struct resting_blocks *resting)
{
    sweep_worker_free(&resting->sweeper);
    query_index_free(&resting->index);
    memset(resting, 0, sizeof *resting);
}

static uint32_t blocks_of(uint32_t rows)
{
    return (rows + RESTING_BLOCKS_ROWS - 1) / RESTING_BLOCKS_ROWS;
}

void resting_blocks_forget(struct resting_blocks *resting)
{
    memset(resting->rested, 0, sizeof resting->rested);
    memset(resting->kept, 0, sizeof resting->kept);
}

void resting_blocks_begin(struct resting_blocks *resting, const struct method_input *input)
{
    uint32_t blocks = blocks_of(input->rows);
    double rim_m = input->craters ? input->craters->rim_m : 0.0;
    for (uint32_t block = blocks; block < resting->blocks; block++)
        resting->rested[block] = resting->kept[block] = 0;
    /* Whether a row is a flier depends on the highest rim of a crater. */
    for (uint32_t block = 0; rim_m != resting->rim_m && block < blocks; block++)
        resting->kept[block] &= resting->flies[block] == 0;
    resting->rim_m = rim_m;
    resting->blocks = blocks;
}

bool resting_blocks_note(struct resting_blocks *resting, uint32_t block,
                         const struct resting_block *now)
{
    uint8_t *rested = &resting->rested[block];
    if (!now->rests || *rested == 0 || resting->key[block] != now->key) {
        *rested = now->rests;
        resting->kept[block] = 0;
    } else if (*rested < RESTED_LEAST) {
        ++*rested;
    }
    resting->key[block] = now->key;
    return resting->kept[block] != 0;
}

void resting_blocks_add_fliers(const struct resting_blocks *resting, struct body_motion *motion,
                               struct pair_list *fliers)
{
    const struct pair_list *kept = &resting->sweeper.fliers;
    for (uint32_t i = 0; i < kept->count; i++) {
        uint32_t row = kept->pair[i].a;
        if (!resting->kept[row / RESTING_BLOCKS_ROWS])
            continue;
        body_motion_require(motion, row);
        pair_list_add(fliers, row, 0);
    }
}

/* Returns true if more blocks would be kept than now. */
static bool has_new(const struct resting_blocks *resting)
{
    for (uint32_t block = 0; block < resting->blocks; block++) {
        if (resting->rested[block] >= RESTED_LEAST && !resting->kept[block])
            return true;
    }
    return false;
}

static void build(struct resting_blocks *resting, const struct body_boxes *rows)
{
    struct sweep_worker *sweeper = &resting->sweeper;
    const struct strip_bins *bins = &sweeper->bins;
    strip_bins_clear(&sweeper->bins);
    sweeper->fliers.count = 0;
    for (uint32_t block = 0; block < resting->blocks; block++) {
        uint32_t first = block * RESTING_BLOCKS_ROWS, before = sweeper->fliers.count;
        uint32_t left = rows->input->rows - first;
        resting->kept[block] = resting->rested[block] >= RESTED_LEAST;
        if (!resting->kept[block])
            continue;
        body_boxes_bin(rows, sweeper, first,
                       first + (left < RESTING_BLOCKS_ROWS ? left : RESTING_BLOCKS_ROWS));
        resting->flies[block] = sweeper->fliers.count > before;
    }
    query_index_build(&resting->index, &bins, 1);
    if (!resting->index.built)
        resting_blocks_forget(resting);
}

void resting_blocks_end(struct resting_blocks *resting, const struct body_boxes *rows)
{
    resting->frames += resting->frames < BUILT_LEAST;
    if (resting->never || resting->frames < BUILT_LEAST || !has_new(resting))
        return;
    build(resting, rows);
    resting->frames = 0;
}
