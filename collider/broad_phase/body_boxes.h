/* The frame's rows on their way into the strips: each row's box, its record, and who flies. Rows
 * are independent of each other; each worker has its own sweep_worker to put them in. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_BODY_BOXES_H
#define JOLON_COLLIDER_BROAD_PHASE_BODY_BOXES_H

#include "collider/motion/pair_filter.h"
#include "collider/motion/body_motion.h"
#include "collider/broad_phase/sweep_and_prune.h"

#include <stdint.h>

/* What the rows of a frame share. */
struct body_boxes {
    const struct method_input *input;
    struct body_motion *motion; /* draws the ways; NULL: they are in input->path */
    struct path_box *box;       /* [rows] */
    const double *grow;         /* [kinds] from a row's way to its box */
    const uint32_t *flags;      /* [kinds] of a record's tag */
};

/* Fills the boxes of rows first .. end - 1, adds their records to the sweeper's bins and who may
 * reach the ground, rounds and aircraft, to its fliers. Without motion every way must be drawn;
 * with it those of fliers are drawn here, and of who is in several strips. */
void body_boxes_bin(const struct body_boxes *rows, struct sweep_worker *sweeper, uint32_t first,
                    uint32_t end);

#endif
