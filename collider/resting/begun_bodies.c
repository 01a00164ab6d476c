/* Bodies by row, and a list of the rows. */
#include "collider/resting/begun_bodies.h"

#include "collider/motion/pair_filter.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/thread_pool.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_A_PIECE 16u

int begun_bodies_init(struct begun_bodies *bodies, const struct world *world)
{
    uint32_t rows = world->params->capacity;
    *bodies = (struct begun_bodies){.body = reserve_take(rows, sizeof *bodies->body),
                                    .from = reserve_take(rows, sizeof *bodies->from),
                                    .place = calloc(rows, sizeof *bodies->place),
                                    .vacant = reserve_take(rows, sizeof *bodies->vacant),
                                    .version = calloc(rows, sizeof *bodies->version),
                                    .known = calloc(rows, sizeof *bodies->known),
                                    .row = reserve_take(rows, sizeof *bodies->row),
                                    .before = reserve_take(rows, sizeof *bodies->before)};
    if (bodies->body && bodies->from && bodies->place && bodies->vacant && bodies->version &&
        bodies->known && bodies->row && bodies->before)
        return 0;
    begun_bodies_free(bodies);
    errno = ENOMEM;
    return -1;
}

void begun_bodies_free(struct begun_bodies *bodies)
{
    reserve_free(bodies->body);
    reserve_free(bodies->from);
    free(bodies->place);
    reserve_free(bodies->vacant);
    free(bodies->version);
    free(bodies->known);
    reserve_free(bodies->row);
    reserve_free(bodies->before);
    *bodies = (struct begun_bodies){0};
}

/* Gives a row a place, of which nothing is known. */
static void give_place(struct begun_bodies *bodies, uint32_t row)
{
    uint32_t place =
        bodies->vacant_count > 0 ? bodies->vacant[--bodies->vacant_count] : bodies->places++;
    bodies->from[place].known = 0;
    bodies->place[row] = place + 1;
}

void begun_bodies_list(struct begun_bodies *bodies, uint32_t row)
{
    if (bodies->known[row])
        return;
    if (bodies->place[row] == 0)
        give_place(bodies, row);
    bodies->row[bodies->count++] = row;
    bodies->known[row] = 1;
}

struct job {
    struct begun_bodies *bodies;
    const struct response_context *context;
    uint32_t first; /* of the listed rows */
};

static struct begun_from from_of(const struct body_motion *motion, uint32_t row)
{
    const struct entities *w = body_motion_before(motion, row), *e = &motion->next->entities;
    return (struct begun_from){.path = motion->path[row],
                               .angle = {w->row[row].heading, w->row[row].pitch, w->row[row].roll,
                                         e->row[row].heading, e->row[row].pitch, e->row[row].roll},
                               .spin = {w->row[row].spin_x, w->row[row].spin_y, w->row[row].spin_z},
                               .turret = w->row[row].turret,
                               .gun = w->row[row].gun,
                               .id = e->row[row].id,
                               .kind = e->row[row].kind,
                               .known = 1};
}

/* Returns true if the row's body follows from the same as before, to the bit. */
static bool is_same(const struct begun_from *from, const struct begun_from *before)
{
    return memcmp((const unsigned char *)from, (const unsigned char *)before, sizeof *from) == 0;
}

static void find_body(const struct job *job, uint32_t row)
{
    struct body_motion *motion = job->context->motion;
    struct begun_body *body = &job->bodies->body[job->bodies->place[row] - 1];
    body_motion_note_poses(motion, row);
    body_motion_put(motion, row, &body->turn, &body->body);
    body->began = level_gap_turn(&body->body, 0.0);
    body->rate = rotation_rate(body->body.from, body->body.to);
    body->capsule = deep_pair_capsule(job->context, row);
}

static void find_some(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = context;
    (void)worker;
    for (uint32_t i = job->first + first; i < job->first + end; i++) {
        uint32_t row = job->bodies->row[i];
        struct begun_from *before = &job->bodies->from[job->bodies->place[row] - 1];
        const struct begun_from from = from_of(job->context->motion, row);
        if (is_same(&from, before))
            continue;
        find_body(job, row);
        job->bodies->version[row]++;
        *before = from;
    }
}

void begun_bodies_find(struct begun_bodies *bodies, const struct response_context *context,
                       struct thread_pool *workers)
{
    struct job job = {bodies, context, bodies->found};
    thread_pool_run(workers, find_some, &job, bodies->count - bodies->found, ROWS_A_PIECE);
    bodies->found = bodies->count;
}

void begun_bodies_forget(struct begun_bodies *bodies)
{
    uint32_t *before = bodies->before;
    for (uint32_t i = 0; i < bodies->before_count; i++) {
        if (bodies->known[before[i]])
            continue;
        bodies->vacant[bodies->vacant_count++] = bodies->place[before[i]] - 1;
        bodies->place[before[i]] = 0;
    }
    for (uint32_t i = 0; i < bodies->count; i++)
        bodies->known[bodies->row[i]] = 0;
    bodies->before = bodies->row;
    bodies->before_count = bodies->count;
    bodies->row = before;
    bodies->count = bodies->found = 0;
}

const struct begun_body *begun_bodies_side(const struct begun_bodies *bodies,
                                           const struct body_motion *motion, uint32_t side,
                                           struct begun_body *room)
{
    if (!(side & PAIR_FIXED))
        return begun_bodies_row(bodies, side);
    *room = (struct begun_body){.body = body_motion_fixed(motion->world, side & ~PAIR_FIXED)};
    room->began = level_gap_turn(&room->body, 0.0);
    return room;
}
