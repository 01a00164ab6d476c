/* Contacts of one frame: found from pairs, kept in the order of their time of impact (ties by the
 * numbers of the bodies), and found again when a body's way has changed. */
#ifndef JOLON_COLLIDER_NARROW_PHASE_CONTACT_QUEUE_H
#define JOLON_COLLIDER_NARROW_PHASE_CONTACT_QUEUE_H

#include "collider/broad_phase/broad_phase.h"
#include "collider/narrow_phase/narrow_phase.h"

#include <stdint.h>

/* Second sides of a contact that are no body. */
#define CONTACT_GROUND UINT32_MAX
#define CONTACT_AIR    (UINT32_MAX - 1) /* a munition's life is over */

/* Contacts this near in time happen at one moment [frame]. */
#define CONTACT_TIE 1e-9

/* A pair may meet this often in a frame; the last time its bodies stay where they are. Higher finds
 * longer rattling between bodies that close in on a third. */
#define CONTACT_MEETS_MAX 8

struct contact {
    struct hull_contact touch;
    uint32_t a;                    /* row */
    uint32_t b;                    /* row, PAIR_FIXED object, CONTACT_GROUND or CONTACT_AIR */
    uint32_t version_a, version_b; /* of the ways it was computed from */
    uint32_t pair;                 /* index + 1 into contacts.pair, 0 for ground and air */
    uint32_t last;                 /* 1: the pair will not meet again in this frame */
};

struct contact_link {
    uint32_t pair; /* index */
    uint32_t next; /* link + 1 */
};

struct contact_list {
    struct contact *contact;
    uint32_t count, capacity;
};

struct contact_queue {
    struct thread_pool *workers;
    struct contact_list heap; /* binary heap, earliest first; void ones are dropped as they come
                                 up, or when they are half of all */
    struct pair *pair;        /* all of the frame */
    uint8_t *met;             /* [pair] how often this pair has met in this frame */
    uint32_t *swept;          /* [pair] with which change last, 0: with none */
    uint32_t change;          /* changes so far in this frame */
    uint32_t pair_count, pair_capacity;
    struct contact_link *link; /* pairs of each row; two for each of pair_capacity */
    uint32_t link_count;
    uint32_t rows;     /* capacity of the world */
    uint32_t *head;    /* [capacity of the world] link + 1; only rows with pairs are set */
    uint32_t *version; /* [capacity of the world] of each row's way; only equality counts */
    uint32_t *strayed; /* rows whose way has left the box that the broad phase knows */
    uint8_t *strays;   /* [capacity of the world] 1: it is among them */
    uint32_t stray_count;
    struct pair_list near; /* what a query found */
};

/* What contact finding reads. */
struct contact_input {
    struct method_input detect;
    struct body_motion *motion;
    struct broad_phase *broad; /* boxes of strayed rows are written */
    uint32_t meets;            /* how often a pair may meet in a frame */
    bool through_fixed;        /* see narrow_phase_touch */
};

/* 0, or -1 with errno ENOMEM. workers may be NULL and stays the caller's. */
int contact_queue_init(struct contact_queue *contacts, const struct world *world,
                       struct thread_pool *workers);
void contact_queue_free(struct contact_queue *contacts);

/* Begins a frame with these lists of pairs. */
void contact_queue_begin(struct contact_queue *contacts, const struct pair_list *lists,
                         uint32_t list_count);

/* Clears what begin marked. */
void contact_queue_end(struct contact_queue *contacts);

/* Finds every contact of the frame's pairs, on all workers. */
void contact_queue_find(struct contact_queue *contacts, const struct contact_input *input);

/* Finds where broad->fliers meet the ground, and the rounds whose life ends with
 * the frame unless something earlier ends it, on all workers. */
void contact_queue_find_ends(struct contact_queue *contacts, const struct contact_input *input,
                             uint64_t tick);

/* Finds where a round or an aircraft on its present way meets the ground. */
void contact_queue_ground(struct contact_queue *contacts, const struct contact_input *input,
                          uint32_t row);

/* A contact of a row with ground or air; of one way of the row one with each. */
void contact_queue_add_end(struct contact_queue *contacts, uint32_t row, uint32_t what, double toi);

/* The earliest contact that still holds, left in its place until the heap changes; NULL when there
 * is none. */
const struct contact *contact_queue_peek(struct contact_queue *contacts);

/* Takes it; false when there is none. */
bool contact_queue_next(struct contact_queue *contacts, const struct contact_input *input,
                        struct contact *contact);

/* The next change does not sweep the contact's pair: it meets again only once one of the two takes
 * yet another way. */
void contact_queue_settle(struct contact_queue *contacts, const struct contact *contact);

/* The rows' ways have changed at this time: their contacts so far are void, what their new ways
 * could meet is looked up, and they are swept again against all of that, the ground too; each pair
 * once. */
void contact_queue_change(struct contact_queue *contacts, const struct contact_input *input,
                          const uint32_t *rows, uint32_t count, double time);

/* The row's contacts are void; none are found again, since its state is ENTITY_FREE now. */
void contact_queue_drop(struct contact_queue *contacts, uint32_t row);

#endif
