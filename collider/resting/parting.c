/* Steps of bodies within the bounds of their points. */
#include "collider/resting/parting.h"

#include "collider/resting/parting_wishes.h"
#include "collider/resting/resting.h"
#include "world/runtime/reserve.h"
#include "world/runtime/work_done.h"
#include "world/world.h"

#include <errno.h>

#define SWEEPS       30 /* over the bodies that part, forwards and backwards in turn */
#define BACK_SWEEPS  10 /* over those that make way, in the same manner */
#define SLIDES       10 /* rounds over a body's bounds that turn its motion along them, at most */
#define BACKS_MOST   4  /* so often a body goes half as far, the last time not at all */
#define ROUNDING_MPS 1e-9

int parting_init(struct parting *parting, uint64_t bodies, uint64_t points)
{
    *parting = (struct parting){.body_capacity = bodies, .bound_capacity = 2 * points};
    parting->body = reserve_take(bodies, sizeof *parting->body);
    parting->bound = reserve_take(2 * points, sizeof *parting->bound);
    parting->wishing = reserve_take(points, sizeof *parting->wishing);
    if (parting->body && parting->bound && parting->wishing)
        return 0;
    parting_free(parting);
    errno = ENOMEM;
    return -1;
}

void parting_free(struct parting *parting)
{
    reserve_free(parting->body);
    reserve_free(parting->bound);
    reserve_free(parting->wishing);
    *parting = (struct parting){0};
}

/* Makes room for the frame's bodies and points. What the arrays held is lost. */
static void make_room(struct parting *parting, const struct parting_input *input)
{
    if (input->bodies > parting->body_capacity) {
        parting->body_capacity = 2 * (uint64_t)input->bodies;
        parting->body =
            reserve_grow(parting->body, 0, parting->body_capacity, sizeof *parting->body);
    }
    if (2 * (uint64_t)input->points > parting->bound_capacity) {
        parting->bound_capacity = 4 * (uint64_t)input->points;
        parting->bound =
            reserve_grow(parting->bound, 0, parting->bound_capacity, sizeof *parting->bound);
        parting->wishing = reserve_grow(parting->wishing, 0, parting->bound_capacity / 2,
                                        sizeof *parting->wishing);
    }
}

/* --- bounds ------------------------------------------------------------------------------------*/

/* Returns by how much the speed along the point's normal may fall without bringing the pair deeper
 * into each other than it is [m/s]. An overlap along another normal, which is less deep, may become
 * as deep as the deepest. */
static double slack(const struct parting_input *input, const struct level_contact *point,
                    double deepest_mps)
{
    double along = -level_solver_closing(input->body, point);
    double least = point->apart_mps > 0.0 ? 0.0 : point->least_mps;
    least -= (deepest_mps - point->apart_mps) / PARTING_SHARE;
    return maths_max(0.0, along - least);
}

static void count_bounds(struct parting *parting, const struct parting_input *input)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < input->points; i++) {
        parting->body[input->point[i].a].end++;
        parting->body[input->point[i].b].end++;
    }
    for (uint32_t i = 0; i < input->bodies; i++) {
        uint32_t count = parting->body[i].end;
        parting->body[i].first = parting->body[i].end = first;
        first += count;
    }
}

static void add_bound(struct parting *parting, uint32_t body, struct parting_bound bound)
{
    parting->bound[parting->body[body].end++] = bound;
}

static void add_bounds(struct parting *parting, const struct parting_input *input)
{
    for (uint32_t p = 0; p < input->pairs; p++) {
        const struct resting_pair *pair = &input->pair[p];
        double deepest = parting_wishes_speed(input, pair);
        if (pair->gap_m <= -RESTING_PARTS_M && parting->body[input->point[pair->first].a].spreads)
            continue;
        for (uint32_t i = pair->first; i < pair->first + pair->count; i++) {
            const struct level_contact *c = &input->point[i];
            double free_mps = slack(input, c, deepest);
            add_bound(parting, c->a,
                      (struct parting_bound){c->b, -c->normal_x, -c->normal_z, free_mps});
            add_bound(parting, c->b,
                      (struct parting_bound){c->a, c->normal_x, c->normal_z, free_mps});
        }
    }
}

/* --- steps -------------------------------------------------------------------------------------*/

/* Returns the least speed that the bound asks for along its direction [m/s]. */
static double least_of(const struct parting_input *input, const struct parting_bound *bound)
{
    const struct level_motion *other = &input->body[bound->other].pushed;
    return bound->x * other->x + bound->z * other->z - bound->slack_mps;
}

/* Returns true if the body, as it goes now, passes one of its bounds. */
static bool is_out(const struct parting *parting, const struct parting_input *input, uint32_t index)
{
    const struct parting_body *body = &parting->body[index];
    const struct level_motion *now = &input->body[index].pushed;
    for (uint32_t i = body->first; i < body->end; i++) {
        const struct parting_bound *bound = &parting->bound[i];
        if (now->x * bound->x + now->z * bound->z < least_of(input, bound) - ROUNDING_MPS)
            return true;
    }
    return false;
}

/* Lets all go by their wishes at once, and then those that pass a bound by half of that, at last
 * not at all, until none does. A crowd that spreads cannot do so one by one. */
static void go_together(struct parting *parting, const struct parting_input *input)
{
    bool any = true;
    for (uint32_t i = 0; i < input->bodies; i++) {
        parting->body[i].backs = 0;
        if (parting->body[i].goes)
            input->body[i].pushed =
                (struct level_motion){parting->body[i].wish_x, parting->body[i].wish_z, 0.0};
    }
    while (any) {
        any = false;
        for (uint32_t i = 0; i < input->bodies; i++)
            parting->body[i].back = parting->body[i].goes && is_out(parting, input, i);
        for (uint32_t i = 0; i < input->bodies; i++) {
            struct level_motion *now = &input->body[i].pushed;
            if (!parting->body[i].back)
                continue;
            double keep = ++parting->body[i].backs < BACKS_MOST ? 0.5 : 0.0;
            now->x *= keep;
            now->z *= keep;
            any = true;
        }
        work_done();
    }
}

/* Returns the n-th body of a sweep: forwards and backwards in turn. */
static uint32_t in_turn(const struct parting_input *input, uint32_t sweep, uint32_t n)
{
    return sweep % 2 == 0 ? n : input->bodies - 1 - n;
}

/* Lets one body go as far towards a motion as its bounds allow: along them, and no further than to
 * the first. It stays within all of them. */
static void step(struct parting *parting, const struct parting_input *input, uint32_t index,
                 double x, double z)
{
    const struct parting_body *body = &parting->body[index];
    struct level_motion *now = &input->body[index].pushed;
    double share = 1.0;
    bool out = true;
    for (int round = 0; out && round < SLIDES; round++) {
        out = false;
        for (uint32_t i = body->first; i < body->end; i++) {
            const struct parting_bound *bound = &parting->bound[i];
            double off = least_of(input, bound) - x * bound->x - z * bound->z;
            if (off <= 0.0)
                continue;
            x += off * bound->x;
            z += off * bound->z;
            out = true;
        }
    }
    x -= now->x;
    z -= now->z;
    for (uint32_t i = body->first; i < body->end; i++) {
        const struct parting_bound *bound = &parting->bound[i];
        double closing = -(x * bound->x + z * bound->z);
        double room = now->x * bound->x + now->z * bound->z - least_of(input, bound);
        if (closing > 0.0 && closing * share > room + ROUNDING_MPS)
            share = maths_max(0.0, room) / closing;
    }
    now->x += share * x;
    now->z += share * z;
}

/* Recovers the shallow overlaps of groups in which nobody has to part. */
static void part_others(struct parting *parting, const struct parting_input *input)
{
    for (uint32_t i = 0; i < input->points; i++) {
        if (input->point[i].apart_mps > 0.0 && !parting_wishes_parts(parting, input->point[i].a)) {
            level_solver_part(input->lanes, input->body, input->bodies, input->point,
                              input->points);
            return;
        }
    }
}

/* Marks the bodies that are deep in nothing: they go only to make way for others. */
static void mark_those_that_make_way(struct parting *parting, const struct parting_input *input)
{
    for (uint32_t i = 0; i < input->bodies; i++)
        parting->body[i].makes_way = parting->body[i].goes && !parting->body[i].opens;
    for (uint32_t i = 0; i < input->pairs; i++) {
        const struct level_contact *point = &input->point[input->pair[i].first];
        if (input->pair[i].gap_m <= -RESTING_PARTS_M)
            parting->body[point->a].makes_way = parting->body[point->b].makes_way = false;
    }
}

/* Lets those that make way go back as far as their bounds allow: the body for which they would have
 * gone may not have come as far as it wished. */
static void draw_back(struct parting *parting, const struct parting_input *input)
{
    mark_those_that_make_way(parting, input);
    for (uint32_t sweep = 0; sweep < BACK_SWEEPS; sweep++) {
        for (uint32_t n = 0; n < input->bodies; n++) {
            uint32_t i = in_turn(input, sweep, n);
            if (parting->body[i].makes_way)
                step(parting, input, i, 0.0, 0.0);
        }
        work_done();
    }
}

/* Lets all bodies go by their wishes. */
static void go(struct parting *parting, const struct parting_input *input)
{
    go_together(parting, input);
    for (uint32_t sweep = 0; sweep < SWEEPS; sweep++) {
        for (uint32_t n = 0; n < input->bodies; n++) {
            uint32_t i = in_turn(input, sweep, n);
            if (parting->body[i].goes)
                step(parting, input, i, parting->body[i].wish_x, parting->body[i].wish_z);
        }
        work_done();
    }
}

void parting_run(struct parting *parting, const struct parting_input *input)
{
    make_room(parting, input);
    bool any = parting_wishes_group(parting, input);
    part_others(parting, input);
    if (!any) {
        for (uint32_t i = 0; i < input->bodies; i++)
            parting_wishes_limit(input, &input->body[i].pushed);
        return;
    }
    parting_wishes_find_locked(parting, input);
    parting_wishes_make(parting, input);
    count_bounds(parting, input);
    add_bounds(parting, input);
    go(parting, input);
    if (parting_wishes_hindered(parting, input)) {
        parting_wishes_make(parting, input);
        go(parting, input);
    }
    draw_back(parting, input);
}
