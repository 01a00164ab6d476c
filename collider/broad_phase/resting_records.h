/* The records of bodies that rest, from frame to frame (docs/decisions/047-hovering-rows.md).
 *
 * The record of a body that neither moves nor turns is the same in each frame. When a body has been
 * so for some frames, its record goes into an index of its own, in which it stays until the body
 * moves. The records of a frame are swept against that index, which is not swept itself: two bodies
 * at rest are no pair. The set of pairs is the same as without the index, so it is a cache of the
 * process. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_RESTING_RECORDS_H
#define JOLON_COLLIDER_BROAD_PHASE_RESTING_RECORDS_H

#include "collider/broad_phase/body_boxes.h"
#include "collider/broad_phase/query_index.h"
#include "collider/broad_phase/sweep_and_prune.h"

#include <stdbool.h>
#include <stdint.h>

#define RESTING_RECORDS_ROWS  1024u /* of a block */
#define RESTING_RECORDS_WORDS (RESTING_RECORDS_ROWS / 64u)

/* Returns true if two rows differ, bit by bit, in a field from which the records of bodies follow:
 * in pose or stretch. */
bool resting_records_pose_differs(const struct entity *a, const struct entity *b);

/* The rows of a block that do not rest in this frame: whose record may not be that of the frame
 * before. */
struct moving_rows {
    bool all;
    uint64_t row[RESTING_RECORDS_WORDS]; /* unless all: a bit for each */
};

struct resting_records {
    struct query_index index;    /* of the rows that are kept, and of some that no longer are */
    struct sweep_worker sweeper; /* used while the index is built */
    uint64_t *kept;              /* a bit for each row whose record in the index is right */
    uint64_t *moved;             /* and for each that has moved since the rows were looked at */
    uint64_t *written;           /* and for each that a response has written since it was noted */
    uint64_t *flies;             /* of the rows that are kept, the aircraft */
    uint64_t *awake;  /* a bit for each that moves, or was written since the last frame */
    uint32_t words;   /* of each */
    uint32_t craters; /* of the ground above which the aircraft are */
    uint32_t frames;  /* since the rows were looked at */
    uint64_t waste; /* records that have been made for rows that rest, since the index was built */
    uint32_t rows;  /* of the last frame */
    bool never;     /* for tests: no record is kept */
};

/* For up to this many rows. Returns 0, or -1 with errno ENOMEM; must be freed in either case. */
int resting_records_init(struct resting_records *resting, uint32_t rows);
void resting_records_free(struct resting_records *resting);

/* Begins a frame of this many rows. A new crater lets the aircraft go. */
void resting_records_begin(struct resting_records *resting, const struct method_input *input);

/* Forgets all records: rows may have moved without having been noted. */
void resting_records_forget(struct resting_records *resting);

/* Notes which rows of a block move, or were written since the last frame, and sets in `bin` the
 * rows whose records must be made in this frame. held: bits of the rows that cruise, of all blocks:
 * one that does not move has no record. Returns how many these are. Any thread, each its own
 * block. */
uint32_t resting_records_note(struct resting_records *resting, uint32_t block,
                              const struct moving_rows *moving, const uint64_t *held,
                              uint64_t bin[RESTING_RECORDS_WORDS]);

/* Ends a frame. If it pays, the index is built for the next frame: of all rows that have rested for
 * some frames, but those that would touch the ground. rows: of this frame. */
void resting_records_end(struct resting_records *resting, const struct body_boxes *rows);

/* Returns true if a row of this frame moves, or a response has written it in the last one. The rows
 * of the frame have been noted. */
static inline bool resting_records_awake(const struct resting_records *resting, uint32_t row)
{
    return resting->never || resting->awake[row / 64] >> row % 64 & 1;
}

/* Returns true if a response has written the row in this frame. */
static inline bool resting_records_written(const struct resting_records *resting, uint32_t row)
{
    return resting->written[row / 64] >> row % 64 & 1;
}

/* Returns true if a record of the index is right. */
static inline bool resting_records_holds(const struct resting_records *resting,
                                         const struct bin_record *record)
{
    uint32_t row = record->tag & BIN_ROW;
    return resting->kept[row / 64] >> row % 64 & 1;
}

#endif
