/* The end of a munition, and the explosions of a frame. */
#ifndef JOLON_COLLIDER_RESPONSE_EXPLOSION_H
#define JOLON_COLLIDER_RESPONSE_EXPLOSION_H

#include "collider/response/response_context.h"
#include "world/maths/maths.h"

/* A charge that explodes in this frame. */
struct charge {
    struct vec3 point;
    double time; /* 0..1 */
    double explosive_kg;
    uint32_t owner_slot, owner_id; /* its shooter; 0: none */
    uint32_t row;                  /* that explodes and does not push itself; SLOT_NONE: a round */
};

/* Charges that have not exploded yet. An explosion that destroys a body with explosive adds one.
 * The collider's own memory. */
struct charges {
    struct charge *charge;
    uint32_t count, capacity;
    struct pair_list near; /* the bodies within a radius */
    uint32_t *pushed;      /* [capacity] the rows that explosions of one time push */
    uint64_t *is_pushed;   /* [capacity / 64] a bit for each of these */
    uint32_t pushed_count;
};

/* Returns 0, or -1 with errno ENOMEM. */
int charges_init(struct charges *charges, const struct world *world);
void charges_free(struct charges *charges);

/* Explodes the munition where it is; struck is a contact's second side. normal: unit, from the
 * munition to what it strikes; of ground and air it does not count. */
void explosion_munition(struct response_context *context, uint32_t row, uint32_t struck,
                        struct vec3 normal, double time);

/* Adds a charge, which explodes in the next explosion_all(). */
void explosion_charge(struct response_context *context, const struct charge *charge);
void explosion_all(struct response_context *context);

#endif
