/* The guard at the end of a frame: no two bodies that the ground holds, or that rest on others, end
 * it deeper in each other than they began it. Bodies that would are sent back by half of their
 * motion, three times, then a vehicle that drives by its turn alone, and at last to where they
 * stood when the frame began. Pure; one caller, and its workers. */
#ifndef JOLON_COLLIDER_GUARD_END_GUARD_H
#define JOLON_COLLIDER_GUARD_END_GUARD_H

#include "collider/guard/drift_guard.h"
#include "collider/guard/tangled_wrecks.h"
#include "collider/resting/free_bodies.h"
#include "collider/resting/resting.h"

struct thread_pool;

struct placed_body;

/* A pair that is measured in a round. */
struct guard_pair {
    uint32_t pair; /* index into contacts->pair */
    bool deeper;   /* it would end the frame deeper than it began it */
};

/* The collider's own memory. */
struct end_guard {
    struct thread_pool *workers;
    struct guard_pair *pair; /* of this round */
    uint32_t pair_count, pair_capacity;
    struct placed_body *stands; /* [capacity of the world] at the frame's end */
    uint8_t *posed;             /* [capacity of the world] 1: it is known how the row stands */
    uint32_t *posed_row;        /* the rows of which it is */
    uint32_t posed_count;
    const struct resting *resting;
    const struct vec3 *drift; /* free_bodies.h */
    uint32_t *row;            /* rows to look at in this round */
    uint32_t count;
    uint32_t moved; /* the first ones, which the collider has moved: in a later round all */
    uint32_t *back; /* rows that go back in this round */
    uint32_t back_count;
    uint32_t *touched; /* rows that have gone back in this frame */
    uint32_t touched_count;
    uint8_t *listed;    /* [capacity of the world] 1: in row */
    uint8_t *marked;    /* [capacity of the world] 1: in back */
    uint8_t *sent_back; /* [capacity of the world] how often a row has gone back in this frame */
    uint8_t *drawn; /* [capacity of the world] 1 + how often it had gone back, if it had made way
                       and was then drawn back, else 0 */
    struct drift_guard drifting;
    struct tangled_wrecks tangled;
    struct level_exit exit; /* a search for ways out of bodies */
};

/* Returns 0, or -1 with errno ENOMEM. workers may be NULL and stays the caller's. */
int end_guard_init(struct end_guard *guard, const struct world *world, struct thread_pool *workers);
void end_guard_free(struct end_guard *guard);

/* Sets the bodies whose motion collisions have changed on the ground, and sends back those that
 * ended in others. Afterwards nothing of the frame moves any more. */
void end_guard_run(struct end_guard *guard, const struct resting *resting,
                   const struct free_bodies *free, struct response_context *context);

#endif
