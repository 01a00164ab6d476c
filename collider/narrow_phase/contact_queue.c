/* The frame's contacts in a heap, and the search for new ones after a change of path. */
#include "collider/narrow_phase/contact_queue.h"

#include "collider/method/method.h"
#include "collider/motion/ground_impact.h"
#include "collider/narrow_phase/contact_heap.h"
#include "collider/narrow_phase/contact_pairs.h"
#include "collider/narrow_phase/contact_rests.h"
#include "world/entity/kind.h"
#include "world/entity/remote.h"
#include "world/params.h"
#include "world/runtime/check.h"
#include "world/runtime/reserve.h"
#include "world/runtime/work_done.h"
#include "world/world.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>

#define PAIRS_A_PIECE  16
#define FLIERS_A_PIECE 128
#define DUE_A_PIECE    8u /* pairs of a change, most of which are near */
#define ROWS_A_PIECE   16

/* Fewer pairs of a change take less time than a meeting of two threads saves. */
#define DUE_SHARED 128u

/* Of so many searches that find no axis between two bodies, one looks for their nearest points. */
#define FAILED_A_SEARCH 8u

/* Gaps of near bodies are remembered up to this [m]. */
#define NEAR_M 0.3

/* Room for the points of resting pairs. A pair for which there is none is swept always. */
#define REST_POINTS_A_SLOT 8u

int contact_queue_init(struct contact_queue *contacts, const struct world *world,
                       struct thread_pool *workers)
{
    uint32_t rows = world->params->capacity, pairs = pair_filter_pairs_first(world);
    *contacts = (struct contact_queue){.workers = workers, .rows = rows, .pair_capacity = pairs};
    contacts->heap.capacity = 2 * contact_heap_most(contacts, pairs);
    contacts->heap.contact = reserve_take(contacts->heap.capacity, sizeof *contacts->heap.contact);
    contacts->pair = reserve_take(pairs, sizeof *contacts->pair);
    contacts->met = reserve_take(pairs, sizeof *contacts->met);
    contacts->swept = reserve_take(pairs, sizeof *contacts->swept);
    contacts->marks = reserve_take(pairs, sizeof *contacts->marks);
    contacts->impacts = reserve_take(pairs, sizeof *contacts->impacts);
    contacts->known = reserve_take(pairs, sizeof *contacts->known);
    contacts->searched = reserve_take(pairs, sizeof *contacts->searched);
    contacts->rested = reserve_take(pairs, sizeof *contacts->rested);
    contacts->rest = reserve_take(pairs, sizeof *contacts->rest);
    contacts->rest_capacity = REST_POINTS_A_SLOT * world->params->contact_slots;
    contacts->rest_point = reserve_take(contacts->rest_capacity, sizeof *contacts->rest_point);
    contacts->proves = world->params->collision.shape == SHAPE_MODEL &&
                       !method_discrete((enum method)world->params->collision.method);
    contacts->link = reserve_take(2 * (uint64_t)pairs, sizeof *contacts->link);
    contacts->due = reserve_take(pairs, sizeof *contacts->due);
    contacts->due_row = reserve_take(rows, sizeof *contacts->due_row);
    contacts->head = calloc(rows, sizeof *contacts->head);
    contacts->version = calloc(rows, sizeof *contacts->version);
    contacts->strayed = reserve_take(rows, sizeof *contacts->strayed);
    contacts->strays = calloc(rows, sizeof *contacts->strays);
    contacts->paired = calloc(rows, sizeof *contacts->paired);
    if (contacts->heap.contact && contacts->pair && contacts->met && contacts->swept &&
        contacts->marks && contacts->impacts && contacts->known && contacts->searched &&
        contacts->rested && contacts->rest && contacts->rest_point && contacts->due &&
        contacts->due_row && contacts->link && contacts->head && contacts->version &&
        contacts->strayed && contacts->strays && contacts->paired &&
        pair_apart_init(&contacts->apart, world) == 0 &&
        axis_memory_init(&contacts->axes, world) == 0 &&
        gap_memory_init(&contacts->gaps, world) == 0 &&
        alone_rows_init(&contacts->alone, world, workers) == 0 &&
        pair_list_init(&contacts->near, broad_phase_found_most(world)) == 0)
        return 0;
    contact_queue_free(contacts);
    errno = ENOMEM;
    return -1;
}

void contact_queue_free(struct contact_queue *contacts)
{
    reserve_free(contacts->heap.contact);
    reserve_free(contacts->pair);
    reserve_free(contacts->met);
    reserve_free(contacts->swept);
    reserve_free(contacts->marks);
    reserve_free(contacts->impacts);
    reserve_free(contacts->known);
    reserve_free(contacts->searched);
    reserve_free(contacts->rested);
    reserve_free(contacts->rest);
    reserve_free(contacts->rest_point);
    pair_apart_free(&contacts->apart);
    axis_memory_free(&contacts->axes);
    gap_memory_free(&contacts->gaps);
    reserve_free(contacts->due);
    reserve_free(contacts->due_row);
    reserve_free(contacts->link);
    free(contacts->head);
    free(contacts->version);
    reserve_free(contacts->strayed);
    free(contacts->strays);
    free(contacts->paired);
    pair_list_free(&contacts->near);
    alone_rows_free(&contacts->alone);
    *contacts = (struct contact_queue){0};
}

/* --- a frame -----------------------------------------------------------------------------------*/

void contact_queue_begin(struct contact_queue *contacts, const struct pair_list *lists,
                         uint32_t list_count)
{
    for (uint32_t i = 0; i < contacts->stray_count; i++)
        contacts->strays[contacts->strayed[i]] = 0;
    contacts->heap.count = 0;
    contacts->stray_count = 0;
    contacts->change = 0;
    contacts->rest_points = contacts->rested_count = 0;
    contacts->due_count = contacts->due_rows = 0;
    contact_pairs_begin(contacts, lists, list_count);
}

/* Remembers what a dear search has found that keeps a pair apart, or that it has found nothing.
 * Most find what was remembered, and are not counted. */
static void remember(struct contact_queue *contacts, uint32_t index)
{
    uint32_t searched = contacts->searched[index];
    if (searched > 0)
        axis_memory_keep(&contacts->axes,
                         &(struct remembered_axis){.pair = contacts->pair[index],
                                                   .axis = contacts->known[index].plane[0],
                                                   .failed = searched - 1});
}

void contact_queue_end(struct contact_queue *contacts)
{
    const struct pair *pair = contacts->pair;
    uint32_t *head = contacts->head;
    for (uint32_t i = 0; i < contacts->pair_count; i++)
        remember(contacts, i);
    for (uint32_t i = 0, count = contacts->pair_count; i < count; i++) {
        uint32_t a = pair[i].a, b = pair[i].b & PAIR_FIXED ? a : pair[i].b;
        head[a] = head[b] = 0;
        pair_apart_let_go(&contacts->apart, a);
        pair_apart_let_go(&contacts->apart, b);
    }
    pair_apart_end(&contacts->apart);
    gap_memory_settle(&contacts->gaps);
}

/* --- finding -----------------------------------------------------------------------------------*/

/* Returns true if the nearest points of two bodies show an axis that keeps them apart, or that
 * which was found in the last frame does. Where no search has found one lately, most are left out.
 */
static bool search_axis(struct contact_queue *contacts, uint32_t index, double from)
{
    const struct pair *pair = &contacts->pair[index];
    struct pair_known *known = &contacts->known[index];
    struct remembered_axis last = axis_memory_recall(&contacts->axes, pair);
    struct vec3 axis = last.axis;
    bool nearest = last.failed % FAILED_A_SEARCH == 0;
    bool found =
        pair_apart_stays(&contacts->apart, pair, from, SKIN_M, nearest, &axis, &known->stays_m);
    if (found)
        known->plane[0] = axis;
    bool same =
        last.failed == 0 && axis.x == last.axis.x && axis.y == last.axis.y && axis.z == last.axis.z;
    contacts->searched[index] = !found ? last.failed + 2 : same ? 0 : 1;
    return found;
}

/* Returns true for two rows on the paths with which the frame began, and whose poses are known. */
static bool may_remember(const struct contact_queue *contacts, const struct pair *pair, double from)
{
    return from == 0.0 && !(pair->b & PAIR_FIXED) &&
           !pair_apart_pose(&contacts->apart, pair->a)->freely &&
           !pair_apart_pose(&contacts->apart, pair->b)->freely;
}

/* Returns how far the points of a row come within the frame by rotation, at most [m]. */
static double turned_m(const struct row_pose *pose)
{
    return pose->rate * pose->body.bound_m;
}

/* Returns true if bodies that were apart when the frame began, or when they were last measured, do
 * not come as far. */
static bool comes_short(struct contact_queue *contacts, uint32_t index, double from)
{
    const struct pair *pair = &contacts->pair[index];
    struct pair_known *known = &contacts->known[index];
    if (!may_remember(contacts, pair, from))
        return false;
    const struct row_pose *a = pair_apart_pose(&contacts->apart, pair->a);
    const struct row_pose *b = pair_apart_pose(&contacts->apart, pair->b);
    struct vec3 along = vec3_sub(b->body.path.along, a->body.path.along);
    struct gap_bounds gap = gap_memory_recall(&contacts->gaps, pair, &a->body, &b->body);
    known->apart_m = maths_max(known->apart_m, gap.least_m);
    known->stays_m = known->apart_m - vec3_length(along) - turned_m(a) - turned_m(b);
    return known->stays_m > 2.0 * SKIN_M;
}

/* Remembers how far bodies that do not meet are apart when the frame begins. */
static void remember_gap(struct contact_queue *contacts, const struct pair *pair, double from)
{
    if (!may_remember(contacts, pair, from) || !gap_memory_wants(&contacts->gaps, pair))
        return;
    const struct swept_body *a = &pair_apart_pose(&contacts->apart, pair->a)->body;
    const struct swept_body *b = &pair_apart_pose(&contacts->apart, pair->b)->body;
    double gap_m = time_of_impact_gap_up_to(a, b, 0.0, NEAR_M);
    gap_memory_note(&contacts->gaps, pair, a, b, gap_m, NEAR_M);
}

/* Returns true if the bodies of a pair certainly stay apart from a time on. */
static bool stays_apart(struct contact_queue *contacts, uint32_t index, double from)
{
    const struct pair *pair = &contacts->pair[index];
    struct pair_known *known = &contacts->known[index];
    if (!pair_apart_stays(&contacts->apart, pair, from, SKIN_M, false, &known->plane[0],
                          &known->stays_m) &&
        !comes_short(contacts, index, from) && !search_axis(contacts, index, from))
        return false;
    known->version_a = contacts->version[pair->a];
    known->version_b = pair->b & PAIR_FIXED ? 0 : contacts->version[pair->b];
    return true;
}

/* Returns true if a side of a pair, whose pose is known, stays where it is. */
static bool lies_still(const struct contact_queue *contacts, uint32_t side)
{
    if (side & PAIR_FIXED)
        return true;
    const struct row_pose *pose = pair_apart_pose(&contacts->apart, side);
    struct vec3 along = pose->body.path.along;
    return along.x == 0.0 && along.y == 0.0 && along.z == 0.0 && pose->rate == 0.0 && !pose->freely;
}

/* Sweeps one pair from a time on. Returns true, with the contact, if there is one. Bodies that rest
 * on each other touch all the time: they are swept only if they may get into each other. */
static bool sweep_pair(struct contact_queue *contacts, const struct contact_input *input,
                       uint32_t index, double from, struct contact *contact)
{
    const struct pair *pair = &contacts->pair[index];
    const struct entity *row = input->detect.entities->row;
    bool fixed = pair->b & PAIR_FIXED;
    if (contacts->met[index] >= input->meets || row[pair->a].state == ENTITY_FREE ||
        (!fixed && row[pair->b].state == ENTITY_FREE) ||
        (fixed && !pair_filter_stands(&input->detect, pair->b & ~PAIR_FIXED)))
        return false;
    if (contacts->marks[index] & CONTACT_PARTS ||
        (contacts->proves && contact_rests_still(contacts, input, index)))
        return false;
    /* Bodies that do not approach have no impact, however near they are. */
    if (contacts->proves && lies_still(contacts, pair->a) && lies_still(contacts, pair->b))
        return false;
    if (contacts->proves && stays_apart(contacts, index, from))
        return false;
    *contact = (struct contact){.a = pair->a,
                                .b = pair->b,
                                .pair = index + 1,
                                .version_a = contacts->version[pair->a],
                                .version_b = fixed ? 0 : contacts->version[pair->b]};
    if (narrow_phase_find(&input->detect, input->motion, input->through_fixed, pair, from,
                          &contact->impact))
        return !(contacts->marks[index] & CONTACT_RESTS && contact_rests_on(input, contact));
    if (contacts->proves)
        remember_gap(contacts, pair, from);
    return false;
}

bool contact_queue_stays_apart(const struct contact_queue *contacts, uint32_t pair)
{
    const struct pair *bodies = &contacts->pair[pair];
    const struct pair_known *known = &contacts->known[pair];
    return known->version_a == contacts->version[bodies->a] &&
           (bodies->b & PAIR_FIXED || known->version_b == contacts->version[bodies->b]);
}

/* Lists a row of which the proofs need something, if its path has changed. */
static void list_row(struct contact_queue *contacts, uint32_t row)
{
    if (contacts->proves && !(row & PAIR_FIXED) && pair_apart_claims(&contacts->apart, row))
        contacts->due_row[contacts->due_rows++] = row;
}

static void list_rows(struct contact_queue *contacts, uint32_t pair)
{
    list_row(contacts, contacts->pair[pair].a);
    list_row(contacts, contacts->pair[pair].b);
}

struct job {
    struct contact_queue *contacts;
    const struct contact_input *input;
    uint64_t tick;
    double from;
    _Atomic uint32_t found; /* contacts in the heap's array, unordered */
};

static void prepare_some(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = context;
    (void)worker;
    for (uint32_t i = first; i < end; i++) {
        uint32_t row = job->contacts->due_row[i];
        body_motion_note_poses(job->input->motion, row);
        pair_apart_prepare(&job->contacts->apart, job->input->motion, row);
    }
}

/* Computes what the proofs need of the listed rows. */
static void prepare_rows(struct job *job)
{
    struct contact_queue *contacts = job->contacts;
    thread_pool_run(contacts->workers, prepare_some, job, contacts->due_rows, ROWS_A_PIECE);
    contacts->due_rows = 0;
}

static void note(struct job *job, const struct contact *contact)
{
    struct contact_list *heap = &job->contacts->heap;
    uint32_t place = atomic_fetch_add_explicit(&job->found, 1, memory_order_relaxed);
    CHECK(place < heap->capacity);
    heap->contact[place] = *contact;
}

static void find_some(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    struct contact contact;
    for (uint32_t i = first; i < end; i++) {
        if (!(job->contacts->marks[i] & CONTACT_RESTS) &&
            sweep_pair(job->contacts, job->input, i, 0.0, &contact))
            note(job, &contact);
        if (i % PAIRS_A_PIECE == 0)
            work_done_by(worker);
    }
}

/* Adds what the function finds for count things, at most `each` for one of them, to the heap. */
static void find_all(struct job *job, thread_pool_function *find, uint32_t count, uint32_t each,
                     uint32_t grain)
{
    struct contact_queue *contacts = job->contacts;
    contact_heap_make_room(&contacts->heap, count * each);
    job->found = contacts->heap.count;
    thread_pool_run(contacts->workers, find, job, count, grain);
    contacts->heap.count = job->found;
    contact_heap_order(&contacts->heap);
}

void contact_queue_find(struct contact_queue *contacts, const struct contact_input *input)
{
    struct job job = {.contacts = contacts, .input = input};
    for (uint32_t i = 0; i < contacts->pair_count; i++)
        list_rows(contacts, i);
    prepare_rows(&job);
    find_all(&job, find_some, contacts->pair_count, 1, PAIRS_A_PIECE);
}

static struct contact end_of(const struct contact_queue *contacts, uint32_t row, uint32_t what,
                             double toi)
{
    return (struct contact){
        .impact.toi = toi, .a = row, .b = what, .version_a = contacts->version[row]};
}

void contact_queue_add_end(struct contact_queue *contacts, uint32_t row, uint32_t what, double toi)
{
    const struct contact contact = end_of(contacts, row, what, toi);
    contact_heap_push(contacts, &contact);
}

void contact_queue_ground(struct contact_queue *contacts, const struct contact_input *input,
                          uint32_t row)
{
    const struct entities *e = input->detect.entities;
    double toi;
    bool flies = e->row[row].behaviour == BEHAVIOUR_FLIGHT ||
                 (input->detect.world->kinds[e->row[row].kind].domain == DOMAIN_AIR &&
                  !(e->row[row].flags & ENTITY_FLAG_LANDED));
    if (flies && e->row[row].state == ENTITY_ACTIVE &&
        ground_impact_row(&input->detect, input->motion, row, &toi))
        contact_queue_add_end(contacts, row, CONTACT_GROUND, toi);
}

static void find_end(struct job *job, uint32_t row)
{
    const struct entities *e = job->input->detect.entities;
    struct contact contact;
    double toi;
    if (ground_impact_row(&job->input->detect, job->input->motion, row, &toi)) {
        contact = end_of(job->contacts, row, CONTACT_GROUND, toi);
        note(job, &contact);
    }
    if (e->row[row].behaviour != BEHAVIOUR_FLIGHT || remote_is(e, row) ||
        job->tick < e->row[row].until_tick)
        return;
    contact = end_of(job->contacts, row, CONTACT_AIR, 1.0);
    note(job, &contact);
}

/* Tests fliers first .. end - 1, counted over all sweepers. */
static void find_some_ends(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct job *job = context;
    const struct broad_phase *broad = job->input->broad;
    uint32_t before = 0;
    (void)worker;
    for (uint32_t s = 0; s < broad->sweepers; s++) {
        const struct pair_list *fliers = &broad->sweeper[s].fliers;
        uint32_t i = first > before ? first - before : 0;
        for (; i < fliers->count && before + i < end; i++)
            find_end(job, fliers->pair[i].a);
        before += fliers->count;
    }
}

void contact_queue_find_ends(struct contact_queue *contacts, const struct contact_input *input,
                             uint64_t tick)
{
    struct job job = {.contacts = contacts, .input = input, .tick = tick};
    uint32_t count = 0;
    for (uint32_t i = 0; i < input->broad->sweepers; i++)
        count += input->broad->sweeper[i].fliers.count;
    find_all(&job, find_some_ends, count, CONTACT_HEAP_ENDS, FLIERS_A_PIECE);
}

const struct contact *contact_queue_peek(struct contact_queue *contacts)
{
    while (contacts->heap.count > 0) {
        const struct contact *first = &contacts->heap.contact[0];
        if (contact_heap_is_valid(contacts, first))
            return first;
        contact_heap_pop(contacts);
    }
    return NULL;
}

bool contact_queue_next(struct contact_queue *contacts, const struct contact_input *input,
                        struct contact *contact)
{
    const struct contact *first = contact_queue_peek(contacts);
    if (!first)
        return false;
    *contact = *first;
    contact_heap_pop(contacts);
    contact->last = contact->pair != 0 && ++contacts->met[contact->pair - 1] >= input->meets;
    return true;
}

void contact_queue_skip_pair(struct contact_queue *contacts, const struct contact *contact)
{
    contacts->swept[contact->pair - 1] = contacts->change + 1;
}

/* --- another way -------------------------------------------------------------------------------*/

uint32_t contact_queue_pair(struct contact_queue *contacts, const struct pair *pair)
{
    uint32_t known = contact_pairs_find(contacts, pair);
    return known != 0 ? known - 1 : contact_pairs_add(contacts, *pair);
}

struct resting_known *contact_queue_rested(struct contact_queue *contacts, uint32_t pair)
{
    uint32_t *rested = &contacts->known[pair].rested;
    if (*rested == 0) {
        *rested = ++contacts->rested_count;
        contacts->rested[*rested - 1] = (struct resting_known){.gap = 0};
    }
    return &contacts->rested[*rested - 1];
}

void contact_queue_rest(struct contact_queue *contacts, uint32_t pair,
                        const struct rest_point *point, uint32_t count)
{
    contacts->marks[pair] |= CONTACT_RESTS;
    contacts->rest[pair] = (struct rest_span){contacts->rest_points, 0};
    for (uint32_t i = 0; i < count && contacts->rest_points < contacts->rest_capacity; i++) {
        contacts->rest_point[contacts->rest_points++] = point[i];
        contacts->rest[pair].count++;
    }
    if (contacts->rest[pair].count < count)
        contacts->rest[pair].count = 0;
}

void contact_queue_look(struct contact_queue *contacts, const struct contact_input *input,
                        uint32_t row, bool resting)
{
    if (!method_discrete((enum method)input->detect.world->params->collision.method))
        contact_pairs_look(contacts, input, row, resting, 0.0f);
}

void contact_queue_find_alone(struct contact_queue *contacts, const struct contact_input *input,
                              const uint32_t *row, uint32_t count)
{
    if (!method_discrete((enum method)input->detect.world->params->collision.method))
        alone_rows_find(&contacts->alone, input, row, count);
}

void contact_queue_look_wider(struct contact_queue *contacts, const struct contact_input *input,
                              uint32_t row, double wider_m)
{
    if (!method_discrete((enum method)input->detect.world->params->collision.method))
        contact_pairs_look(contacts, input, row, true, (float)wider_m);
}

/* Lists the row's pairs, except those that this change has already listed from the other row. */
static void list_pairs(struct contact_queue *contacts, uint32_t row)
{
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        uint32_t pair = contacts->link[link - 1].pair;
        if (contacts->swept[pair] == contacts->change)
            continue;
        contacts->swept[pair] = contacts->change;
        contacts->due[contacts->due_count++].pair = pair;
        list_rows(contacts, pair);
    }
}

static void sweep_due(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = context;
    for (uint32_t i = first; i < end; i++) {
        struct due_pair *due = &job->contacts->due[i];
        due->meets = sweep_pair(job->contacts, job->input, due->pair, job->from, &due->contact);
    }
    work_done_by(worker);
}

void contact_queue_change(struct contact_queue *contacts, const struct contact_input *input,
                          const uint32_t *rows, uint32_t count, double time)
{
    enum method method = (enum method)input->detect.world->params->collision.method;
    struct job job = {.contacts = contacts, .input = input, .from = time};
    contacts->change++;
    contacts->due_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        contacts->version[rows[i]]++;
        pair_apart_forget(&contacts->apart, rows[i]);
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!method_discrete(method))
            contact_pairs_look(contacts, input, rows[i], false, 0.0f);
        list_pairs(contacts, rows[i]);
        work_done();
    }
    prepare_rows(&job);
    thread_pool_run(contacts->workers, sweep_due, &job, contacts->due_count,
                    contacts->due_count < DUE_SHARED ? DUE_SHARED : DUE_A_PIECE);
    for (uint32_t i = 0; i < contacts->due_count; i++) {
        if (contacts->due[i].meets)
            contact_heap_push(contacts, &contacts->due[i].contact);
    }
    for (uint32_t i = 0; i < count; i++)
        contact_queue_ground(contacts, input, rows[i]);
}

void contact_queue_drop(struct contact_queue *contacts, uint32_t row)
{
    contacts->version[row]++;
    pair_apart_forget(&contacts->apart, row);
}
