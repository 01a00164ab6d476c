/* Impulses: all contacts of one moment, in islands of bodies that touch each other. */
#ifndef JOLON_COLLIDER_RESPONSE_ISLAND_H
#define JOLON_COLLIDER_RESPONSE_ISLAND_H

#include "collider/response/response.h"
#include "collider/response/contact_solver.h"
#include "collider/response/contact_spring.h"

/* A contact that impulses answer. */
struct island_contact {
    struct contact contact;
    struct impact impact;
    struct report report;
    struct outcome outcome;
    struct contact_spring_impact spring; /* of the response "spring" */
    bool leans;
    uint32_t body_a, body_b; /* index into island.body; BODY_FIXED for a fixed object */
    uint32_t next;           /* index into met + 1 of the same group, 0 ends */
};

#define BODY_FIXED UINT32_MAX

/* A row that takes part in this moment. */
struct island_body {
    uint32_t row;
    uint32_t parent;      /* union-find: of the group */
    uint32_t first, last; /* of a group's root: index into met + 1 */
    uint32_t local;       /* index among the bodies being solved, UINT32_MAX: not yet */
    bool stays;           /* its pair may not meet again: it waits for the next frame */
    bool grounded;
    struct vec3 arm;   /* [m, world] from the position to the centre of mass */
    struct vec3 shift; /* [m] back out of what it overlaps */
};

/* The collider's own memory, kept from frame to frame. */
struct island {
    struct island_contact *met;
    uint32_t met_count, met_capacity; /* each pair meets once in a moment */
    struct island_body *body;
    uint32_t *row; /* [bodies] theirs */
    uint32_t bodies;
    uint32_t *body_of; /* [capacity of the world] body + 1 of a row in this moment, else 0 */
    /* A fixed object is a body of its own each time. */
    struct solver_body *solve;      /* [capacity of the world + met_capacity] */
    uint32_t *solve_of;             /* body of each */
    struct solver_contact *contact; /* [met_capacity] */
    uint32_t rows;                  /* capacity of the world */
};

/* 0, or -1 with errno ENOMEM. */
int island_init(struct island *island, const struct world *world);
void island_free(struct island *island);

/* Answers this contact, which was just taken from the queue, and with it those of the same moment
 * that impulses answer. */
void island_answer(struct response_context *respond, const struct contact *contact);

#endif
