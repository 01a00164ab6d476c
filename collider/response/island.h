/* Impulses: all contacts of one moment, grouped into islands of bodies that touch each other. */
#ifndef JOLON_COLLIDER_RESPONSE_ISLAND_H
#define JOLON_COLLIDER_RESPONSE_ISLAND_H

#include "collider/geometry/level_gap.h"
#include "collider/response/response.h"
#include "collider/solver/contact_solver.h"
#include "collider/solver/contact_spring.h"

/* A contact that is solved by impulses. */
struct island_contact {
    struct contact contact;
    struct impact impact;
    struct report report;
    struct outcome outcome;
    struct contact_spring_impact spring; /* for the response "spring" */
    bool leans;
    uint32_t body_a, body_b; /* index into island.body; BODY_FIXED for a fixed object */
    uint32_t next;           /* index into met + 1 of the same group, 0 ends */
};

#define BODY_FIXED UINT32_MAX

/* An island takes so many contacts that last. */
#define ISLAND_RESTING_MOST 64u

/* A row with contacts in this moment. */
struct island_body {
    uint32_t row;
    uint32_t parent;      /* union-find */
    uint32_t first, last; /* of a root: the group's contacts, index into met + 1 */
    uint32_t local;       /* index among the bodies being solved, UINT32_MAX: none yet */
    bool stays;           /* its pair may not meet again in this frame: it stays where it is */
    bool unmoved;         /* the contacts have not changed its motion */
    bool grounded;
    bool flies;        /* an aircraft, or the wreck of one */
    bool follows_spin; /* it goes on by its velocity and spin alone, without its pilot's steering */
    double fallen_mps; /* what it takes at once of the fall in the rest of the frame */
    struct vec3 arm;   /* [m, world] from the position to the centre of mass */
    struct vec3 shift; /* [m] out of the bodies that it overlaps */
};

/* The collider's own memory, kept from frame to frame. */
struct island {
    struct island_contact *met;
    uint32_t met_count, met_capacity; /* one for a pair, two for a contact that lasts */
    struct island_body *body;
    uint32_t *row; /* [bodies] of each body; while paths change, of those that have changed */
    uint32_t bodies;
    uint32_t *body_of; /* [capacity of the world] body + 1 for a row in this moment, else 0 */
    /* A fixed object is a new body in each of its contacts. */
    struct solver_body *solve;      /* [capacity of the world + met_capacity] */
    uint32_t *solve_of;             /* body of each */
    struct solver_contact *contact; /* [met_capacity] */
    struct vec3 *shift;             /* [capacity of the world] of each body of solve */
    struct pair_list near;          /* contacts that last, of the island's bodies */
    struct level_gap *gap; /* [ISLAND_RESTING_MOST] of these contacts; points: 0 for none */
    uint32_t rows;         /* capacity of the world */
};

/* 0, or -1 with errno ENOMEM. */
int island_init(struct island *island, const struct world *world);
void island_free(struct island *island);

/* Responds to this contact, which was just taken from the queue, and to all others of the same
 * moment that are solved by impulses. */
void island_answer(struct response_context *context, const struct contact *contact);

#endif
