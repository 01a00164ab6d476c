/* The contacts of one frame: found from pairs, ordered by time of impact (equal times by the
 * numbers of the bodies), and found again when a body's path has changed. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_CONTACT_QUEUE_H
#define JOLON_COLLIDER_NARROW_PHASE_CONTACT_QUEUE_H

#include "collider/broad_phase/broad_phase.h"
#include "collider/geometry/level_gap.h"
#include "collider/narrow_phase/alone_rows.h"
#include "collider/narrow_phase/axis_memory.h"
#include "collider/narrow_phase/gap_memory.h"
#include "collider/narrow_phase/narrow_phase.h"
#include "collider/narrow_phase/pair_apart.h"
#include "world/entity/table_write.h"

#include <stdint.h>

/* Second sides of a contact that are not bodies. */
#define CONTACT_GROUND UINT32_MAX
#define CONTACT_AIR    (UINT32_MAX - 1) /* the end of a munition's life */

/* Contacts closer in time than this happen at the same moment [frame]. */
#define CONTACT_TIE 1e-9

/* Most contacts of a pair in a frame; after the last one its bodies stay where they are. A higher
 * value finds more of the rebounds between bodies that a third one closes in on. */
#define CONTACT_MEETS_MAX 8

/* Bodies in a contact that lasts, and that close more slowly than this, rest on each other: such a
 * contact is no impact [m/s]. */
#define CONTACT_IMPACT_MPS 1.0

/* Bodies that rest on each other keep this gap [m]. The sweeps leave a part of their closing speed:
 * with a smaller gap the guard has to send bodies back in more frames. */
#define CONTACT_REST_M 5e-3

/* Bodies in a contact that lasts touch if they are this near, even if they bear no load [m]. */
#define CONTACT_TOUCHING_M (2.0 * CONTACT_REST_M)

/* Marks of a pair. */
#define CONTACT_RESTS    1u  /* collider/resting/ has solved it, or its bodies have met */
#define CONTACT_PRESSED  2u  /* its bodies touched in this frame */
#define CONTACT_OVERLAPS 4u  /* they overlap, and have to part in the next frame */
#define CONTACT_GATHERED 8u  /* it belongs to the island that is being solved */
#define CONTACT_PARTS    16u /* it is deep: its bodies only have to part */
#define CONTACT_HOLDS    32u /* its bodies stand still because one keeps the other from moving */
#define CONTACT_NO_ROOM  64u /* its bodies touched, but the table of contacts has no room for it */
#define CONTACT_CAPSULES                                                                           \
    128u /* with _PARTS: it is so deep that its bodies part as capsules,                           \
               or they are aircraft */

/* A point at which two bodies rest on each other, on the map. */
struct rest_point {
    double normal_x, normal_z; /* unit, from a to b */
    double a_x, a_z, b_x, b_z; /* [m] from the bodies' positions; b of a fixed object: 0 */
};

struct contact {
    struct hull_contact impact;
    uint32_t a;                    /* row */
    uint32_t b;                    /* row, PAIR_FIXED object, CONTACT_GROUND or CONTACT_AIR */
    uint32_t version_a, version_b; /* of the paths from which it was computed */
    uint32_t pair;                 /* index + 1 into contacts.pair, 0 for ground and air */
    uint32_t last;                 /* 1: the pair cannot meet again in this frame */
};

/* The impacts of a pair in a frame. */
struct pair_impacts {
    uint32_t count;
    float impulse_ns; /* of all together */
};

#define PAIR_NOT_MEASURED 1.0 /* [m] no gap of overlapping bodies */

/* What the frame has found out about a pair whose bodies are near enough to rest on each other. By
 * the normal the guard chooses whom it sends back first. */
struct resting_known {
    double normal_x, normal_z; /* unit, from a to b: of the smallest gap of bodies that rest when
                                  the frame begins; 0: they do not */
    uint32_t gap; /* index + 1 into the gaps of resting contacts (collider/resting/resting.h), 0:
                     there is none */
    struct level_gap_memory memory;                       /* of their near hulls */
    struct contact_load load[PERSISTENT_CONTACT_NEAREST]; /* of the pairs of hulls in memory */
};

/* What the frame has found out about any pair. It follows from the committed frame and saves work.
 * Each pair has one, and most are of bodies that stay apart: it is small. */
struct pair_known {
    struct vec3 plane[LEVEL_GAP_PLANES]; /* unit, from a to b: normals that may separate the bodies,
                                            the first one their outer hulls; 0: none known */
    double before_m; /* their gap in the committed frame, 0 if they were apart, or
                                  PAIR_NOT_MEASURED */
    double way_m;    /* of bodies that part: how far it is out of each other then; 0: not known */
    double apart_m;  /* they are apart by this at least when the frame begins; 0: not known */
    uint32_t rested; /* index + 1 into contact_queue.rested, 0: they are not near enough */
    /* On these versions of their paths the bodies certainly stay apart until the frame's end, by at
     * least stays_m; version_a of UINT32_MAX: that is not known. */
    uint32_t version_a, version_b;
    double stays_m;
};

struct contact_link {
    uint32_t pair; /* index */
    uint32_t next; /* link + 1 */
};

/* The points of one pair: an index, and how many. */
struct rest_span {
    uint32_t first, count;
};

/* A pair that a change of paths sweeps, and what it finds. */
struct due_pair {
    uint32_t pair; /* index */
    bool meets;
    struct contact contact; /* if they do */
};

struct contact_list {
    struct contact *contact;
    uint32_t count, capacity;
};

struct contact_queue {
    struct thread_pool *workers;
    struct contact_list heap; /* binary heap, earliest first; void contacts are dropped at the top,
                                 or when they are half of all */
    struct pair *pair;        /* every pair of the frame */
    uint8_t *met;             /* [pair] contacts of this pair in this frame */
    uint32_t *swept;          /* [pair] the last change that swept it, 0: none */
    uint8_t *marks;           /* [pair] of CONTACT_RESTS to CONTACT_HOLDS */
    struct pair_impacts *impacts; /* [pair] */
    struct pair_known *known;     /* [pair] */
    uint32_t *searched; /* [pair] dear searches for an axis (axis_memory.h) since one has found it,
                           and 1; 0: the frame needed none, or has found what is remembered */
    struct resting_known *rested; /* [rested_count] in the order in which they were found */
    uint32_t rested_count;
    struct rest_span *rest; /* [pair] where its bodies rest on each other */
    struct rest_point *rest_point;
    uint32_t rest_points, rest_capacity;
    uint32_t change; /* changes so far in this frame */
    uint32_t pair_count, pair_capacity;
    struct contact_link *link; /* of the rows' lists of pairs; two for each of pair_capacity */
    uint32_t link_count;
    uint32_t rows;     /* capacity of the world */
    uint32_t *head;    /* [capacity of the world] link + 1; set only for rows with pairs */
    uint32_t *version; /* [capacity of the world] of each row's path; compared only for equality */
    uint32_t *strayed; /* rows whose path has left the box that the broad phase has */
    uint8_t *strays;   /* [capacity of the world] 1: the row is in strayed */
    uint8_t *paired;   /* [capacity of the world] 1: with the row that is looked at, else 0 */
    uint32_t stray_count;
    struct due_pair *due; /* [pair_capacity] */
    uint32_t due_count;
    uint32_t *due_row; /* [capacity of the world] rows that have to be prepared */
    uint32_t due_rows;
    struct pair_list near; /* result of a query */
    struct alone_rows alone;
    struct pair_apart apart;
    struct axis_memory axes;
    struct gap_memory gaps;
    bool proves; /* pairs that certainly stay apart are not swept: bodies are hulls */
};

/* What the search for contacts reads. */
struct contact_input {
    struct method_input detect;
    struct body_motion *motion;
    struct broad_phase *broad;  /* the boxes of strayed rows are changed here */
    uint32_t meets;             /* how often a pair may meet in a frame */
    bool through_fixed;         /* see narrow_phase_find */
    struct table_writer writer; /* ends stretches (collider/narrow_phase/cruise_rows.h) */
};

/* Returns 0, or -1 with errno ENOMEM. workers may be NULL and stays the caller's. */
int contact_queue_init(struct contact_queue *contacts, const struct world *world,
                       struct thread_pool *workers);
void contact_queue_free(struct contact_queue *contacts);

/* Begins a frame with these lists of pairs. */
void contact_queue_begin(struct contact_queue *contacts, const struct pair_list *lists,
                         uint32_t list_count);

/* Resets the marks that contact_queue_begin() set. */
void contact_queue_end(struct contact_queue *contacts);

/* Returns true if the sweep has shown that the pair stays apart until the frame's end on its
 * bodies' present paths. */
bool contact_queue_stays_apart(const struct contact_queue *contacts, uint32_t pair);

/* Returns the index of a pair in contacts->pair, and adds it if it is missing. */
uint32_t contact_queue_pair(struct contact_queue *contacts, const struct pair *pair);

/* Returns what is known of a pair as one whose bodies may rest on each other: nothing at first. */
struct resting_known *contact_queue_rested(struct contact_queue *contacts, uint32_t pair);

/* Returns the same, or NULL if nothing is. */
static inline const struct resting_known *
contact_queue_knows_rested(const struct contact_queue *contacts, uint32_t pair)
{
    uint32_t rested = contacts->known[pair].rested;
    return rested != 0 ? &contacts->rested[rested - 1] : NULL;
}

/* Returns where searches between the near hulls of a pair begin, or NULL. */
static inline const struct level_gap_memory *
contact_queue_memory(const struct contact_queue *contacts, uint32_t pair)
{
    const struct resting_known *rested = contact_queue_knows_rested(contacts, pair);
    return rested ? &rested->memory : NULL;
}

/* Adds the pairs of a row with all bodies near its path, which may have left the box that the broad
 * phase has. resting: also those of two bodies that rest. Nothing is swept. */
void contact_queue_look(struct contact_queue *contacts, const struct contact_input *input,
                        uint32_t row, bool resting);

/* Prepares contact_queue_alone() of these rows, on all workers. */
void contact_queue_find_alone(struct contact_queue *contacts, const struct contact_input *input,
                              const uint32_t *row, uint32_t count);

/* Returns true if nothing is near a row of the last search, and a look would find no pair. */
static inline bool contact_queue_alone(const struct contact_queue *contacts, uint32_t row)
{
    return contacts->alone.alone[row] && contacts->head[row] == 0 && contacts->stray_count == 0;
}

/* The same with a box that is so much wider to all four sides [m], and with bodies that rest. */
void contact_queue_look_wider(struct contact_queue *contacts, const struct contact_input *input,
                              uint32_t row, double wider_m);

/* The bodies of a pair rest on each other at these points: marks it as CONTACT_RESTS. From now on
 * the pair is swept only if it closes as fast as in an impact at one of the points. Without points
 * it always is. */
void contact_queue_rest(struct contact_queue *contacts, uint32_t pair,
                        const struct rest_point *point, uint32_t count);

/* Finds the first contact of each of the frame's pairs, on all workers. */
void contact_queue_find(struct contact_queue *contacts, const struct contact_input *input);

/* Finds where broad->fliers meet the ground, and the rounds whose life ends with this frame, on all
 * workers. */
void contact_queue_find_ends(struct contact_queue *contacts, const struct contact_input *input,
                             uint64_t tick);

/* Finds where a round or an aircraft on its present path meets the ground. */
void contact_queue_ground(struct contact_queue *contacts, const struct contact_input *input,
                          uint32_t row);

/* Adds a contact of a row with ground or air; each path has at most one of either. */
void contact_queue_add_end(struct contact_queue *contacts, uint32_t row, uint32_t what, double toi);

/* Returns the earliest valid contact, which stays in the heap, or NULL. The pointer is valid until
 * the heap changes. */
const struct contact *contact_queue_peek(struct contact_queue *contacts);

/* Takes the earliest valid contact. Returns false if there is none. */
bool contact_queue_next(struct contact_queue *contacts, const struct contact_input *input,
                        struct contact *contact);

/* Keeps the next change from sweeping the contact's pair: the pair meets again only after a further
 * change of a path. */
void contact_queue_skip_pair(struct contact_queue *contacts, const struct contact *contact);

/* The rows' paths have changed at this time. Makes their contacts void, looks up what their new
 * paths may meet, and sweeps them against all of that and the ground, each pair once, on all
 * workers. */
void contact_queue_change(struct contact_queue *contacts, const struct contact_input *input,
                          const uint32_t *rows, uint32_t count, double time);

/* Makes the row's contacts void. None are found again, since its state is ENTITY_FREE now. */
void contact_queue_drop(struct contact_queue *contacts, uint32_t row);

#endif
