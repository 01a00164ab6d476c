/* Contacts that last of which one body is free: a wreck that lies on others, leans on a wall or
 * rolls, or a vehicle on its springs that is in the air. They are solved in all directions after
 * those of bodies that the ground holds (resting.h) and before impacts are searched.
 *
 * A wreck that touches only the ground is moved by the mover. A free wreck in a contact of the
 * table is moved by the collider, from its committed row on, with its weight and with its contacts
 * with the ground: what the mover did with it in the frame does not count. Pure; one thread. */
#ifndef JOLON_COLLIDER_RESTING_FREE_BODIES_H
#define JOLON_COLLIDER_RESTING_FREE_BODIES_H

#include "collider/resting/contact_groups.h"
#include "collider/resting/free_points.h"
#include "collider/resting/free_solver.h"
#include "world/entity/mass_properties.h"

/* A body of the solver, and what it is. */
struct free_side {
    uint32_t row;
    uint32_t points; /* 0: all its pairs are left to the search for impacts */
    bool pressed;    /* another body or a wall presses on it */
    bool is_free, wreck, piloted;
    struct mass_properties mass;
    struct quat turn;     /* when the frame begins */
    struct vec3 at;       /* [m, world] the position then */
    struct vec3 arm;      /* [m, world] from it to the centre of mass */
    struct vec3 fall;     /* [m/s] by its weight, part of the velocity */
    struct vec3 steering; /* [rad/s] a pilot's, which is no part of the spin */
    bool let_go;          /* the contacts have stopped the steering */
    uint32_t parent;      /* union-find of bodies that touch */
    double kg;            /* of a root: the mass of its bodies, if all are piloted */
    struct vec3 momentum; /* [N s] of a root: of its bodies */
    bool quick;           /* of a root: one of its bodies moves */
    bool due;             /* of a root: all have been slow for long enough */
};

/* Two bodies whose points are solved. */
struct free_pair {
    uint32_t pair;         /* index into contacts->pair */
    uint32_t first, count; /* its points */
    bool overlaps;
};

/* The collider's own memory, kept from frame to frame. */
struct free_bodies {
    struct contact_groups groups;
    struct free_body *body; /* [count] the first is what does not move */
    struct free_side *side; /* [count] */
    uint32_t count;
    struct free_contact *contact;
    uint32_t contacts, contact_capacity;
    struct free_pair *pair;
    uint32_t pairs, pair_capacity;
    uint32_t *body_of;  /* [capacity of the world] body, or 0 */
    uint8_t *owned;     /* [capacity of the world] 1: this frame's contacts move the row freely */
    struct vec3 *drift; /* [capacity of the world] the way that aircraft in contact, or that part,
                           go together [m] */
    uint32_t *drifting; /* rows that have a drift; some twice */
    uint32_t drifting_count;
    uint32_t
        *moved; /* rows whose motion the contacts determine, or that part in the air; some twice */
    uint32_t moved_count;
};

/* Returns 0, or -1 with errno ENOMEM. */
int free_bodies_init(struct free_bodies *bodies, const struct world *world);
void free_bodies_free(struct free_bodies *bodies);

/* Solves the contacts of the committed table of which one body is free, and gives the bodies their
 * motion. Those of a pair that close as fast as in an impact are left to the search for impacts.
 * Marks pairs like resting_solve(), which must have run. Lists the bodies in the air that are new
 * in this frame in groups.begun. */
void free_bodies_solve(struct free_bodies *bodies, struct response_context *context);

/* Lets a row go together with others in this frame. */
void free_bodies_drift(struct free_bodies *bodies, uint32_t row, struct vec3 drift);

/* Returns the body that stands for all that touch a body, directly or not. */
uint32_t free_bodies_root(struct free_bodies *bodies, uint32_t body);

#endif
