/* A search for each body in walls, and for each couple of bodies. */
#include "collider/resting/parting_ways.h"

#include "collider/geometry/level_exit.h"
#include "collider/resting/ground_placement.h"
#include "collider/resting/resting.h"
#include "world/params.h"
#include "world/world.h"

/* Hulls that overlap less do not part by a way: contacts that bear loads may do so [m]. */
#define SHALLOW_M 1e-3

/* Bodies that are kept where they are try a way along the ground in one of so many frames: the
 * guard keeps many bodies of a crowd from moving in a frame, of whom most can go a level way in
 * another. */
#define ALONG_GROUND_FRAMES 8u

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
    level_exit_begin(&resting->exit, (struct exit_slope){0.0, 0.0});
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

static double way_from_body(struct resting *resting, const struct response_context *context,
                            const struct pair *pair, const struct resting_gap *gap,
                            struct vec3 *normal)
{
    struct free_turn turn_a, turn_b;
    const struct swept_body a = body_motion_body(context->motion, pair->a, &turn_a);
    const struct swept_body b = body_motion_side(context->motion, pair->b, &turn_b);
    struct exit_slope slope = {0.0, 0.0};
    if (gap->along_ground)
        slope = ground_placement_slope(context, pair->a, pair->b);
    return level_exit_of(&resting->exit, slope, &a, &b, normal);
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

/* Lets a pair part by a way. Returns false if it has none, or a pair that is not deep needs none.
 */
static bool go(struct resting_gap *gap, double way, struct vec3 normal)
{
    if (way == INFINITY || (way < RESTING_PARTS_M && !is_deep(gap)))
        return false;
    gap->gap[0].normal = normal;
    gap->gap[0].gap_m = -way;
    gap->capsules = false;
    return true;
}

/* Sets the way of a pair of bodies: a level one, or now and then along the ground if the guard kept
 * them where they were a frame ago. On a slope bodies rise and sink as they go, so that a level way
 * may lead them deeper into each other. Others may push those that overlap more than each other
 * along the way: their hulls that are near bound them too. Bodies of a crowd have no ways while it
 * spreads, nor as long as they part as capsules. */
static void leave_body(struct resting *resting, const struct response_context *context,
                       uint32_t index)
{
    const struct pair *pair = &resting->groups.pair[index];
    struct resting_gap *gap = &resting->gap[index];
    struct vec3 normal = {0.0, 0.0, 0.0};
    bool alone = resting->leaving[pair->a] == 1 && resting->leaving[pair->b] == 1;
    if (!alone && (!is_deep(gap) || gap->capsules || gap->spreads))
        return;
    gap->along_ground = gap->known && gap->known->flags & PERSISTENT_CONTACT_HOLDS &&
                        context->next->head->tick % ALONG_GROUND_FRAMES == 0;
    double way = way_from_body(resting, context, pair, gap, &normal);
    if (!go(gap, way, normal))
        return;
    gap->count = alone ? 1 : gap->count;
    context->contacts->known[gap->pair].way_m = way;
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
        if (go(gap, way, normal))
            gap->count = 1;
        gap->went = true;
    }
}

void parting_ways_find(struct resting *resting, struct response_context *context)
{
    bool any = false;
    for (uint32_t i = 0; i < resting->groups.count; i++) {
        resting->gap[i].leaves = needs_way(&resting->gap[i]);
        resting->gap[i].went = resting->gap[i].along_ground = false;
        any |= resting->gap[i].leaves;
    }
    if (!any)
        return;
    count_pairs(resting, 1);
    for (uint32_t i = 0; i < resting->groups.count; i++) {
        const struct pair *pair = &resting->groups.pair[i];
        if (!resting->gap[i].leaves || resting->gap[i].went)
            continue;
        if (pair->b & PAIR_FIXED)
            leave_walls(resting, context, i);
        else
            leave_body(resting, context, i);
    }
    count_pairs(resting, -1);
}
