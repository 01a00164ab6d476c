/* Impacts of one moment, the contacts behind them, and the groups that they form. */
#include "collider/response/island_gather.h"

#include "collider/geometry/level_gap.h"
#include "collider/narrow_phase/contact_pairs.h"
#include "collider/response/contact_impulse.h"
#include "collider/response/path_change.h"
#include "collider/response/response.h"
#include "world/maths/sort.h"
#include "world/runtime/reserve.h"
#include "world/runtime/thread_pool.h"
#include "world/runtime/work_done.h"
#include "world/state.h"
#include "world/world.h"

/* Of the contacts that last, an island takes those of bodies so many contacts away from an impact.
 */
#define HOPS 2

/* Contacts that one worker measures at a time. A few take less time than a meeting of two threads
 * saves. */
#define BEHIND_A_PIECE 8u

/* --- the contacts of one moment ----------------------------------------------------------------*/

static uint32_t body_for(struct island *island, uint32_t row)
{
    if (island->body_of[row] == 0) {
        uint32_t index = island->bodies++;
        island->body[index] =
            (struct island_body){.row = row, .parent = index, .local = UINT32_MAX};
        island->row[index] = row;
        island->body_of[row] = index + 1;
    }
    return island->body_of[row] - 1;
}

static uint32_t root_of(struct island *island, uint32_t body)
{
    while (island->body[body].parent != body) {
        island->body[body].parent = island->body[island->body[body].parent].parent;
        body = island->body[body].parent;
    }
    return body;
}

/* The lower root becomes the root of both, so that groups are in the order of their first
 * contact. */
static void join(struct island *island, uint32_t p, uint32_t q)
{
    uint32_t a = root_of(island, p), b = root_of(island, q);
    island->body[a > b ? a : b].parent = a > b ? b : a;
}

/* The solver's arrays are empty while contacts are gathered, so nothing is copied. */
static void grow_contacts(struct island *island)
{
    uint32_t more = 2 * island->met_capacity + 1;
    uint64_t solved = (uint64_t)island->rows + more;
    island->met = reserve_grow(island->met, island->met_count, more, sizeof *island->met);
    island->solve = reserve_grow(island->solve, 0, solved, sizeof *island->solve);
    island->solve_of = reserve_grow(island->solve_of, 0, solved, sizeof *island->solve_of);
    island->contact = reserve_grow(island->contact, 0, more, sizeof *island->contact);
    island->met_capacity = more;
}

/* Returns the place of the next contact. The caller counts it. */
static struct island_contact *next_contact(struct island *island)
{
    if (island->met_count == island->met_capacity)
        grow_contacts(island);
    return &island->met[island->met_count];
}

/* Finds the bodies of a contact, and joins those of two rows to a group. */
static void add_bodies(struct island *island, struct island_contact *met)
{
    met->body_a = body_for(island, met->contact.a);
    if (met->contact.b & PAIR_FIXED)
        return;
    met->body_b = body_for(island, met->contact.b);
    join(island, met->body_a, met->body_b);
}

/* Bodies on the ground that have met rest on each other for the rest of the frame: what closes more
 * slowly than in an impact is left to the solver of resting contacts, in the next frame. */
static void rest(struct response_context *context, const struct contact *contact)
{
    struct contact_queue *contacts = context->contacts;
    const struct pair pair = {contact->a, contact->b};
    struct free_turn turn_a, turn_b;
    struct level_gap gap[LEVEL_GAPS_MAX];
    struct rest_point point[2 * LEVEL_GAPS_MAX];
    uint32_t count = 0;
    double time = contact->impact.toi;
    if (!contacts->proves || contacts->rest[contact->pair - 1].count > 0 ||
        !path_change_grounded(context, pair.a) ||
        (!(pair.b & PAIR_FIXED) && !path_change_grounded(context, pair.b)))
        return;
    struct swept_body a = body_motion_body(context->motion, pair.a, &turn_a);
    struct swept_body b = body_motion_side(context->motion, pair.b, &turn_b);
    struct vec3 at_a = path_at(&a.path, time), at_b = path_at(&b.path, time);
    uint32_t gaps = level_gap_find(&a, &b, time, CONTACT_TOUCHING_M,
                                   contact_queue_memory(contacts, contact->pair - 1), gap);
    for (uint32_t g = 0; g < gaps; g++) {
        for (uint32_t p = 0; p < gap[g].points; p++) {
            struct vec3 at = gap[g].point[p];
            point[count++] = (struct rest_point){gap[g].normal.x, gap[g].normal.z, at.x - at_a.x,
                                                 at.z - at_a.z,   at.x - at_b.x,   at.z - at_b.z};
        }
    }
    if (count > 0)
        contact_queue_rest(contacts, contact->pair - 1, point, count);
}

/* Gathers one contact: a persistent contact, a fixed object that gives way, or a contact for the
 * solver. */
static void take(struct response_context *context, const struct contact *contact)
{
    struct island *island = context->island;
    struct island_contact *met = next_contact(island);
    *met = (struct island_contact){
        .contact = *contact, .impact = response_impact(context, contact), .body_b = BODY_FIXED};
    if (passes_through(context, &met->impact))
        return;
    enum impact_role role = response_role(context, &met->impact);
    met->leans = role == IMPACT_LEANS;
    if (!met->leans)
        met->report = response_report(context, &met->impact, role);
    if (contact->b & PAIR_FIXED && contact_impulse_gives_way(context, met)) {
        body_for(island, contact->a); /* its path is swept with the others */
        contact_queue_skip_pair(context->contacts, contact);
        return;
    }
    rest(context, contact);
    add_bodies(island, met);
    island->body[met->body_a].stays |= contact->last;
    if (met->body_b != BODY_FIXED)
        island->body[met->body_b].stays |= contact->last;
    island->met_count++;
}

/* Returns true if the next contact is of the same moment and is solved by impulses, so not one of
 * rounds or the ground. */
static bool same_moment(const struct response_context *context, const struct contact *next,
                        double toi)
{
    const struct entity *row = context->next->entities.row;
    return next && next->impact.toi <= toi + CONTACT_TIE && next->b < CONTACT_AIR &&
           row[next->a].behaviour != BEHAVIOUR_FLIGHT &&
           (next->b & PAIR_FIXED || row[next->b].behaviour != BEHAVIOUR_FLIGHT);
}

static void gather(struct response_context *context, const struct contact *first)
{
    struct contact contact = *first;
    take(context, &contact);
    while (same_moment(context, contact_queue_peek(context->contacts), first->impact.toi)) {
        contact_queue_next(context->contacts, &context->input, &contact);
        contact.impact.toi = first->impact.toi;
        if (contact.b & PAIR_FIXED &&
            !pair_filter_stands(&context->input.detect, contact.b & ~PAIR_FIXED))
            continue;
        take(context, &contact);
        work_done();
    }
}

/* --- contacts that last ------------------------------------------------------------------------*/

/* Takes one point of a contact between two bodies that rest on each other. */
static void take_point(struct response_context *context, const struct contact *contact)
{
    struct island *island = context->island;
    struct island_contact *met = next_contact(island);
    *met = (struct island_contact){.contact = *contact,
                                   .impact = response_impact(context, contact),
                                   .leans = true,
                                   .body_b = BODY_FIXED};
    add_bodies(island, met);
    island->met_count++;
}

struct behind_job {
    const struct response_context *context;
    const struct pair *behind;
    double time;
};

/* Measures how the bodies of contacts first .. end - 1 lie at this time. */
static void measure_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct behind_job *job = argument;
    const struct body_motion *motion = job->context->motion;
    const struct island *island = job->context->island;
    for (uint32_t i = first; i < end; i++) {
        struct level_gap gap[LEVEL_GAPS_MAX];
        struct free_turn turn_a, turn_b;
        const struct pair *pair = &job->behind[i];
        struct swept_body a = body_motion_body(motion, pair->a, &turn_a);
        struct swept_body b = body_motion_side(motion, pair->b, &turn_b);
        uint32_t index = contact_pairs_find(job->context->contacts, pair) - 1; /* it rests */
        uint32_t gaps = level_gap_find(&a, &b, job->time, CONTACT_TOUCHING_M,
                                       contact_queue_memory(job->context->contacts, index), gap);
        island->gap[i] = gaps > 0 ? gap[0] : (struct level_gap){.points = 0};
    }
    work_done_by(worker);
}

/* Takes the contact between two bodies that rest on each other, if they touch at this time. */
static void take_resting(struct response_context *context, const struct pair *pair,
                         const struct level_gap *gap, double time)
{
    struct contact_queue *contacts = context->contacts;
    uint32_t index = contact_queue_pair(contacts, pair);
    if (gap->points == 0 || contacts->marks[index] & CONTACT_GATHERED)
        return;
    contacts->marks[index] |= CONTACT_GATHERED | CONTACT_PRESSED;
    for (uint32_t i = 0; i < gap->points; i++) {
        const struct contact contact = {
            .a = pair->a,
            .b = pair->b,
            .pair = index + 1,
            .impact = {.toi = time, .point = gap->point[i], .normal = gap->normal}};
        take_point(context, &contact);
    }
}

/* Takes the listed contacts, until the island has so many. They are measured on all workers, at
 * most as many as there is room for if all of them touch at one point. */
static void take_near(struct response_context *context, uint32_t most, double time)
{
    struct island *island = context->island;
    for (uint32_t done = 0; done < island->near.count && island->met_count < most;) {
        uint32_t left = island->near.count - done, room = most - island->met_count;
        uint32_t some = left < room ? left : room;
        struct behind_job job = {context, &island->near.pair[done], time};
        thread_pool_run(context->contacts->workers, measure_some, &job, some, BEHIND_A_PIECE);
        for (uint32_t i = 0; i < some && island->met_count < most; i++)
            take_resting(context, &job.behind[i], &island->gap[i], time);
        done += some;
    }
}

/* Removes the pairs that both of their bodies have listed. */
static void list_once(struct pair_list *list)
{
    uint32_t kept = 0;
    sort_words(list->pair, list->count);
    for (uint32_t i = 0; i < list->count; i++) {
        struct pair pair = list->pair[i];
        if (kept == 0 || pair.a != list->pair[kept - 1].a || pair.b != list->pair[kept - 1].b)
            list->pair[kept++] = pair;
    }
    list->count = kept;
}

/* Lists the row's contacts that last and are not in the island. The order of the list is that of
 * the search for pairs. */
static void add_resting(struct island *island, const struct contact_queue *contacts, uint32_t row)
{
    const uint8_t either = CONTACT_RESTS | CONTACT_GATHERED;
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        uint32_t index = contacts->link[link - 1].pair;
        if ((contacts->marks[index] & either) == CONTACT_RESTS)
            pair_list_add(&island->near, contacts->pair[index].a, contacts->pair[index].b);
    }
}

/* An impact is passed on at once by bodies that rest on the struck ones: takes their contacts, and
 * those of the bodies behind them. */
static void gather_resting(struct response_context *context, double time)
{
    struct island *island = context->island;
    const struct contact_queue *contacts = context->contacts;
    uint32_t first = 0, impacts = island->met_count;
    for (uint32_t i = 0; i < impacts; i++)
        contacts->marks[island->met[i].contact.pair - 1] |= CONTACT_GATHERED;
    for (int hop = 0; hop < HOPS; hop++) {
        island->near.count = 0;
        for (uint32_t end = island->bodies; first < end; first++)
            add_resting(island, contacts, island->row[first]);
        list_once(&island->near);
        take_near(context, impacts + ISLAND_RESTING_MOST, time);
    }
    for (uint32_t i = 0; i < island->met_count; i++)
        contacts->marks[island->met[i].contact.pair - 1] &= (uint8_t)~CONTACT_GATHERED;
}

static void chain(struct island *island)
{
    for (uint32_t i = 0; i < island->met_count; i++) {
        struct island_body *root = &island->body[root_of(island, island->met[i].body_a)];
        if (root->last != 0)
            island->met[root->last - 1].next = i + 1;
        else
            root->first = i + 1;
        root->last = i + 1;
    }
}

void island_gather(struct response_context *context, const struct contact *contact)
{
    struct island *island = context->island;
    island->met_count = island->bodies = 0;
    gather(context, contact);
    gather_resting(context, contact->impact.toi);
    chain(island);
}
