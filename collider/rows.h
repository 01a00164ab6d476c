/* The frame's rows on their way into the strips: each row's box, its record, and who flies. Rows
 * are independent of each other; each worker has a lane to put them in. */
#ifndef JOLON_COLLIDER_ROWS_H
#define JOLON_COLLIDER_ROWS_H

#include "collider/detect.h"
#include "collider/motion.h"
#include "collider/strip.h"

#include <stdint.h>

/* What the rows of a frame share. */
struct rows {
    const struct detect_input *input;
    struct motion *motion; /* draws the ways; NULL: they are in input->path */
    struct sweep_box *box; /* [rows] */
    const double *grow;    /* [kinds] from a row's way to its box */
    const uint32_t *flags; /* [kinds] of a record's tag */
};

/* Fills the boxes of rows first .. end - 1, adds their records to the lane's bins and who may reach
 * the ground, rounds and aircraft, to its fliers. Without motion every way must be drawn; with it
 * those of fliers are drawn here, and of who is in several strips. */
void rows_bin(const struct rows *rows, struct strip_lane *lane, uint32_t first, uint32_t end);

#endif
