/* How the bodies move within the frame: each row's way, and how it turns along it. Rows turn from
 * the committed pose to the mover's until an answer to a contact gives them another way. The
 * collider's own memory; one thread changes it, any number may read between changes. */
#ifndef JOLON_COLLIDER_MOTION_H
#define JOLON_COLLIDER_MOTION_H

#include "collider/advance.h"
#include "world/world.h"

#include <stdint.h>

/* Turned at path.since and at 1. */
struct turning {
    struct quat from, to;
    double driven_rps; /* about the vertical, beside the row's own spin: its driver's, its tyres' */
};

struct motion {
    const struct world *world;
    const struct state *committed;
    const struct state *next;
    struct path *path;       /* [capacity] of rows whose way is drawn */
    uint8_t *drawn;          /* [capacity] 1: it is */
    struct turning *changed; /* turnings that answers gave */
    uint32_t changes;
    uint32_t *change; /* [capacity] index + 1 into changed; 0: turns as the mover has it */
    uint32_t *row;    /* [changes] whose it is */
};

/* 0, or -1 with errno ENOMEM. */
int motion_init(struct motion *motion, const struct world *world);
void motion_free(struct motion *motion);

/* Begins a frame: no way is drawn. */
void motion_begin(struct motion *motion, const struct state *committed, const struct state *next);

/* Draws the row's way: from where the committed world has it to where next has it. One that is new
 * this frame has not moved yet. Rows may be taken by any thread. Few rows come near anything: a way
 * is drawn before anybody asks for it and before next's row changes, and most never are. */
void motion_take(struct motion *motion, uint32_t row);

/* The same way, not kept. */
struct path motion_way(const struct motion *motion, uint32_t row);

/* Sees to it that the row's way is drawn. */
static inline void motion_draw(struct motion *motion, uint32_t row)
{
    if (!motion->drawn[row])
        motion_take(motion, row);
}

/* Does the row hold the same entity as in the committed frame? */
static inline bool motion_old(const struct motion *motion, uint32_t row)
{
    return row < motion->committed->head->used &&
           motion->committed->entities.id[row] == motion->next->entities.id[row];
}

/* Has the mover turned the row? */
static inline bool motion_old_turns(const struct motion *motion, uint32_t row)
{
    const struct entities *w = &motion->committed->entities, *n = &motion->next->entities;
    return motion_old(motion, row) &&
           (w->heading[row] != n->heading[row] || w->pitch[row] != n->pitch[row] ||
            w->roll[row] != n->roll[row]);
}

/* Does a row whose way has no length move, since its shape turns? */
static inline bool motion_turns(const struct motion *motion, uint32_t row)
{
    return motion->world->params->collision.shape == SHAPE_MODEL && motion_old_turns(motion, row);
}

struct turning motion_turning(const struct motion *motion, uint32_t row);

/* How the row is turned at a time in [path.since, 1]. */
struct quat motion_turned(const struct motion *motion, uint32_t row, double time);

/* Gives the row another turning, with its path. */
void motion_change(struct motion *motion, uint32_t row, const struct path *path,
                   const struct turning *turning);

/* The row, and a fixed object, as the narrow phase takes them. */
struct swept_body motion_body(const struct motion *motion, uint32_t row);
struct swept_body motion_fixed(const struct world *world, uint32_t object);

#endif
