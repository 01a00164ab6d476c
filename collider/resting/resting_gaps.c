/* Measures pairs of the table, of new bodies and of neighbours, on all workers. */
#include "collider/resting/resting_gaps.h"

#include "collider/narrow_phase/contact_pairs.h"
#include "collider/response/contact_table.h"
#include "collider/resting/deep_pair.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/thread_pool.h"
#include "world/runtime/work_done.h"
#include "world/world.h"

#include <string.h>

/* Bodies that are farther apart at the frame's beginning, and do not come as near within it, bear
 * no load on each other [m]. */
#define NEAR_M 0.02

#define PAIRS_A_PIECE 4u

/* Returns where the list of the index-th of the frame's gaps is. */
static struct level_gap *list_of(const struct resting *resting, struct resting_gap *gap,
                                 uint32_t index)
{
    return gap->count <= LEVEL_GAPS_MAX ? gap->few
                                        : &resting->wide[(uint64_t)index * RESTING_GAPS_MAX];
}

/* Makes room for so many pairs. There may be more than contacts in the table, because bodies that
 * are new can overlap all others. Only the gaps of the first pairs are kept. */
static void make_room(struct resting *resting, const struct world *world, uint32_t kept,
                      uint32_t pairs)
{
    uint64_t more = 2 * (uint64_t)pairs, bodies = more + world->params->capacity;
    if (pairs <= resting->capacity)
        return;
    resting->gap = reserve_grow(resting->gap, kept, more, sizeof *resting->gap);
    resting->gap_before =
        reserve_grow(resting->gap_before, resting->before, more, sizeof *resting->gap_before);
    resting->key = reserve_grow(resting->key, kept, more, sizeof *resting->key);
    resting->key_before =
        reserve_grow(resting->key_before, resting->before, more, sizeof *resting->key_before);
    resting->before_of = reserve_grow(resting->before_of, kept, more, sizeof *resting->before_of);
    resting->wide = reserve_grow(resting->wide, kept * (uint64_t)RESTING_GAPS_MAX,
                                 more * RESTING_GAPS_MAX, sizeof *resting->wide);
    for (uint32_t i = 0; i < kept; i++)
        resting->gap[i].gap = list_of(resting, &resting->gap[i], i);
    for (uint32_t i = 0; i < resting->before; i++)
        resting->gap_before[i].gap = resting->gap_before[i].few; /* more are not taken again */
    resting->put_off = reserve_grow(resting->put_off, 0, more, sizeof *resting->put_off);
    resting->pair = reserve_grow(resting->pair, 0, more, sizeof *resting->pair);
    resting->point =
        reserve_grow(resting->point, 0, more * RESTING_POINTS_MAX, sizeof *resting->point);
    resting->body = reserve_grow(resting->body, 0, bodies, sizeof *resting->body);
    resting->row = reserve_grow(resting->row, 0, bodies, sizeof *resting->row);
    resting->pressed_ns = reserve_grow(resting->pressed_ns, 0, bodies, sizeof *resting->pressed_ns);
    resting->stands = reserve_grow(resting->stands, 0, bodies, sizeof *resting->stands);
    resting->capacity = (uint32_t)more;
}

/* Returns how much nearer two bodies can come within the frame, at most [m]. */
static double nearing(const struct begun_body *a, const struct begun_body *b)
{
    return vec3_length(vec3_sub(a->body.path.along, b->body.path.along)) +
           a->rate * a->body.bound_m + b->rate * b->body.bound_m;
}

static bool is_deep(const struct resting_gap *gap)
{
    return gap->count > 0 && gap->gap[0].gap_m <= -RESTING_PARTS_M;
}

/* A neighbourhood of bodies that part is measured with a greater margin and more gaps. */
struct gap_job {
    struct resting *resting;
    const struct response_context *context;
    uint32_t first; /* the pair with which it begins */
    bool parts;     /* pairs of a neighbourhood */
};

/* Returns how near hulls have to be of which one may part from others [m]. */
static double parting_margin(const struct gap_job *job, const struct begun_body *a,
                             const struct begun_body *b)
{
    return NEAR_M + nearing(a, b) + 2.0 * PARTING_MPS * world_dt_s(job->context->world);
}

/* Returns how near two bodies of a pair have to be. One that is not in the table, nor in a
 * neighbourhood, is near only if it overlaps [m]. */
static double margin_of(const struct gap_job *job, uint32_t index, const struct begun_body *a,
                        const struct begun_body *b)
{
    if (job->parts)
        return parting_margin(job, a, b);
    return index < job->resting->groups.known ? NEAR_M + nearing(a, b) : 0.0;
}

/* Sets what the table remembers of a pair, and of which bodies it is measured. The pairs that are
 * not in the list of the table have been looked up (begin_others()). */
static void recall(const struct gap_job *job, uint32_t index, struct resting_gap *gap)
{
    const struct resting *resting = job->resting;
    const struct pair *pair = &resting->groups.pair[index];
    const uint64_t *version = resting->begun.version;
    if (index < resting->groups.known) {
        uint32_t before = resting->before_of[index];
        gap->known = &job->context->motion->committed->contacts[resting->groups.contact[index]];
        gap->before = before != 0 ? &resting->gap_before[before - 1] : NULL;
    }
    gap->memory = (struct level_gap_memory){0};
    if (gap->known)
        memcpy(gap->memory.nearest, gap->known->nearest, sizeof gap->memory.nearest);
    gap->began = gap->memory;
    gap->version[0] = version[pair->a];
    gap->version[1] = pair->b & PAIR_FIXED ? 0 : version[pair->b];
}

/* Takes what was measured in the frame before, if that was of the same bodies in the same places on
 * the same paths, and began with the same memory. It saves work and changes no bit. */
static bool take_before(struct resting_gap *gap)
{
    const struct resting_gap *before = gap->before;
    if (!before || !before->repeats || before->version[0] != gap->version[0] ||
        before->version[1] != gap->version[1] ||
        memcmp((const unsigned char *)&before->began, (const unsigned char *)&gap->began,
               sizeof gap->began) != 0)
        return false;
    memcpy(gap->gap, before->gap, before->count * sizeof *gap->gap);
    gap->count = before->count;
    gap->apart_m = before->apart_m;
    gap->margin_m = before->margin_m;
    gap->memory = before->memory;
    gap->repeats = true;
    return true;
}

/* Two bodies part along one normal for all of their hulls that overlap. Those of the others that
 * are near bound them as well: a way along a face may lead one of them into the other body. */
static void part_whole(const struct turned_body *a, const struct turned_body *b, double searched_m,
                       double margin_m, struct resting_gap *gap)
{
    gap->pieces_m = gap->gap[0].gap_m;
    if (searched_m < margin_m)
        gap->count = level_gap_find_wider(a, b, margin_m, gap->gap, gap->count, RESTING_GAPS_MAX,
                                          &gap->memory);
    uint32_t kept = 1;
    if (gap->count > 1 && gap->gap[1].gap_m < 0.0)
        level_gap_whole(a, b, gap->gap, gap->count, RESTING_GAPS_MAX);
    for (uint32_t i = 1; i < gap->count; i++) {
        if (gap->gap[i].gap_m >= 0.0)
            gap->gap[kept++] = gap->gap[i];
    }
    gap->count = kept;
}

/* Keeps the list of gaps that was found. */
static void keep_list(const struct resting *resting, uint32_t index, const struct level_gap *list)
{
    struct resting_gap *gap = &resting->gap[index];
    gap->gap = list_of(resting, gap, index);
    memcpy(gap->gap, list, gap->count * sizeof *list);
}

/* Measures a pair whose bodies are not so deep that they part as capsules. */
static void measure_exactly(const struct gap_job *job, uint32_t index, const struct begun_body *a,
                            const struct begun_body *b)
{
    struct resting_gap *gap = &job->resting->gap[index];
    const struct turned_body turned_a = {&a->body, a->began}, turned_b = {&b->body, b->began};
    double margin_m = margin_of(job, index, a, b);
    struct level_gap list[RESTING_GAPS_MAX];
    gap->gap = list;
    gap->put_off = false;
    gap->count = level_gap_find_more(&turned_a, &turned_b, margin_m, gap->gap, RESTING_GAPS_MAX,
                                     &gap->apart_m, &gap->memory);
    gap->margin_m = gap->count < RESTING_GAPS_MAX ? margin_m : 0.0;
    gap->repeats = !job->parts && !is_deep(gap); /* parting changes gaps */
    gap->spreads = false;                        /* see is_deep_in_crowd() */
    if (is_deep(gap)) {
        gap->margin_m = 0.0;
        part_whole(&turned_a, &turned_b, margin_m, parting_margin(job, a, b), gap);
    } else if (!job->parts && gap->count > LEVEL_GAPS_MAX) {
        gap->count = LEVEL_GAPS_MAX;
        gap->margin_m = 0.0;
    }
    keep_list(job->resting, index, list);
}

/* Returns true if the pair may have overlapped a frame ago. */
static bool overlapped(const struct gap_job *job, const struct resting_gap *gap)
{
    return job->parts || !gap->known || gap->known->flags & PERSISTENT_CONTACT_OVERLAPS;
}

/* Measures a pair, unless it is to be put off until it is known whether its crowd spreads. */
static void measure_pair(const struct gap_job *job, uint32_t index)
{
    const struct body_motion *motion = job->context->motion;
    const struct pair *pair = &job->resting->groups.pair[index];
    struct resting_gap *gap = &job->resting->gap[index];
    struct begun_body fixed;
    recall(job, index, gap);
    gap->place = contact_pairs_find(job->context->contacts, pair);
    gap->capsules = gap->put_off = gap->spreads = gap->repeats = false;
    gap->pieces_m = PAIR_NOT_MEASURED;
    gap->gap = gap->few;
    if (!job->parts && take_before(gap))
        return;
    gap->apart_m = gap->margin_m = 0.0;
    const struct begun_bodies *begun = &job->resting->begun;
    const struct begun_body *a = begun_bodies_side(begun, motion, pair->a, NULL);
    const struct begun_body *b = begun_bodies_side(begun, motion, pair->b, &fixed);
    gap->capsules = deep_pair_measure(job->context, pair, a, b, gap);
    if (gap->capsules)
        return;
    gap->count = 0;
    gap->put_off = overlapped(job, gap) && deep_pair_is_near(a, b);
    if (!gap->put_off)
        measure_exactly(job, index, a, b);
}

/* Bodies of a crowd that spreads do not bound each other: of a pair that is deep only its depth has
 * to be known, and only up to DEEP_PAIR_M. Returns false for any other pair. */
static bool is_deep_in_crowd(const struct begun_body *a, const struct begun_body *b,
                             struct resting_gap *gap)
{
    const struct turned_body turned_a = {&a->body, a->began}, turned_b = {&b->body, b->began};
    struct level_gap deepest;
    if (!gap->spreads ||
        !level_gap_deepest(&turned_a, &turned_b, RESTING_PARTS_M, DEEP_PAIR_M, &deepest))
        return false;
    gap->capsules = deepest.gap_m < -DEEP_PAIR_M;
    gap->put_off = false;
    gap->count = 1;
    gap->gap = gap->few;
    gap->gap[0] = (struct level_gap){.normal = deepest.normal,
                                     .gap_m = maths_max(deepest.gap_m, -DEEP_PAIR_M),
                                     .point = {vec3_lerp(a->body.path.at, b->body.path.at, 0.5)},
                                     .points = 1,
                                     .hulls = deepest.hulls};
    if (!gap->capsules)
        gap->pieces_m = deepest.gap_m;
    return true;
}

/* Measures a pair that was put off, or is measured again. */
static void measure_put_off(const struct gap_job *job, uint32_t index)
{
    const struct body_motion *motion = job->context->motion;
    const struct pair *pair = &job->resting->groups.pair[index];
    const struct begun_bodies *begun = &job->resting->begun;
    struct begun_body fixed;
    const struct begun_body *a = begun_bodies_side(begun, motion, pair->a, NULL);
    const struct begun_body *b = begun_bodies_side(begun, motion, pair->b, &fixed);
    if (!is_deep_in_crowd(a, b, &job->resting->gap[index]))
        measure_exactly(job, index, a, b);
}

/* Measures pairs first .. end - 1 of the job. */
static void measure_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct gap_job *job = argument;
    for (uint32_t i = job->first + first; i < job->first + end; i++)
        measure_pair(job, i);
    work_done_by(worker);
}

/* The same of those that were put off. */
static void measure_some_put_off(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct gap_job *job = argument;
    for (uint32_t i = first; i < end; i++)
        measure_put_off(job, job->resting->put_off[i]);
    work_done_by(worker);
}

/* Keeps the gaps of the frame before, and finds among them those of the table's pairs. Both lists
 * rise by their keys. The gaps themselves are large, and only those who measure them look at them.
 */
static void begin_gaps(struct resting *resting, const struct response_context *context)
{
    const struct persistent_contact *contact = context->motion->committed->contacts;
    struct resting_gap *last = resting->gap;
    uint64_t *last_key = resting->key;
    uint32_t k = 0, before = resting->before;
    resting->gap = resting->gap_before;
    resting->gap_before = last;
    resting->key = resting->key_before;
    resting->key_before = last_key;
    make_room(resting, context->world, 0, resting->groups.count);
    for (uint32_t i = 0; i < resting->groups.known; i++) {
        uint64_t key = persistent_contact_key(&contact[resting->groups.contact[i]]);
        while (k < before && resting->key_before[k] < key)
            k++;
        resting->key[i] = key;
        resting->before_of[i] = k < before && resting->key_before[k] == key ? k + 1 : 0;
    }
    resting->before = resting->groups.known;
}

/* Looks up pairs that are not in the list of the table: those of bodies that are new, and of
 * neighbours. */
static void begin_others(struct resting *resting, const struct response_context *context,
                         uint32_t first)
{
    for (uint32_t i = first; i < resting->groups.count; i++) {
        const struct pair *pair = &resting->groups.pair[i];
        resting->gap[i].known = contact_table_find(context, pair->a, pair->b);
        resting->gap[i].before = NULL;
    }
}

/* Tells the queue what is known of a pair. */
static void tell(struct resting *resting, const struct response_context *context, uint32_t index)
{
    struct resting_gap *gap = &resting->gap[index];
    const struct pair *pair = &resting->groups.pair[index];
    uint32_t place = gap->place;
    if (place == 0 && gap->count > 0)
        place = contact_queue_pair(context->contacts, pair) + 1;
    if (place == 0)
        return;
    struct pair_known *known = &context->contacts->known[place - 1];
    known->apart_m = gap->apart_m;
    if (gap->count == 0)
        return;
    struct resting_known *rested = contact_queue_rested(context->contacts, place - 1);
    gap->pair = place - 1;
    rested->gap = index + 1;
    rested->memory = gap->memory;
    known->before_m = gap->pieces_m;
}

/* Joins the bodies of all deep pairs. */
static void find_crowds(struct resting *resting, const struct response_context *context)
{
    crowds_forget(&resting->crowds);
    for (uint32_t i = 0; i < resting->groups.count; i++) {
        if (is_deep(&resting->gap[i]))
            crowds_join(&resting->crowds, &resting->groups.pair[i], -resting->gap[i].gap[0].gap_m);
    }
    crowds_measure(&resting->crowds, context);
}

/* Measures the pairs that were put off, from the first on. */
static void measure_those_put_off(struct gap_job *job)
{
    struct resting *resting = job->resting;
    uint32_t count = 0;
    for (uint32_t i = job->first; i < resting->groups.count; i++) {
        if (resting->gap[i].put_off)
            resting->put_off[count++] = i;
    }
    if (count == 0)
        return;
    find_crowds(resting, job->context);
    for (uint32_t i = 0; i < count; i++) {
        struct resting_gap *gap = &resting->gap[resting->put_off[i]];
        gap->spreads =
            crowds_spread_together(&resting->crowds, &resting->groups.pair[resting->put_off[i]]);
    }
    thread_pool_run(resting->workers, measure_some_put_off, job, count, PAIRS_A_PIECE);
}

/* Measures the pairs from the first on. */
static void measure(struct resting *resting, const struct response_context *context, uint32_t first,
                    bool parts)
{
    struct gap_job job = {resting, context, first, parts};
    make_room(resting, context->world, first, resting->groups.count);
    begin_others(resting, context, first > resting->groups.known ? first : resting->groups.known);
    for (uint32_t i = first; i < resting->groups.count; i++) {
        const struct pair *pair = &resting->groups.pair[i];
        begun_bodies_list(&resting->begun, pair->a);
        if (!(pair->b & PAIR_FIXED))
            begun_bodies_list(&resting->begun, pair->b);
    }
    begun_bodies_find(&resting->begun, context, resting->workers);
    thread_pool_run(resting->workers, measure_some, &job, resting->groups.count - first,
                    PAIRS_A_PIECE);
    measure_those_put_off(&job);
    for (uint32_t i = first; i < resting->groups.count; i++)
        tell(resting, context, i);
}

/* Finds the crowds of all pairs. A crowd may spread no longer when all of its bodies are known:
 * then its pairs are measured after all. */
static void settle_crowds(struct resting *resting, const struct response_context *context)
{
    struct gap_job job = {resting, context, 0, true};
    uint32_t count = 0;
    find_crowds(resting, context);
    for (uint32_t i = 0; i < resting->groups.count; i++) {
        struct resting_gap *gap = &resting->gap[i];
        if (!gap->spreads || crowds_spread_together(&resting->crowds, &resting->groups.pair[i]))
            continue;
        gap->spreads = false;
        resting->put_off[count++] = i;
    }
    thread_pool_run(resting->workers, measure_some_put_off, &job, count, PAIRS_A_PIECE);
    for (uint32_t i = 0; i < count; i++)
        tell(resting, context, resting->put_off[i]);
}

/* Measures the pairs within reach of the bodies that part, and of these all that they may push. */
static void measure_neighbours(struct resting *resting, struct response_context *context)
{
    struct contact_groups *groups = &resting->groups;
    struct neighbours *neighbours = &resting->neighbours;
    struct gap_job again = {resting, context, 0, true};
    uint32_t near = 0;
    const double reach_m = 2.0 * PARTING_MPS * world_dt_s(context->world);
    uint32_t table = groups->count, measured = table;
    for (uint32_t i = 0; i < table; i++) {
        if (resting->gap[i].count > 0)
            context->contacts->marks[resting->gap[i].pair] |= CONTACT_GATHERED;
    }
    while (neighbours_list(neighbours, context, reach_m, groups)) {
        measure(resting, context, measured, true);
        for (; measured < groups->count; measured++) {
            if (resting->gap[measured].count > 0)
                neighbours_add(neighbours, &groups->pair[measured]);
        }
    }
    for (uint32_t i = 0; i < table; i++) {
        if (resting->gap[i].count > 0 && !is_deep(&resting->gap[i]) &&
            neighbours_has(neighbours, &groups->pair[i]))
            resting->put_off[near++] = i;
    }
    thread_pool_run(resting->workers, measure_some_put_off, &again, near, PAIRS_A_PIECE);
    neighbours_unmark(context);
}

void resting_gaps_measure(struct resting *resting, struct response_context *context)
{
    neighbours_begin(&resting->neighbours);
    begin_gaps(resting, context);
    measure(resting, context, 0, false);
    for (uint32_t i = 0; i < resting->groups.count; i++) {
        if (is_deep(&resting->gap[i]))
            neighbours_add(&resting->neighbours, &resting->groups.pair[i]);
    }
    crowds_forget(&resting->crowds);
    if (resting->neighbours.count > 0) {
        measure_neighbours(resting, context);
        settle_crowds(resting, context);
    }
    begun_bodies_forget(&resting->begun);
}
