/* The blocks of rows that rest, from frame to frame (docs/decisions/042-resting-rows.md).
 *
 * The records of a block in which no row moves or turns are the same in each frame. When a block
 * has been so for some frames, its records go into an index of their own, in which they stay. The
 * records of a frame are swept against that index, which is not swept itself: two rows at rest are
 * no pair. The set of pairs is the same as without the index, so it is a cache of the process. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_RESTING_BLOCKS_H
#define JOLON_COLLIDER_BROAD_PHASE_RESTING_BLOCKS_H

#include "collider/broad_phase/body_boxes.h"
#include "collider/broad_phase/query_index.h"
#include "collider/broad_phase/sweep_and_prune.h"

#include <stdbool.h>
#include <stdint.h>

#define RESTING_BLOCKS_ROWS 1024u /* of a block */
#define RESTING_BLOCKS_MOST (CAPACITY_MAX / RESTING_BLOCKS_ROWS)

/* A block in this frame. */
struct resting_block {
    uint64_t key; /* a hash of all from which the boxes and the records of its rows follow */
    bool rests;   /* no row moves or turns in this frame */
};

struct resting_blocks {
    struct query_index index;    /* of the blocks that are kept, and of some that no longer are */
    struct sweep_worker sweeper; /* used while the index is built; then the fliers of its blocks */
    double rim_m;                /* the crater index's, when the fliers were found */
    uint32_t frames;             /* since the index was built, up to a number */
    bool never;                  /* for tests: no block is kept */
    uint32_t blocks;             /* of the last frame */
    /* Of each block: */
    uint64_t key[RESTING_BLOCKS_MOST];   /* in the last frame */
    uint8_t rested[RESTING_BLOCKS_MOST]; /* frames with this key, up to a number; 0: it moves */
    uint8_t kept[RESTING_BLOCKS_MOST];   /* 1: its records in the index are right */
    uint8_t flies[RESTING_BLOCKS_MOST];  /* 1: it had fliers when the index was built */
};

/* For up to this many rows. Returns 0, or -1 with errno ENOMEM; must be freed in either case. */
int resting_blocks_init(struct resting_blocks *resting, uint32_t rows);
void resting_blocks_free(struct resting_blocks *resting);

/* Begins a frame of this many rows. */
void resting_blocks_begin(struct resting_blocks *resting, const struct method_input *input);

/* Forgets all blocks. */
void resting_blocks_forget(struct resting_blocks *resting);

/* Notes a block of this frame. Returns true if it is kept: its records are in the index. Any
 * thread, each its own block. */
bool resting_blocks_note(struct resting_blocks *resting, uint32_t block,
                         const struct resting_block *now);

/* Adds the fliers of the blocks that are kept. */
void resting_blocks_add_fliers(const struct resting_blocks *resting, struct body_motion *motion,
                               struct pair_list *fliers);

/* Ends a frame. If enough rows have come to rest, the index is built for the next frame: of all
 * blocks that have rested for some frames. rows: of this frame. */
void resting_blocks_end(struct resting_blocks *resting, const struct body_boxes *rows);

/* Returns true if a record of the index is right. */
static inline bool resting_blocks_holds(const struct resting_blocks *resting,
                                        const struct bin_record *record)
{
    return resting->kept[(record->tag & BIN_ROW) / RESTING_BLOCKS_ROWS] != 0;
}

#endif
