/* One strip of gridsquares: which of the records in it meet, and which fixed objects they meet.
 * Strips are independent of each other; each worker has its own sweep_worker. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_SWEEP_AND_PRUNE_H
#define JOLON_COLLIDER_BROAD_PHASE_SWEEP_AND_PRUNE_H

#include "collider/broad_phase/strip_bins.h"
#include "collider/motion/pair_filter.h"
#include "collider/motion/body_motion.h"
#include "collider/broad_phase/static_boxes.h"

#include <stdint.h>

struct strips;

#define SWEEP_AND_PRUNE_CANDIDATES 4096u

/* What a worker works with; kept from frame to frame. */
struct sweep_worker {
    const struct strips *strips; /* of the frame ... */
    uint32_t strip;              /* ... and the one that is worked on */
    struct strip_bins bins;
    struct bin_record *record; /* [capacity] the strip's, as gathered */
    struct bin_record *sorted; /* [capacity] bucket by bucket from west to east, and padding */
    /* The sorted records' parts, and padding that meets nothing. */
    int32_t *min_x, *max_x, *low_z, *high_z;
    uint32_t *tag;
    uint32_t tags; /* of all together */
    uint32_t count, capacity;
    uint32_t *bucket;       /* where the bucket's records end */
    uint32_t shift;         /* a bucket is 2^shift steps wide */
    struct pair *candidate; /* [SWEEP_AND_PRUNE_CANDIDATES] tags of records that meet */
    uint32_t candidates;
    struct pair_list pairs;  /* the result */
    struct pair_list fliers; /* rows, in a, that may end in this frame */
};

/* What the strips of a frame share. */
struct strips {
    const struct method_input *input;
    struct body_motion *motion; /* draws the ways; NULL: they are in input->path */
    const struct static_boxes *fixed_boxes;
    const struct path_box *box;   /* [rows] */
    const double *grow;           /* [kinds] from a row's way to its box */
    struct sweep_worker *sweeper; /* [sweepers] whose bins make up the strips */
    uint32_t sweepers;
};

/* For this many rows and pairs. 0, or -1 with errno ENOMEM; to be freed in either case. */
int sweep_worker_init(struct sweep_worker *sweeper, uint32_t rows, uint32_t pairs);
void sweep_worker_free(struct sweep_worker *sweeper);

/* The part of a row's box in which it can be while it is in the strip, from west to east: the whole
 * of it, but for long ways. */
struct sweep_and_prune_span {
    int32_t min_x, max_x; /* [steps] */
};
struct sweep_and_prune_span sweep_and_prune_span(const struct path *path,
                                                 const struct path_box *box, double grow,
                                                 uint32_t strip);

/* Adds to the sweeper's pairs what meets in this strip and in none before it. */
void sweep_and_prune_pairs(const struct strips *strips, struct sweep_worker *sweeper,
                           uint32_t strip);

#endif
