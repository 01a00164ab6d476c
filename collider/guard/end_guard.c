/* Rounds over lists of rows. A row that goes back is looked at again, in its new place. */
#include "collider/guard/end_guard.h"

#include "collider/geometry/level_gap.h"
#include "collider/motion/pair_filter.h"
#include "collider/resting/deep_pair.h"
#include "collider/resting/ground_placement.h"
#include "collider/resting/held_rest.h"
#include "collider/guard/send_back.h"
#include "collider/response/path_change.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/thread_pool.h"
#include "world/runtime/work_done.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

#define ROUNDING_M      1e-5 /* a depth up to this is none */
#define APART_M         1e-6 /* bodies that are farther apart than they can have come do not touch */
#define EXACT_M         1e-8 /* error of a depth: less is no deepening of a greater depth */
#define PAIRS_A_PIECE   8u   /* of few, most of which are near; of all pairs most are not */
#define PIECES          64u
#define ROWS_A_PIECE    16u
#define MOST_ROWS_PAIRS 8u /* up to so many pairs for each row that is looked at, most rows are */

/* A body at rest. */
struct placed_body {
    struct swept_body body;
    struct axis_side side; /* with the matrix of its rotation */
    struct vec3 moved;     /* [m] from where it stood when the frame began */
    double turned_m;       /* by rotation none of its points has moved farther since then */
    double way_m;          /* none of its points is farther than this from where its path ended */
    double sphere_m;       /* the radius of a body that collides as a sphere, else 0 */
};

int end_guard_init(struct end_guard *guard, const struct world *world, struct thread_pool *workers)
{
    uint32_t rows = world->params->capacity;
    *guard =
        (struct end_guard){.workers = workers, .pair_capacity = pair_filter_pairs_first(world)};
    guard->pair = reserve_take(guard->pair_capacity, sizeof *guard->pair);
    guard->stands = reserve_take(rows, sizeof *guard->stands);
    guard->posed = calloc(rows, sizeof *guard->posed);
    guard->posed_row = reserve_take(rows, sizeof *guard->posed_row);
    guard->row = reserve_take(rows, sizeof *guard->row);
    guard->back = reserve_take(rows, sizeof *guard->back);
    guard->touched = reserve_take(rows, sizeof *guard->touched);
    guard->listed = calloc(rows, sizeof *guard->listed);
    guard->marked = calloc(rows, sizeof *guard->marked);
    guard->sent_back = calloc(rows, sizeof *guard->sent_back);
    guard->drawn = calloc(rows, sizeof *guard->drawn);
    if (guard->pair && guard->stands && guard->posed && guard->posed_row && guard->row &&
        guard->back && guard->touched && guard->listed && guard->marked && guard->sent_back &&
        guard->drawn && drift_guard_init(&guard->drifting, world) == 0 &&
        tangled_wrecks_init(&guard->tangled, world) == 0 && level_exit_init(&guard->exit) == 0)
        return 0;
    end_guard_free(guard);
    errno = ENOMEM;
    return -1;
}

void end_guard_free(struct end_guard *guard)
{
    drift_guard_free(&guard->drifting);
    tangled_wrecks_free(&guard->tangled);
    level_exit_free(&guard->exit);
    reserve_free(guard->pair);
    reserve_free(guard->stands);
    free(guard->posed);
    reserve_free(guard->posed_row);
    reserve_free(guard->row);
    reserve_free(guard->back);
    reserve_free(guard->touched);
    free(guard->listed);
    free(guard->marked);
    free(guard->sent_back);
    free(guard->drawn);
    *guard = (struct end_guard){.count = 0};
}

/* --- poses -------------------------------------------------------------------------------------*/

/* Returns the radius of a body that collides as a sphere, else 0 [m]. */
static double sphere_of(const struct body_motion *motion, const struct entities *e, uint32_t side)
{
    const struct world *world = motion->world;
    if (motion->models)
        return 0.0;
    return side & PAIR_FIXED ? pair_filter_fixed_reach(world, &world->fixed[side & ~PAIR_FIXED])
                             : world->kinds[e->row[side].kind].radius_m;
}

static void stand(const struct body_motion *motion, const struct entities *e, uint32_t side,
                  struct placed_body *stands)
{
    if (side & PAIR_FIXED)
        stands->body = body_motion_fixed(motion->world, side & ~PAIR_FIXED);
    else
        body_motion_put_standing(motion, e, side, &stands->body);
    axis_side_set(&stands->side, &stands->body, 0.0, 0.0);
    stands->sphere_m = sphere_of(motion, e, side);
    stands->moved = (struct vec3){0.0, 0.0, 0.0};
    stands->turned_m = 0.0;
}

/* Finds out how the row stands at the frame's end, and how far it has come. The angle between two
 * poses is at most the sum of the differences of their three angles. */
static void stand_now(struct end_guard *guard, const struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    struct placed_body *stands = &guard->stands[row];
    body_motion_note_poses(context->motion, row);
    stand(context->motion, e, row, stands);
    stands->moved = vec3_sub(entities_position(e, row), entities_position(w, row));
    stands->turned_m =
        stands->body.bound_m * (fabs(maths_wrap_half(e->row[row].heading - w->row[row].heading)) +
                                fabs(maths_wrap_half(e->row[row].pitch - w->row[row].pitch)) +
                                fabs(maths_wrap_half(e->row[row].roll - w->row[row].roll)));
}

/* Returns true if the row stands where its swept path ends, and can only go back in its whole pose
 * from there. */
static bool goes_straight_back(const struct end_guard *guard,
                               const struct response_context *context, uint32_t row)
{
    struct vec3 drift = guard->drift[row];
    return context->next->entities.row[row].flags & ENTITY_FLAG_CHASSIS &&
           guard->sent_back[row] == 0 && context->motion->change[row] == 0 &&
           vec3_dot(drift, drift) == 0.0;
}

/* Lists a row of which it has to be found out how it stands at the frame's end. */
static void list_pose(struct end_guard *guard, uint32_t row)
{
    if (!guard->posed[row])
        guard->posed_row[guard->posed_count++] = row;
    guard->posed[row] = 1;
}

/* Finds out how a row stands at the frame's end. */
static void stand_at_end(struct end_guard *guard, const struct response_context *context,
                         uint32_t row)
{
    struct placed_body *stands = &guard->stands[row];
    stand_now(guard, context, row);
    stands->way_m = goes_straight_back(guard, context, row)
                        ? vec3_length(stands->moved) + stands->turned_m
                        : INFINITY;
}

static struct turned_body turned(const struct placed_body *stands)
{
    return (struct turned_body){&stands->body, stands->side.turn[0]};
}

/* Returns the gap of two bodies: below 0 if they overlap, else 0 [m]. Spheres and the plane between
 * their outer hulls are asked first: both are proofs that no two hulls overlap. */
static double gap_of(const struct contact_queue *contacts, uint32_t index,
                     const struct placed_body *a, const struct placed_body *b)
{
    struct pair_known *known = &contacts->known[index];
    struct vec3 between = vec3_sub(b->body.path.at, a->body.path.at);
    double reach = a->body.bound_m + b->body.bound_m;
    if (a->sphere_m > 0.0)
        return maths_min(0.0, vec3_length(between) - a->sphere_m - b->sphere_m);
    if (vec3_dot(between, between) > reach * reach)
        return 0.0;
    if (vec3_dot(known->plane[0], known->plane[0]) > 0.0 &&
        separating_axis_holds(&a->side, &b->side, known->plane[0], 0.0))
        return 0.0;
    const struct turned_body turned_a = turned(a), turned_b = turned(b);
    return level_gap_depth(&turned_a, &turned_b, known->plane,
                           contact_queue_memory(contacts, index));
}

/* Returns the gap of a pair at the end of the frame. */
static double gap_after(const struct end_guard *guard, const struct response_context *context,
                        uint32_t index)
{
    const struct contact_queue *contacts = context->contacts;
    const struct pair *pair = &contacts->pair[index];
    struct placed_body fixed;
    if (!(pair->b & PAIR_FIXED))
        return gap_of(contacts, index, &guard->stands[pair->a], &guard->stands[pair->b]);
    stand(context->motion, &context->next->entities, pair->b, &fixed);
    return gap_of(contacts, index, &guard->stands[pair->a], &fixed);
}

/* Returns the gap of a pair when the frame began, which is measured once. */
static double gap_before(const struct response_context *context, uint32_t index)
{
    const struct pair *pair = &context->contacts->pair[index];
    struct pair_known *known = &context->contacts->known[index];
    const struct entities *w = &context->motion->before;
    struct placed_body a, b;
    if (known->before_m != PAIR_NOT_MEASURED)
        return known->before_m;
    stand(context->motion, w, pair->a, &a);
    stand(context->motion, w, pair->b, &b);
    known->before_m = gap_of(context->contacts, index, &a, &b);
    return known->before_m;
}

/* Returns true if a row ends the frame where its swept path ends: nothing has set it on the ground
 * after an impact, or sent it back. */
static bool on_path(const struct end_guard *guard, const struct response_context *context,
                    uint32_t side)
{
    return side & PAIR_FIXED || (guard->sent_back[side] == 0 && context->motion->change[side] == 0);
}

/* Returns true if the sweep has shown that the bodies stay apart at the ends of their paths, and
 * none has gone so far back that they may not. Of spheres it shows nothing. */
static bool proved_apart(const struct end_guard *guard, const struct response_context *context,
                         uint32_t index)
{
    const struct pair *pair = &context->contacts->pair[index];
    if (!context->motion->models || !contact_queue_stays_apart(context->contacts, index))
        return false;
    if (on_path(guard, context, pair->a) && on_path(guard, context, pair->b))
        return true;
    double way_m = guard->stands[pair->a].way_m;
    if (!(pair->b & PAIR_FIXED))
        way_m += guard->stands[pair->b].way_m;
    return way_m + APART_M < context->contacts->known[index].stays_m;
}

/* Returns how far the points of two bodies have come relative to each other since the frame began,
 * at most [m]. */
static double come_of(const struct end_guard *guard, const struct pair *pair)
{
    const struct placed_body *a = &guard->stands[pair->a];
    if (pair->b & PAIR_FIXED)
        return vec3_length(a->moved) + a->turned_m;
    const struct placed_body *b = &guard->stands[pair->b];
    return vec3_length(vec3_sub(a->moved, b->moved)) + a->turned_m + b->turned_m;
}

/* Returns true if hulls that were near when the frame began are still separated by the planes
 * across their nearest points, and all others were farther apart than they have come since then. */
static bool hulls_apart(const struct end_guard *guard, const struct pair *pair,
                        const struct resting_known *rested, double come_m)
{
    if (!rested || rested->gap == 0 || pair->b & PAIR_FIXED)
        return false;
    const struct resting_gap *gap = &guard->resting->gap[rested->gap - 1];
    const struct placed_body *a = &guard->stands[pair->a], *b = &guard->stands[pair->b];
    const struct turned_body turned_a = turned(a), turned_b = turned(b);
    return come_m + APART_M < gap->margin_m &&
           level_gap_planes_hold(&turned_a, &turned_b, gap->gap, gap->count);
}

/* Returns true if the ground holds both sides of a pair. Those of them that are deep have been
 * found before, and part. A depth of others along level normals says nothing: a gun that slants
 * into an edge by 1 mm is 0.2 m deep by the normals of the faces. */
static bool held(const struct response_context *context, const struct pair *pair)
{
    return path_change_grounded(context, pair->a) &&
           (pair->b & PAIR_FIXED || path_change_grounded(context, pair->b));
}

/* Returns true if the pair ends the frame deeper in each other than it began it. Pairs are measured
 * on all workers, each by one. */
static bool deeper(const struct end_guard *guard, const struct response_context *context,
                   uint32_t index)
{
    const struct pair *pair = &context->contacts->pair[index];
    struct pair_known *known = &context->contacts->known[index];
    double come_m = come_of(guard, pair);
    if (come_m + APART_M < known->apart_m || proved_apart(guard, context, index) ||
        hulls_apart(guard, pair, contact_queue_knows_rested(context->contacts, index), come_m))
        return false;
    double after = gap_after(guard, context, index);
    if (after >= -ROUNDING_M)
        return false;
    bool is_held = held(context, pair);
    if (known->way_m > 0.0 || (!is_held && context->contacts->marks[index] & CONTACT_PARTS))
        return true; /* see heed_ways() */
    double before = gap_before(context, index);
    return (before > -RESTING_PARTS_M || is_held) && after < before - EXACT_M;
}

/* --- rows --------------------------------------------------------------------------------------*/

static bool guarded(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return body_motion_old(context->motion, row) && e->row[row].state != ENTITY_FREE &&
           e->row[row].behaviour != BEHAVIOUR_FLIGHT &&
           (e->row[row].state == ENTITY_WRECK || e->row[row].flags & ENTITY_FLAG_CHASSIS ||
            contact_groups_is_piloted(context, row) || drift_guard_drifts(context, row) ||
            path_change_grounded(context, row));
}

/* Returns true for a row that has to stand on the ground where it is now: also one that is new in
 * this frame, which an impact may have moved. */
static bool is_set_on_ground(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    bool fresh = !body_motion_old(context->motion, row) && e->row[row].state == ENTITY_ACTIVE &&
                 e->row[row].behaviour != BEHAVIOUR_FLIGHT;
    return (fresh || guarded(context, row)) && path_change_grounded(context, row);
}

/* Lists a row to be looked at. */
static void look_at(struct end_guard *guard, uint32_t row)
{
    if (!guard->listed[row])
        guard->row[guard->count++] = row;
    guard->listed[row] = 1;
}

/* Returns true if a row goes together with others in the air. */
static bool goes_together(const struct end_guard *guard, uint32_t row)
{
    return vec3_dot(guard->drift[row], guard->drift[row]) > 0.0;
}

/* Adds a row to those that have to go back, unless it is back already. */
static void mark(struct end_guard *guard, const struct response_context *context, uint32_t row)
{
    if (guard->marked[row] || guard->sent_back[row] == SEND_BACK_MOST || !guarded(context, row))
        return;
    guard->marked[row] = 1;
    guard->back[guard->back_count++] = row;
}

/* Lists a pair to be measured in this round. */
static void add_pair(struct end_guard *guard, const struct contact_queue *contacts, uint32_t index)
{
    const struct pair *pair = &contacts->pair[index];
    if (guard->pair_count == guard->pair_capacity) {
        uint32_t more = 2 * guard->pair_capacity + 1;
        guard->pair = reserve_grow(guard->pair, guard->pair_count, more, sizeof *guard->pair);
        guard->pair_capacity = more;
    }
    list_pose(guard, pair->a);
    if (!(pair->b & PAIR_FIXED))
        list_pose(guard, pair->b);
    guard->pair[guard->pair_count++] = (struct guard_pair){.pair = index};
}

/* Returns true if both sides of a pair are guarded, or one is and the other a wall. Only rows that
 * are guarded are posed. Those that are so deep that they part as capsules are left out. */
static bool is_guarded(const struct end_guard *guard, const struct response_context *context,
                       uint32_t index)
{
    uint32_t a = context->contacts->pair[index].a, b = context->contacts->pair[index].b;
    return !(context->contacts->marks[index] & CONTACT_CAPSULES) &&
           (guard->posed[a] || guarded(context, a)) &&
           (b & PAIR_FIXED ? contact_groups_is_wall(context, b & ~PAIR_FIXED)
                           : guard->posed[b] || guarded(context, b));
}

/* Lists the row's pairs. A pair of two rows that are looked at is listed once. */
static void add_pairs_of(struct end_guard *guard, const struct response_context *context,
                         uint32_t row)
{
    const struct contact_queue *contacts = context->contacts;
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        uint32_t index = contacts->link[link - 1].pair;
        const struct pair *pair = &contacts->pair[index];
        uint32_t other = pair->a == row ? pair->b : pair->a;
        bool later = !(other & PAIR_FIXED) && guard->listed[other] && other < row;
        if (!later && is_guarded(guard, context, index))
            add_pair(guard, contacts, index);
    }
}

/* Lists the pairs of all rows that are looked at. Where these are most, to go through the queue
 * costs less than the list of each. */
static void add_pairs(struct end_guard *guard, const struct response_context *context)
{
    const struct contact_queue *contacts = context->contacts;
    bool all =
        guard->posed_count == 0 && contacts->pair_count <= MOST_ROWS_PAIRS * (uint64_t)guard->count;
    for (uint32_t i = 0; all && i < contacts->pair_count; i++) {
        uint32_t a = contacts->pair[i].a, b = contacts->pair[i].b;
        if ((guard->listed[a] || (!(b & PAIR_FIXED) && guard->listed[b])) &&
            is_guarded(guard, context, i))
            add_pair(guard, contacts, i);
    }
    for (uint32_t i = 0; !all && i < guard->count; i++) {
        if (guarded(context, guard->row[i]))
            add_pairs_of(guard, context, guard->row[i]);
    }
}

struct round {
    struct end_guard *guard;
    const struct response_context *context;
    uint32_t posed; /* listed rows that were known before */
};

static void stand_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct round *round = argument;
    (void)worker;
    for (uint32_t i = round->posed + first; i < round->posed + end; i++)
        stand_at_end(round->guard, round->context, round->guard->posed_row[i]);
}

/* Measures pairs first .. end - 1. */
static void measure_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct round *round = argument;
    for (uint32_t i = first; i < end; i++) {
        struct guard_pair *one = &round->guard->pair[i];
        one->deeper = deeper(round->guard, round->context, one->pair);
    }
    work_done_by(worker);
}

/* Returns how far a side of a pair has come along the pair's normal [m]. */
static double come_along(const struct end_guard *guard, const struct resting_known *rested,
                         uint32_t side)
{
    const struct vec3 moved = side & PAIR_FIXED ? (struct vec3){0} : guard->stands[side].moved;
    return moved.x * rested->normal_x + moved.z * rested->normal_z;
}

/* Returns the side of a pair that follows the other, which leaves it, or SLOT_NONE. */
static uint32_t follower_of(const struct end_guard *guard, const struct pair *pair,
                            const struct resting_known *rested)
{
    if (!rested)
        return SLOT_NONE;
    double a = come_along(guard, rested, pair->a), b = come_along(guard, rested, pair->b);
    if (a > 0.0 && b > 0.0)
        return pair->a;
    return a < 0.0 && b < 0.0 ? pair->b : SLOT_NONE;
}

/* Marks the bodies of a pair. One that the other follows goes back only when that one is back: if
 * both went back by the same share, they would be as near to each other as before. */
static void mark_pair(struct end_guard *guard, const struct response_context *context,
                      uint32_t index)
{
    const struct pair *pair = &context->contacts->pair[index];
    const struct contact_queue *contacts = context->contacts;
    uint32_t follower = follower_of(guard, pair, contact_queue_knows_rested(contacts, index));
    if (follower != SLOT_NONE) {
        mark(guard, context, follower);
        if (guard->marked[follower])
            return;
    }
    mark(guard, context, pair->a);
    if (!(pair->b & PAIR_FIXED))
        mark(guard, context, pair->b);
}

/* Returns true if the bodies of a pair part along the ground, and not along a level way. */
static bool parts_along_ground(const struct end_guard *guard, const struct contact_queue *contacts,
                               uint32_t index)
{
    const struct resting_known *rested = contact_queue_knows_rested(contacts, index);
    return rested && rested->gap != 0 && guard->resting->gap[rested->gap - 1].along_ground;
}

/* Returns the length of the way of the pair's first body out of the other, in a table [m]. */
static double way_out(struct end_guard *guard, const struct response_context *context,
                      const struct entities *e, uint32_t index)
{
    const struct pair *pair = &context->contacts->pair[index];
    const struct swept_body a = body_motion_standing(context->motion, e, pair->a);
    const struct swept_body b = body_motion_standing(context->motion, e, pair->b);
    struct exit_slope slope = {0.0, 0.0};
    struct vec3 normal;
    if (parts_along_ground(guard, context->contacts, index))
        slope = ground_placement_slope(context, pair->a, pair->b);
    double way_m = level_exit_of(&guard->exit, slope, &a, &b, &normal);
    return way_m < INFINITY ? way_m : 0.0;
}

/* Returns how long the way was when the frame began [m]. */
static double way_before(struct end_guard *guard, const struct response_context *context,
                         uint32_t index)
{
    struct pair_known *known = &context->contacts->known[index];
    if (known->way_m == 0.0)
        known->way_m = way_out(guard, context, &context->motion->before, index);
    return known->way_m;
}

/* Bodies that part get deeper only if their way out of each other gets longer: a gun that leaves a
 * hull through its length gets deeper into it before it is out, and one that slants into an edge by
 * 1 mm seems to be deep in it. */
static void heed_ways(struct end_guard *guard, const struct response_context *context)
{
    for (uint32_t i = 0; context->motion->models && i < guard->pair_count; i++) {
        struct guard_pair *one = &guard->pair[i];
        if (one->deeper && context->contacts->marks[one->pair] & CONTACT_PARTS)
            one->deeper = way_out(guard, context, &context->next->entities, one->pair) >
                          way_before(guard, context, one->pair) + EXACT_M;
    }
}

/* Marks the bodies of the pairs that end the frame deeper in each other, and those that end it
 * deeper in the ground. */
static void mark_deeper(struct end_guard *guard, const struct response_context *context)
{
    for (uint32_t i = 0; i < guard->pair_count; i++) {
        if (!guard->pair[i].deeper)
            continue;
        tangled_wrecks_note(&guard->tangled, context, guard->pair[i].pair);
        mark_pair(guard, context, guard->pair[i].pair);
    }
    for (uint32_t i = 0; i < guard->count; i++) {
        if (guarded(context, guard->row[i]) &&
            ground_placement_sinks(context, guard->row[i], i < guard->moved))
            mark(guard, context, guard->row[i]);
    }
}

/* One round: all pairs of the listed rows are tested before any row goes back, so that the result
 * does not depend on the order of the rows and their pairs. The rows that went back are listed
 * next. */
static void run_round(struct end_guard *guard, struct response_context *context)
{
    struct round round = {guard, context, guard->posed_count};
    guard->back_count = guard->pair_count = 0;
    add_pairs(guard, context);
    thread_pool_run(guard->workers, stand_some, &round, guard->posed_count - round.posed,
                    ROWS_A_PIECE);
    uint32_t piece = guard->pair_count / PIECES;
    thread_pool_run(guard->workers, measure_some, &round, guard->pair_count,
                    piece > PAIRS_A_PIECE ? piece : PAIRS_A_PIECE);
    heed_ways(guard, context);
    mark_deeper(guard, context);
    for (uint32_t i = 0; i < guard->count; i++)
        guard->listed[guard->row[i]] = 0;
    guard->count = 0;
    for (uint32_t i = 0; i < guard->back_count; i++) {
        uint32_t row = guard->back[i];
        guard->marked[row] = 0;
        if (guard->sent_back[row] == 0)
            guard->touched[guard->touched_count++] = row;
        guard->sent_back[row] =
            send_back_go(context, row, guard->drift[row], guard->sent_back[row] + 1);
        stand_now(guard, context, row);
        look_at(guard, row);
    }
    guard->moved = guard->count;
}

/* Lists a side of a pair unless it ends the frame where it began it. */
static void look_at_side(struct end_guard *guard, const struct response_context *context,
                         uint32_t side)
{
    if (!(side & PAIR_FIXED) &&
        (context->motion->change[side] != 0 || body_motion_moves(context->motion, side)))
        look_at(guard, side);
}

/* Lists the bodies of the pairs that rest or have met, even if nothing changed their motion. Pairs
 * that rest are not swept, and an impact may find bodies that do not close by their velocities: it
 * gives no impulse, and the pair is not swept again. */
static void look_at_met(struct end_guard *guard, const struct response_context *context)
{
    const struct contact_queue *contacts = context->contacts;
    for (uint32_t i = 0; i < contacts->pair_count; i++) {
        if (!(contacts->marks[i] & CONTACT_RESTS) && contacts->met[i] == 0)
            continue;
        look_at_side(guard, context, contacts->pair[i].a);
        look_at_side(guard, context, contacts->pair[i].b);
    }
}

/* Lists the aircraft that nobody steers and that touched another body a frame ago, and those
 * bodies. */
static void look_at_drifting(struct end_guard *guard, const struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        const struct persistent_contact *contact = &committed->contacts[i];
        if (!drift_guard_heeds(context, contact))
            continue;
        look_at(guard, contact->a_row);
        if (!(contact->b_id & PERSISTENT_CONTACT_FIXED))
            look_at(guard, contact->b_row);
    }
}

/* --- rows that made way ------------------------------------------------------------------------*/

/* A body that has made way keeps so much of it along the ground [m]. Without any room a crowd on
 * uneven ground locks: bodies that lean differently where they go are in each other by a
 * millimetre, and go back. */
#define ROOM_M     0.009
#define DRAWN_MOST 4  /* passes over all that have */
#define HALVINGS   4u /* of the part of its way in which it gets deep again */

/* Returns true if one of the row's pairs ends the frame deeper than it began it. */
static bool any_deeper(struct end_guard *guard, const struct response_context *context,
                       uint32_t row)
{
    bool any = false;
    uint32_t known = guard->posed_count;
    guard->pair_count = 0;
    add_pairs_of(guard, context, row);
    for (; known < guard->posed_count; known++)
        stand_at_end(guard, context, guard->posed_row[known]);
    for (uint32_t i = 0; i < guard->pair_count; i++)
        guard->pair[i].deeper = deeper(guard, context, guard->pair[i].pair);
    heed_ways(guard, context);
    for (uint32_t i = 0; i < guard->pair_count; i++)
        any |= guard->pair[i].deeper;
    return any;
}

/* Returns how often the rounds have sent a row back, which may have been drawn back since. */
static uint32_t times_back(const struct end_guard *guard, uint32_t row)
{
    return guard->drawn[row] ? guard->drawn[row] - 1u : guard->sent_back[row];
}

/* Sets where a row would be if it had not made way; of one that went back by half of its way, it is
 * half of the way that it had without. Returns false if it did not make way, or has to stand where
 * it began the frame. */
static bool home_of(const struct end_guard *guard, const struct resting *resting,
                    const struct response_context *context, uint32_t index, struct vec3 *home)
{
    const struct level_motion *pushed = &resting->body[index].pushed;
    uint32_t row = resting->row[index];
    if (row == SLOT_NONE || !resting->parting.body[index].makes_way || !guarded(context, row) ||
        context->motion->change[row] != 0 || times_back(guard, row) > SEND_BACK_HALF)
        return false;
    double dt_s = world_dt_s(context->world), keep = 1.0 / (1u << times_back(guard, row));
    const struct path *path = &context->path[row];
    *home = vec3_add(path->at, vec3_scale(path->along, keep));
    home->x -= pushed->x * keep * dt_s;
    home->z -= pushed->z * keep * dt_s;
    return true;
}

/* Puts a row to a place. Returns true if none of its pairs gets deeper by it. */
static bool try_at(struct end_guard *guard, struct response_context *context, uint32_t row,
                   struct vec3 at)
{
    ground_placement_put(context, row, at, context->next->entities.row[row].heading);
    stand_now(guard, context, row);
    return !any_deeper(guard, context, row);
}

/* Lets a row that has made way go back, as far as none of its pairs gets deeper by it. Returns true
 * if it has moved. */
static bool draw_back(struct end_guard *guard, struct response_context *context, uint32_t row,
                      struct vec3 home)
{
    const struct entities *e = &context->next->entities;
    const struct vec3 at = entities_position(e, row), way = vec3_sub(at, home);
    double far = sqrt(way.x * way.x + way.z * way.z), pitch = e->row[row].pitch,
           roll = e->row[row].roll;
    double room = ROOM_M * deep_pair_level(context, row);
    if (far <= room + ROUNDING_M)
        return false;
    list_pose(guard, row);
    if (guard->sent_back[row] == 0)
        guard->touched[guard->touched_count++] = row;
    guard->drawn[row] = (uint8_t)(times_back(guard, row) + 1);
    guard->sent_back[row] = guard->drawn[row] > 1 ? guard->drawn[row] - 1 : 1;
    double deep = room / far, out = 1.0;
    if (try_at(guard, context, row, vec3_lerp(home, at, deep)))
        return true;
    for (uint32_t i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (deep + out);
        if (try_at(guard, context, row, vec3_lerp(home, at, middle)))
            out = middle;
        else
            deep = middle;
    }
    if (out < 1.0) {
        ground_placement_put(context, row, vec3_lerp(home, at, out), e->row[row].heading);
    } else {
        table_set_position(&context->writer, row, at);
        table_set_pitch(&context->writer, row, pitch);
        table_set_roll(&context->writer, row, roll);
    }
    stand_now(guard, context, row);
    return out < 1.0;
}

/* Draws the rows back that have made way for others, one after the other, and those behind them:
 * whom they made way for may have been sent back, or have come past their corner. */
static void draw_all_back(struct end_guard *guard, const struct resting *resting,
                          struct response_context *context)
{
    bool any = true;
    for (uint32_t pass = 0; any && pass < DRAWN_MOST; pass++) {
        any = false;
        for (uint32_t n = 0; n < resting->bodies; n++) {
            uint32_t i = pass % 2 == 0 ? n : resting->bodies - 1 - n;
            struct vec3 home;
            if (home_of(guard, resting, context, i, &home))
                any |= draw_back(guard, context, resting->row[i], home);
        }
    }
    for (uint32_t i = 0; i < guard->touched_count; i++)
        guard->drawn[guard->touched[i]] = 0;
}

void end_guard_run(struct end_guard *guard, const struct resting *resting,
                   const struct free_bodies *free, struct response_context *context)
{
    const struct body_motion *motion = context->motion;
    const struct entities *e = &context->next->entities;
    guard->resting = resting;
    guard->drift = free->drift;
    guard->count = guard->touched_count = guard->posed_count = 0;
    for (uint32_t i = 0; i < resting->moved_count; i++)
        look_at(guard, resting->moved[i]);
    for (uint32_t i = 0; i < free->moved_count; i++)
        look_at(guard, free->moved[i]);
    for (uint32_t i = 0; i < motion->changes; i++)
        look_at(guard, motion->row[i]);
    for (uint32_t i = 0; i < guard->count; i++) {
        uint32_t row = guard->row[i];
        if (!free->owned[row] && is_set_on_ground(context, row))
            ground_placement_put(context, row, entities_position(e, row), e->row[row].heading);
    }
    guard->moved = guard->count;
    look_at_met(guard, context);
    if (!context->contacts_sleep || motion->changes != 0)
        look_at_drifting(guard, context);
    while (guard->count > 0)
        run_round(guard, context);
    draw_all_back(guard, resting, context);
    tangled_wrecks_go_on(&guard->tangled, context, guard->sent_back);
    for (uint32_t i = 0; i < guard->touched_count; i++) {
        if (guard->sent_back[guard->touched[i]] == SEND_BACK_MOST)
            held_rest_mark(context, guard->touched[i]);
    }
    for (uint32_t i = 0; i < guard->touched_count; i++) {
        uint32_t row = guard->touched[i];
        if (guard->sent_back[row] == SEND_BACK_MOST && !goes_together(guard, row) &&
            drift_guard_drifts(context, row))
            drift_guard_restore(&guard->drifting, context, row);
    }
    drift_guard_forget(&guard->drifting);
    for (uint32_t i = 0; i < guard->touched_count; i++)
        guard->sent_back[guard->touched[i]] = 0;
    for (uint32_t i = 0; i < guard->posed_count; i++)
        guard->posed[guard->posed_row[i]] = 0;
}
