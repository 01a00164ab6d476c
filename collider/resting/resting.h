/* Resting contacts: contacts that last from frame to frame, among bodies that the ground holds and
 * the objects that stand. They are solved before the frame's impacts are searched, all together, so
 * that a heap of vehicles presses and pushes without a collision in each frame. Pure; one caller,
 * and its workers.
 */
#ifndef JOLON_COLLIDER_RESTING_RESTING_H
#define JOLON_COLLIDER_RESTING_RESTING_H

#include "collider/geometry/level_exit.h"
#include "collider/geometry/level_gap.h"
#include "collider/resting/begun_bodies.h"
#include "collider/resting/contact_groups.h"
#include "collider/resting/crowds.h"
#include "collider/resting/neighbours.h"
#include "collider/resting/parting.h"
#include "collider/solver/level_solver.h"

#include <stdbool.h>
#include <stdint.h>

struct thread_pool;

/* Bodies that begin the frame deeper in each other than this only have to part: they have no
 * impacts, and the guard at the frame's end does not hold them back from each other [m]. */
#define RESTING_PARTS_M LEVEL_GAP_PARTS_M

/* Of bodies that part, and of their neighbours, so many pairs of hulls count. */
#define RESTING_GAPS_MAX   12u
#define RESTING_POINTS_MAX (2u * RESTING_GAPS_MAX) /* of a pair */

/* Two bodies in a contact that lasts. */
struct resting_pair {
    uint32_t pair;         /* index into contacts->pair */
    uint32_t first, count; /* its points, those of each gap in turn */
    uint32_t gaps;
    bool capsules;               /* as in resting_gap */
    bool known;                  /* it is in the committed table */
    bool holds;                  /* a frame ago it kept its bodies from moving */
    const struct level_gap *gap; /* the smallest, until the next frame */
    double gap_m;                /* the smallest, at the frame's beginning; below 0: overlap */
};

/* How the two bodies of a pair lie at the frame's beginning. */
struct resting_gap {
    struct level_gap *gap; /* smallest first: in few, or in the row's own place in resting.wide */
    uint32_t count;        /* at most LEVEL_GAPS_MAX are in few, and more only where bodies part */
    uint32_t pair;         /* index into contacts->pair, if there are gaps */
    uint32_t place;        /* index + 1 there of a pair that the search for pairs found, else 0 */
    bool capsules;   /* it is so deep that it parts as capsules (collider/resting/deep_pair.h) */
    bool put_off;    /* it is measured when the crowds are known */
    bool spreads;    /* it parts with a crowd that spreads: its normal and its bounds are unknown */
    double apart_m;  /* the bodies are apart by this at least */
    double margin_m; /* hulls that are not in gap are apart by this at least; 0: not known */
    double pieces_m; /* of a pair that parts by its pieces: their gap, else PAIR_NOT_MEASURED */
    bool leaves;     /* it needs a way out (collider/resting/parting_ways.h) */
    bool went;       /* and has been given it */
    bool along_ground; /* the way rises with the ground, because bodies that tried a level one
                          stayed */
    struct level_gap_memory memory;
    const struct persistent_contact *known; /* the pair's row in the committed table, or NULL */
    /* Of what it was measured: the versions of its bodies (begun_bodies.h), and the memory that the
     * search began with. */
    uint64_t version[2];
    struct level_gap_memory began;
    bool repeats;                     /* the same would be found again */
    const struct resting_gap *before; /* of the same pair in the frame before, or NULL */
    struct level_gap few[LEVEL_GAPS_MAX];
};

/* The collider's own memory, kept from frame to frame. */
struct resting {
    struct thread_pool *workers;
    struct contact_groups groups;
    struct begun_bodies begun;
    struct crowds crowds;
    struct parting parting;
    struct level_lanes lanes;
    struct neighbours neighbours;
    struct level_exit exit;
    uint32_t *leaving;       /* [capacity of the world] pairs of the row that need a way out */
    struct resting_gap *gap; /* [groups.count] */
    struct resting_gap *gap_before; /* [before] of the table's pairs in the frame before, by key */
    uint64_t *key, *key_before;     /* [groups.known] and [before] the keys of these pairs */
    uint32_t *before_of; /* [groups.known] index + 1 of the same pair into gap_before, else 0 */
    uint32_t before;
    struct level_gap *wide; /* [RESTING_GAPS_MAX * capacity] the lists that few has no room for */
    uint32_t *put_off;      /* gaps that are measured when the crowds are known */
    struct resting_pair *pair;
    uint32_t pairs, capacity;
    struct level_contact *point;
    uint32_t points;
    struct level_body *body;
    uint32_t *row;      /* [bodies] SLOT_NONE for a fixed object */
    double *pressed_ns; /* [bodies] impulses of all its contacts along their normals [N s] */
    bool *stands;       /* [bodies] true: it stays where it is (collider/resting/stalled.h) */
    uint32_t bodies;
    uint32_t *body_of; /* [capacity of the world] body + 1, else 0 */
    uint32_t *moved;   /* rows whose motion the contacts changed */
    uint32_t moved_count;
};

/* Returns 0, or -1 with errno ENOMEM. workers may be NULL and stays the caller's. */
int resting_init(struct resting *resting, const struct world *world, struct thread_pool *workers);
void resting_free(struct resting *resting);

/* Solves the contacts of the committed table whose bodies are still near each other and do not
 * close as fast as in an impact, and gives the bodies their motion. Marks their pairs as
 * CONTACT_RESTS, and those that bore a load as CONTACT_PRESSED. The frame's pairs must be in the
 * queue, and nothing swept yet. */
void resting_solve(struct resting *resting, struct response_context *context);

/* Reports a contact that begins with an overlap: no impact will do it. */
void resting_report(struct response_context *context, const struct pair *pair,
                    const struct level_gap *gap);

/* Returns a row that the ground holds as a body of the solver, with the motion that it has so far
 * and the grip that the ground has left. */
void resting_level_body(const struct response_context *context, uint32_t row,
                        struct level_body *body);

#endif
