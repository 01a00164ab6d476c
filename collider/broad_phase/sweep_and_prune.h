/* One strip of gridsquares: which of its records meet each other, and which fixed objects they
 * meet. Strips are independent of each other; each worker has its own sweep_worker. */
#ifndef JOLON_COLLIDER_BROAD_PHASE_SWEEP_AND_PRUNE_H
#define JOLON_COLLIDER_BROAD_PHASE_SWEEP_AND_PRUNE_H

#include "collider/broad_phase/strip_bins.h"
#include "collider/motion/pair_filter.h"
#include "collider/motion/body_motion.h"
#include "collider/broad_phase/static_boxes.h"

#include <stdint.h>

struct resting_records;
struct strips;

#define SWEEP_AND_PRUNE_CANDIDATES 4096u

/* The memory of one worker, kept from frame to frame. */
struct sweep_worker {
    const struct strips *strips; /* of this frame */
    uint32_t strip;              /* the strip in work */
    struct strip_bins bins;
    struct bin_record *record; /* [capacity] of the strip, unsorted */
    struct bin_record *sorted; /* [capacity] by bucket from west to east, then padding */
    /* The words of the sorted records, then padding that meets nothing. */
    int32_t *min_x, *max_x, *low_z, *high_z;
    uint32_t *tag;
    uint32_t tags; /* the tags of all records, or-ed */
    uint32_t count, capacity;
    uint32_t *bucket;       /* where each bucket's records end */
    uint32_t shift;         /* a bucket is 2^shift steps wide */
    uint32_t first, last;   /* which they are, in their widths from the world's west edge */
    struct pair *candidate; /* [SWEEP_AND_PRUNE_CANDIDATES] tags of records that meet */
    uint32_t candidates;
    struct pair_list pairs;  /* the result */
    struct pair_list fliers; /* rows, in a, whose path may end in this frame */
};

/* What the strips of a frame share. */
struct strips {
    const struct method_input *input;
    struct body_motion *motion; /* computes the paths; NULL: they are in input->path */
    const struct static_boxes *fixed_boxes;
    const struct resting_records *resting; /* NULL: none */
    float steps_per_m;                     /* bin_steps_per_m() */
    const struct path_box *box;            /* [rows] */
    const double *margin;                  /* [kinds] from a row's path to its box [m] */
    struct sweep_worker *sweeper;          /* [sweepers] whose bins make up the strips */
    uint32_t sweepers;
};

/* Reserves memory for this many rows and pairs. Returns 0, or -1 with errno ENOMEM; must be freed
 * in either case. */
int sweep_worker_init(struct sweep_worker *sweeper, uint32_t rows, uint32_t pairs);
void sweep_worker_free(struct sweep_worker *sweeper);

/* The part of a row's box that the row can reach while it is in the strip, from west to east. This
 * is the whole box except for long paths. */
struct sweep_and_prune_span {
    int32_t min_x, max_x; /* [steps] */
};
struct sweep_and_prune_span sweep_and_prune_span(float steps_per_m, const struct path *path,
                                                 const struct path_box *box, double margin,
                                                 uint32_t strip);

/* Adds the pairs that meet in this strip and in no earlier one to the sweeper's pairs. */
void sweep_and_prune_pairs(const struct strips *strips, struct sweep_worker *sweeper,
                           uint32_t strip);

#endif
