/* Contacts of one frame: found from pairs, kept in the order of their time of impact (ties by the
 * numbers of the bodies), and found again when a body's way has changed. */
#ifndef JOLON_COLLIDER_CONTACT_H
#define JOLON_COLLIDER_CONTACT_H

#include "collider/broad.h"
#include "collider/sweep.h"

#include <stdint.h>

/* Second sides of a contact that are no body. */
#define CONTACT_GROUND UINT32_MAX
#define CONTACT_AIR    (UINT32_MAX - 1) /* a munition's life is over */

struct contact {
    double toi;                    /* 0..1 */
    uint32_t a;                    /* row */
    uint32_t b;                    /* row, PAIR_FIXED object, CONTACT_GROUND or CONTACT_AIR */
    uint32_t version_a, version_b; /* of the ways it was computed from */
    uint32_t pair;                 /* index + 1 into contacts.pair, 0 for ground and air */
};

struct contact_link {
    uint32_t pair; /* index */
    uint32_t next; /* link + 1 */
};

struct contacts {
    struct contact *heap; /* binary heap, earliest first */
    uint32_t count, capacity;
    struct pair *pair; /* all of the frame */
    uint8_t *met;      /* [pair] 1: this pair has had its contact in this frame */
    uint32_t pair_count, pair_capacity;
    struct contact_link *link; /* pairs of each row */
    uint32_t link_count, link_capacity;
    uint32_t *head;    /* [capacity of the world] link + 1; only rows with pairs are set */
    uint32_t *version; /* [capacity of the world] of each row's way; only equality counts */
};

/* 0, or -1 with errno ENOMEM. */
int contacts_init(struct contacts *contacts, uint32_t world_capacity);
void contacts_free(struct contacts *contacts);

/* Begins a frame with the broad phase's pairs. 0, or -1 with errno ENOMEM. */
int contacts_begin(struct contacts *contacts, const struct broad *broad);

/* Clears what begin marked. */
void contacts_end(struct contacts *contacts);

/* A fixed object of less rigidity than this bends aside and lets bodies through. */
#define YIELDING_RIGIDITY 0.1

/* What contact finding reads. */
struct contact_input {
    const struct world *world;
    const struct crater_index *craters;
    const struct entities *entities;
    const struct path *path;
    bool through_fixed; /* bodies may stand in any fixed object: only entering one is a contact; in
                           a yielding one they always may */
};

/* Finds every contact of the frame's pairs. 0, or -1 with errno ENOMEM. */
int contacts_find(struct contacts *contacts, const struct contact_input *input);

/* Finds where a round or an aircraft on its present way meets the ground. 0, or -1 with errno
 * ENOMEM. */
int contacts_ground(struct contacts *contacts, const struct contact_input *input, uint32_t row);

/* A contact of a row with ground or air. 0, or -1 with errno ENOMEM. */
int contacts_add_end(struct contacts *contacts, uint32_t row, uint32_t what, double toi);

/* Takes the earliest contact that still holds; false when there is none. */
bool contacts_next(struct contacts *contacts, struct contact *contact);

/* The row's way has changed at this time: its contacts so far are void and it is swept again
 * against everything it could meet, the ground too. 0, or -1 with errno ENOMEM. */
int contacts_change(struct contacts *contacts, const struct contact_input *input, uint32_t row,
                    double time);

/* The row's contacts are void; none are found again, since its state is ENTITY_FREE now. */
void contacts_drop(struct contacts *contacts, uint32_t row);

#endif
