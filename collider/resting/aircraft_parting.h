/* Crowds of aircraft that begin deep in each other. They only have to part: like bodies on the
 * ground (parting.h) they have no impacts on each other and are displaced, without a velocity. They
 * do so horizontally, each pair along the line between its bodies. Pure; one caller, and its
 * workers. */
#ifndef JOLON_COLLIDER_RESTING_AIRCRAFT_PARTING_H
#define JOLON_COLLIDER_RESTING_AIRCRAFT_PARTING_H

#include "collider/geometry/level_gap.h"
#include "collider/response/response_context.h"

#include <stdbool.h>
#include <stdint.h>

/* A pair of which both aircraft may be deep. */
struct aircraft_pair {
    uint32_t pair; /* index + 1 in the queue */
    bool overlaps;
    bool fresh; /* one of the two is new */
    bool known; /* it is in the committed table */
    struct level_gap gap;
};

/* An aircraft as it stands when the frame begins, and how it is to go. */
struct aircraft_body {
    struct swept_body body;
    struct mat3 turn;
    bool parts; /* from another one, or makes room for those that do */
    struct vec3 wish_mps;
};

/* The collider's own memory. */
struct aircraft_parting {
    struct thread_pool *workers;
    uint32_t *row; /* [rows] first those that are new, then those that part, then others near the
                      new ones */
    uint32_t rows;
    uint32_t fresh, listed; /* where the second and the third begin */
    uint32_t *body_of;      /* [capacity of the world] index + 1 into row and body, else 0 */
    struct aircraft_body *body;
    struct pair_list list;
    struct aircraft_pair *pair; /* [list.count] */
    uint64_t pair_capacity;
};

/* Returns 0, or -1 with errno ENOMEM. workers may be NULL and stays the caller's. */
int aircraft_parting_init(struct aircraft_parting *parting, const struct world *world,
                          struct thread_pool *workers);
void aircraft_parting_free(struct aircraft_parting *parting);

/* Finds the aircraft that are deep in each other: those that are new in this frame, and those that
 * have not parted yet, with all that touch these. Marks the pairs of two of them as CONTACT_PARTS:
 * they have no impacts. fresh: [count] the new ones. */
void aircraft_parting_find(struct aircraft_parting *parting, struct response_context *context,
                           const uint32_t *fresh, uint32_t count);

/* Displaces them by what this frame's paths get longer. Adds their rows to moved; returns how many
 * it holds then. The caller has given all bodies their motion. */
uint32_t aircraft_parting_go(struct aircraft_parting *parting, struct response_context *context,
                             uint32_t *moved, uint32_t count);

#endif
