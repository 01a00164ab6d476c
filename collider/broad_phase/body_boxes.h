/* The first pass of the broad phase: computes the box and the record of each row, puts the records
 * into the strips' bins and lists the fliers. Rows are independent of each other; each worker has
 * its own sweep_worker. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_BODY_BOXES_H
#define JOLON_COLLIDER_BROAD_PHASE_BODY_BOXES_H

#include "collider/motion/pair_filter.h"
#include "collider/motion/body_motion.h"
#include "collider/broad_phase/sweep_and_prune.h"

#include <stdint.h>

/* What all workers share in a frame. */
struct body_boxes {
    const struct method_input *input;
    struct body_motion *motion; /* computes the paths; NULL: they are in input->path */
    float steps_per_m;          /* bin_steps_per_m() */
    struct path_box *box;       /* [rows] */
    const double *margin;       /* [kinds] from a row's path to its box [m] */
    const uint32_t *flags;      /* [kinds] bits of a record's tag */
    uint8_t *wider;             /* [rows] enum body_box_wider, or NULL */
    /* A bit for each row that moves in this frame. One that cruises and does not has no record.
     * NULL: no row cruises. */
    const uint64_t *awake;
};

/* Collisions change the paths of some bodies after their boxes have been compared. */
enum body_box_wider {
    BODY_BOX_EXACT,
    BODY_BOX_ASKED, /* in: its box is to be wider; out: another path may meet more bodies */
    BODY_BOX_WIDER  /* out: it is wider, and all that meets it is found */
};

/* By this much on each side [m]. */
#define BODY_BOX_WIDER_M 0.1

/* Fills the boxes of rows first .. end - 1, adds their records to the worker's bins, and those that
 * may reach the ground (rounds and aircraft) to its fliers. Without motion all paths must have been
 * computed. With motion, the paths of fliers and of rows in several strips are computed here. */
void body_boxes_bin(const struct body_boxes *rows, struct sweep_worker *sweeper, uint32_t first,
                    uint32_t end);

/* The same for some rows of 64, by a bit for each; first is a multiple of 64. */
void body_boxes_bin_some(const struct body_boxes *rows, struct sweep_worker *sweeper,
                         uint32_t first, uint64_t some);

#endif
