/* Bodies by row, and a list of the rows. */
#include "collider/resting/begun_bodies.h"

#include "collider/motion/pair_filter.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

int begun_bodies_init(struct begun_bodies *bodies, const struct world *world)
{
    uint32_t rows = world->params->capacity;
    *bodies = (struct begun_bodies){.body = reserve_take(rows, sizeof *bodies->body),
                                    .known = calloc(rows, sizeof *bodies->known),
                                    .row = reserve_take(rows, sizeof *bodies->row)};
    if (bodies->body && bodies->known && bodies->row)
        return 0;
    begun_bodies_free(bodies);
    errno = ENOMEM;
    return -1;
}

void begun_bodies_free(struct begun_bodies *bodies)
{
    reserve_free(bodies->body);
    free(bodies->known);
    reserve_free(bodies->row);
    *bodies = (struct begun_bodies){0};
}

void begun_bodies_find(struct begun_bodies *bodies, struct body_motion *motion, uint32_t row)
{
    struct begun_body *body = &bodies->body[row];
    if (bodies->known[row])
        return;
    body_motion_note_poses(motion, row);
    body->body = body_motion_body(motion, row, &body->turn);
    body->began = level_gap_turn(&body->body, 0.0);
    body->rate = rotation_rate(body->body.from, body->body.to);
    bodies->known[row] = 1;
    bodies->row[bodies->count++] = row;
}

void begun_bodies_forget(struct begun_bodies *bodies)
{
    for (uint32_t i = 0; i < bodies->count; i++)
        bodies->known[bodies->row[i]] = 0;
    bodies->count = 0;
}

const struct begun_body *begun_bodies_side(const struct begun_bodies *bodies,
                                           const struct body_motion *motion, uint32_t side,
                                           struct begun_body *room)
{
    if (!(side & PAIR_FIXED))
        return &bodies->body[side];
    *room = (struct begun_body){.body = body_motion_fixed(motion->world, side & ~PAIR_FIXED)};
    room->began = level_gap_turn(&room->body, 0.0);
    return room;
}
