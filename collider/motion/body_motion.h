/* How the bodies move within the frame: each row's way, and how it turns along it. Rows turn from
 * the committed pose to the mover's until an answer to a contact gives them another way. The
 * collider's own memory; one thread changes it, any number may read between changes. */
#ifndef JOLON_COLLIDER_MOTION_BODY_MOTION_H
#define JOLON_COLLIDER_MOTION_BODY_MOTION_H

#include "collider/geometry/time_of_impact.h"
#include "world/entity/entity.h"
#include "world/maths/rotation.h"
#include "world/state.h"

#include <stdint.h>

struct world;

/* Turned at path.since and at 1. */
struct rotation_path {
    struct quat from, to;
    double driven_rps; /* about the vertical, beside the row's own spin: its driver's, its tyres' */
};

struct body_motion {
    const struct world *world;
    const struct state *committed;
    const struct state *next;
    bool models;                   /* bodies collide by their models, not as spheres */
    struct path *path;             /* [capacity] of rows whose way is drawn */
    uint8_t *drawn;                /* [capacity] 1: it is */
    struct rotation_path *changed; /* turnings that answers gave */
    uint32_t changes;
    uint32_t *change; /* [capacity] index + 1 into changed; 0: turns as the mover has it */
    uint32_t *row;    /* [changes] whose it is */
};

/* 0, or -1 with errno ENOMEM. */
int body_motion_init(struct body_motion *motion, const struct world *world);
void body_motion_free(struct body_motion *motion);

/* Begins a frame: no way is drawn. */
void body_motion_begin(struct body_motion *motion, const struct state *committed,
                       const struct state *next);

/* Draws the row's way: from where the committed world has it to where next has it. One that is new
 * this frame has not moved yet. Rows may be taken by any thread. Few rows come near anything: a way
 * is drawn before anybody asks for it and before next's row changes, and most never are. */
void body_motion_take(struct body_motion *motion, uint32_t row);

/* The same way, not kept. */
struct path body_motion_way(const struct body_motion *motion, uint32_t row);

/* Sees to it that the row's way is drawn. */
static inline void body_motion_draw(struct body_motion *motion, uint32_t row)
{
    if (!motion->drawn[row])
        body_motion_take(motion, row);
}

/* Does the row hold the same entity as in the committed frame? */
static inline bool body_motion_old(const struct body_motion *motion, uint32_t row)
{
    return row < motion->committed->head->used &&
           motion->committed->entities.id[row] == motion->next->entities.id[row];
}

/* Has the mover turned the row? */
static inline bool body_motion_old_turns(const struct body_motion *motion, uint32_t row)
{
    const struct entities *w = &motion->committed->entities, *n = &motion->next->entities;
    return body_motion_old(motion, row) &&
           (w->heading[row] != n->heading[row] || w->pitch[row] != n->pitch[row] ||
            w->roll[row] != n->roll[row]);
}

/* Does a row whose way has no length move, since its shape turns? */
static inline bool body_motion_turns(const struct body_motion *motion, uint32_t row)
{
    return motion->models && body_motion_old_turns(motion, row);
}

struct rotation_path body_motion_turning(const struct body_motion *motion, uint32_t row);

/* How the row is turned at a time in [path.since, 1]. */
struct quat body_motion_turned(const struct body_motion *motion, uint32_t row, double time);

/* Gives the row another turning, with its path. */
void body_motion_change(struct body_motion *motion, uint32_t row, const struct path *path,
                        const struct rotation_path *rotation);

/* The row, and a fixed object, as the narrow phase takes them. */
struct swept_body body_motion_body(const struct body_motion *motion, uint32_t row);
struct swept_body body_motion_fixed(const struct world *world, uint32_t object);

#endif
