/* How bodies lie when the frame begins. A body has several contacts, so this is found once for all
 * of its pairs. The collider's own memory. */
#ifndef JOLON_COLLIDER_RESTING_BEGUN_BODIES_H
#define JOLON_COLLIDER_RESTING_BEGUN_BODIES_H

#include "collider/geometry/level_gap.h"
#include "collider/motion/body_motion.h"
#include "collider/resting/deep_pair.h"

struct world;
struct thread_pool;

struct begun_body {
    struct swept_body body; /* on its path */
    struct free_turn turn;  /* what body.turn points to */
    struct mat3 began;      /* its rotation when the frame begins */
    double rate;            /* rotation_rate() of body.from and body.to */
    struct capsule capsule; /* none of a fixed object */
};

/* All that a row's body follows from. */
struct begun_from {
    struct path path;
    double angle[6]; /* heading, pitch and roll, when the frame begins and where the mover has it */
    double spin[3];  /* when the frame begins */
    float turret, gun;
    uint32_t id;
    uint16_t kind;
    uint16_t known; /* 1: a body has been found from it */
};

/* A row has a place for its body from the frame in which it is listed to the first one in which it
 * is not. Few rows of a large world are, and a place for each would touch pages of memory for each.
 */
struct begun_bodies {
    struct begun_body *body; /* [capacity of the world] by place */
    struct begun_from *from; /* [capacity of the world] by place, of the body that was found last */
    uint32_t *place;         /* [capacity of the world] place + 1, 0: the row has none */
    uint32_t *vacant;        /* places below `places` that no row has */
    uint32_t vacant_count, places;
    /* [capacity of the world] how often a row's body has been another one than before: what was
     * measured of a body with the same number is true of it. */
    uint64_t *version;
    uint8_t *known;   /* [capacity of the world] 1: the row is listed in this frame */
    uint32_t *row;    /* the rows that are */
    uint32_t *before; /* those that were in the frame before */
    uint32_t before_count;
    uint32_t count, found; /* rows, and those of which the body has been found */
};

/* Returns 0, or -1 with errno ENOMEM. */
int begun_bodies_init(struct begun_bodies *bodies, const struct world *world);
void begun_bodies_free(struct begun_bodies *bodies);

/* Lists a row whose body has to be found, unless it is known. One thread. */
void begun_bodies_list(struct begun_bodies *bodies, uint32_t row);

/* Finds the bodies of the listed rows on their present paths, on all workers (NULL: one thread). */
void begun_bodies_find(struct begun_bodies *bodies, const struct response_context *context,
                       struct thread_pool *workers);

/* Forgets which rows are listed: paths change, or the frame ends. One thread. */
void begun_bodies_forget(struct begun_bodies *bodies);

/* Returns the body of a listed row. Any thread. */
static inline const struct begun_body *begun_bodies_row(const struct begun_bodies *bodies,
                                                        uint32_t row)
{
    return &bodies->body[bodies->place[row] - 1];
}

/* Returns one side of a pair: a row that has been found, or a fixed object with PAIR_FIXED, which
 * is made in room; a row needs none (NULL). Any thread. */
const struct begun_body *begun_bodies_side(const struct begun_bodies *bodies,
                                           const struct body_motion *motion, uint32_t side,
                                           struct begun_body *room);

#endif
