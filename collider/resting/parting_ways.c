/* A search for each body in walls, and for each couple of bodies. */
#include "collider/resting/parting_ways.h"

#include "collider/geometry/level_exit.h"
#include "collider/resting/resting.h"
#include "world/params.h"
#include "world/world.h"

/* Hulls that overlap less do not part by a way: contacts that bear loads may do so [m]. */
#define SHALLOW_M 1e-3

/* Walls are looked for as far as the way leads, so often at most. */
#define LOOKS_MOST 4

static bool is_deep(const struct resting_gap *gap)
{
    return gap->count > 0 && gap->gap[0].gap_m <= -RESTING_PARTS_M;
}

/* Returns true if the normals of the hulls cannot say where the way leads: the pair is deep, or
 * several of its hulls overlap, so that one way may lead into another hull. */
static bool needs_way(const struct resting_gap *gap)
{
    return is_deep(gap) || (gap->count > 1 && gap->gap[1].gap_m <= -SHALLOW_M);
}

/* Adds all walls near the row. Those that it does not overlap bar its way. */
static void add_walls(struct resting *resting, struct response_context *context, uint32_t row)
{
    const struct contact_queue *contacts = context->contacts;
    struct free_turn turn_a, turn_b;
    const struct swept_body body = body_motion_body(context->motion, row, &turn_a);
    level_exit_begin(&resting->exit);
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        const struct pair *pair = &contacts->pair[contacts->link[link - 1].pair];
        if (!(pair->b & PAIR_FIXED) || !contact_groups_is_wall(context, pair->b & ~PAIR_FIXED))
            continue;
        const struct swept_body wall = body_motion_side(context->motion, pair->b, &turn_b);
        bool bars = time_of_impact_gap(&body, &wall, body.path.since) > 0.0;
        level_exit_add(&resting->exit, &body, &wall, bars);
    }
}

/* Returns the length of the row's way out of all walls that it overlaps [m]. */
static double way_from_walls(struct resting *resting, struct response_context *context,
                             uint32_t row, struct vec3 *normal)
{
    double way = 0.0, seen = -1.0;
    for (int look = 0; look < LOOKS_MOST && way > seen && way < INFINITY; look++) {
        seen = way;
        contact_queue_look_wider(context->contacts, &context->input, row, way);
        add_walls(resting, context, row);
        way = level_exit_find(&resting->exit, true, normal);
    }
    return way < INFINITY ? way : level_exit_find(&resting->exit, false, normal);
}

static double way_from_body(struct resting *resting, struct response_context *context,
                            const struct pair *pair, struct vec3 *normal)
{
    struct free_turn turn_a, turn_b;
    const struct swept_body a = body_motion_body(context->motion, pair->a, &turn_a);
    const struct swept_body b = body_motion_side(context->motion, pair->b, &turn_b);
    level_exit_begin(&resting->exit);
    level_exit_add(&resting->exit, &a, &b, false);
    return level_exit_find(&resting->exit, false, normal);
}

/* Counts for each row the pairs that need a way. */
static void count_pairs(struct resting *resting, int change)
{
    for (uint32_t i = 0; i < resting->groups.count; i++) {
        const struct pair *pair = &resting->groups.pair[i];
        if (!resting->gap[i].leaves)
            continue;
        resting->leaving[pair->a] += (uint32_t)change;
        if (!(pair->b & PAIR_FIXED))
            resting->leaving[pair->b] += (uint32_t)change;
    }
}

static void go(struct resting_gap *gap, double way, struct vec3 normal)
{
    if (way == INFINITY || (way < RESTING_PARTS_M && !is_deep(gap)))
        return;
    gap->gap[0].normal = normal;
    gap->gap[0].gap_m = -way;
    gap->count = 1;
}

/* Sets the ways of a row out of its walls, of which pair first is one. */
static void leave_walls(struct resting *resting, struct response_context *context, uint32_t first)
{
    uint32_t row = resting->groups.pair[first].a;
    struct vec3 normal = {0.0, 0.0, 0.0};
    double way = way_from_walls(resting, context, row, &normal);
    for (uint32_t i = first; i < resting->groups.count; i++) {
        const struct pair *pair = &resting->groups.pair[i];
        struct resting_gap *gap = &resting->gap[i];
        if (pair->a != row || !(pair->b & PAIR_FIXED) || gap->count == 0 ||
            gap->gap[0].gap_m >= 0.0)
            continue;
        go(gap, way, normal);
        gap->went = true;
    }
}

void parting_ways_find(struct resting *resting, struct response_context *context)
{
    bool any = false;
    for (uint32_t i = 0; i < resting->groups.count; i++) {
        resting->gap[i].leaves = needs_way(&resting->gap[i]);
        resting->gap[i].went = false;
        any |= resting->gap[i].leaves;
    }
    if (!any)
        return;
    count_pairs(resting, 1);
    for (uint32_t i = 0; i < resting->groups.count; i++) {
        const struct pair *pair = &resting->groups.pair[i];
        struct vec3 normal = {0.0, 0.0, 0.0};
        if (!resting->gap[i].leaves || resting->gap[i].went)
            continue;
        if (pair->b & PAIR_FIXED)
            leave_walls(resting, context, i);
        else if (resting->leaving[pair->a] == 1 && resting->leaving[pair->b] == 1)
            go(&resting->gap[i], way_from_body(resting, context, pair, &normal), normal);
    }
    count_pairs(resting, -1);
}
