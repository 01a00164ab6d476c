/* A list of rows, a test of each pair of them on all workers, and a push for each that overlaps. */
#include "collider/resting/aircraft_parting.h"

#include "collider/narrow_phase/contact_pairs.h"
#include "collider/narrow_phase/cruise_rows.h"
#include "collider/response/contact_impulse.h"
#include "collider/response/contact_table.h"
#include "collider/resting/deep_pair.h"
#include "collider/resting/resting.h"
#include "world/entity/persistent_contact.h"
#include "world/maths/sort.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/thread_pool.h"
#include "world/runtime/work_done.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

/* A pair parts at this speed at most. An aircraft of a crowd goes as the pairs that it is in push
 * it together, and no faster than this. */
#define PAIR_MPS 10.0
#define MOST_MPS 20.0

/* A pair that is less deep parts by this share of its depth and of the gap that it is to have. */
#define SHARE 0.5

/* Fewer pairs that begin to overlap in one frame are left to impacts, which bring no aircraft
 * deeper into another one. Their number grows faster than that of the pairs: those of 190 took 0.2
 * s in a frame, and those of 4,950 2 s. */
#define CROWD_PAIRS 32u

/* Aircraft that have begun to part go on until they overlap by no more than this [m]. */
#define ROUNDING_M 1e-5

#define PAIRS_A_PIECE 8u
#define ROWS_A_PIECE  16u

int aircraft_parting_init(struct aircraft_parting *parting, const struct world *world,
                          struct thread_pool *workers)
{
    uint32_t rows = world->params->capacity;
    *parting = (struct aircraft_parting){.workers = workers,
                                         .pair_capacity = pair_filter_pairs_first(world)};
    parting->row = reserve_take(rows, sizeof *parting->row);
    parting->body = reserve_take(rows, sizeof *parting->body);
    parting->pair = reserve_take(parting->pair_capacity, sizeof *parting->pair);
    parting->body_of = calloc(rows, sizeof *parting->body_of);
    if (pair_list_init(&parting->list, parting->pair_capacity) == 0 && parting->row &&
        parting->body && parting->pair && parting->body_of)
        return 0;
    aircraft_parting_free(parting);
    errno = ENOMEM;
    return -1;
}

void aircraft_parting_free(struct aircraft_parting *parting)
{
    pair_list_free(&parting->list);
    reserve_free(parting->row);
    reserve_free(parting->body);
    reserve_free(parting->pair);
    free(parting->body_of);
    *parting = (struct aircraft_parting){.rows = 0};
}

/* --- rows --------------------------------------------------------------------------------------*/

static void add_row(struct aircraft_parting *parting, struct response_context *context,
                    uint32_t row)
{
    if (parting->body_of[row] != 0)
        return;
    parting->row[parting->rows++] = row;
    parting->body_of[row] = parting->rows;
    body_motion_require(context->motion, row);
}

/* Returns true if a contact is one of two aircraft. */
static bool is_of_aircraft(const struct response_context *context,
                           const struct persistent_contact *contact)
{
    const struct entities *e = &context->next->entities;
    return !(contact->b_id & PERSISTENT_CONTACT_FIXED) &&
           entities_alive(e, contact->a_row, contact->a_id) &&
           entities_alive(e, contact->b_row, contact->b_id) &&
           contact_groups_flies(context, contact->a_row) &&
           contact_groups_flies(context, contact->b_row);
}

/* Lists the rows of the contacts that parted a frame ago, and those that touch them, directly or
 * not: if these bounded them, those in the middle of a crowd would stay. */
static void add_parted(struct aircraft_parting *parting, struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    uint32_t count = context->contacts_sleep ? 0 : committed->head->contact_count;
    bool any = false;
    for (uint32_t i = 0; i < count; i++) {
        const struct persistent_contact *contact = &committed->contacts[i];
        if (!(contact->flags & PERSISTENT_CONTACT_PARTS) || !is_of_aircraft(context, contact))
            continue;
        add_row(parting, context, contact->a_row);
        add_row(parting, context, contact->b_row);
        any = true;
    }
    for (uint32_t known = 0; any && known < parting->rows;) {
        known = parting->rows;
        for (uint32_t i = 0; i < count; i++) {
            const struct persistent_contact *contact = &committed->contacts[i];
            if ((parting->body_of[contact->a_row] == 0) ==
                    (contact->b_id & PERSISTENT_CONTACT_FIXED ||
                     parting->body_of[contact->b_row] == 0) ||
                !is_of_aircraft(context, contact))
                continue;
            add_row(parting, context, contact->a_row);
            add_row(parting, context, contact->b_row);
        }
    }
}

static void forget_rows(struct aircraft_parting *parting)
{
    for (uint32_t i = 0; i < parting->rows; i++)
        parting->body_of[parting->row[i]] = 0;
    parting->rows = parting->list.count = 0;
}

/* --- pairs -------------------------------------------------------------------------------------*/

/* Lists the row's pairs with another listed aircraft once, and those of a new one with all. */
static void add_pairs_of(struct aircraft_parting *parting, struct response_context *context,
                         uint32_t index)
{
    const struct contact_queue *contacts = context->contacts;
    uint32_t row = parting->row[index];
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        const struct pair *pair = &contacts->pair[contacts->link[link - 1].pair];
        uint32_t other = pair->a == row ? pair->b : pair->a;
        if (other & PAIR_FIXED || !contact_groups_flies(context, other))
            continue;
        if (parting->body_of[other] == 0 && index < parting->fresh)
            add_row(parting, context, other);
        if (parting->body_of[other] > index + 1)
            pair_list_add(&parting->list, pair->a, pair->b);
    }
}

static void add_pairs(struct aircraft_parting *parting, struct response_context *context)
{
    parting->listed = parting->rows;
    for (uint32_t i = 0; i < parting->listed; i++)
        contact_queue_look(context->contacts, &context->input, parting->row[i], true);
    for (uint32_t i = 0; i < parting->listed; i++)
        add_pairs_of(parting, context, i);
    sort_words(parting->list.pair, parting->list.count);
    if (parting->list.count > parting->pair_capacity) {
        parting->pair_capacity = 2 * (uint64_t)parting->list.count;
        parting->pair =
            reserve_grow(parting->pair, 0, parting->pair_capacity, sizeof *parting->pair);
    }
}

struct job {
    struct aircraft_parting *parting;
    const struct response_context *context;
};

/* Finds how rows first .. end - 1 stand when the frame begins. */
static void stand_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = argument;
    (void)worker;
    const struct aircraft_parting *parting = job->parting;
    for (uint32_t i = first; i < end; i++) {
        struct aircraft_body *body = &parting->body[i];
        uint32_t row = parting->row[i];
        const struct body_motion *motion = job->context->motion;
        *body = (struct aircraft_body){
            .body = body_motion_standing(motion, body_motion_before(motion, row), row),
            .parts = i >= parting->fresh && i < parting->listed};
        body->turn = level_gap_turn(&body->body, 0.0);
    }
}

/* Returns true if two aircraft overlap by more than so much. The gap is right up to the depth that
 * they part by in a frame. */
static bool overlap(const struct aircraft_body *a, const struct aircraft_body *b, double least_m,
                    double enough_m, struct level_gap *gap)
{
    struct vec3 between = vec3_sub(b->body.path.at, a->body.path.at);
    double reach = a->body.bound_m + b->body.bound_m;
    const struct turned_body turned_a = {&a->body, a->turn}, turned_b = {&b->body, b->turn};
    return vec3_dot(between, between) < reach * reach &&
           level_gap_deepest(&turned_a, &turned_b, least_m, enough_m, gap);
}

/* Tests pairs first .. end - 1. */
static void test_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = argument;
    struct aircraft_parting *parting = job->parting;
    double enough_m = PAIR_MPS * world_dt_s(job->context->world) / SHARE;
    (void)worker;
    for (uint32_t i = first; i < end; i++) {
        const struct pair *pair = &parting->list.pair[i];
        struct aircraft_pair *one = &parting->pair[i];
        uint32_t a = parting->body_of[pair->a] - 1, b = parting->body_of[pair->b] - 1;
        bool fresh = a < parting->fresh || b < parting->fresh;
        one->pair = contact_pairs_find(job->context->contacts, pair);
        one->known = contact_table_find(job->context, pair->a, pair->b) != NULL;
        one->fresh = fresh;
        one->overlaps = overlap(&parting->body[a], &parting->body[b],
                                fresh ? RESTING_PARTS_M : ROUNDING_M, enough_m, &one->gap);
    }
    work_done();
}

/* --- wishes ------------------------------------------------------------------------------------*/

static double mass_of(const struct response_context *context, uint32_t row)
{
    return contact_impulse_kind(context, row)->mass_kg;
}

/* Pushes two aircraft apart, the lighter one by more. */
static void push(struct aircraft_parting *parting, const struct response_context *context,
                 const struct pair *pair, double depth_m)
{
    double speed =
        maths_min(PAIR_MPS, SHARE * (depth_m + CONTACT_REST_M) / world_dt_s(context->world));
    struct aircraft_body *a = &parting->body[parting->body_of[pair->a] - 1];
    struct aircraft_body *b = &parting->body[parting->body_of[pair->b] - 1];
    double mass_a = mass_of(context, pair->a), mass_b = mass_of(context, pair->b);
    double ax, az, bx, bz;
    deep_pair_place(context, pair->a, &ax, &az);
    deep_pair_place(context, pair->b, &bx, &bz);
    struct vec3 line = {bx - ax, 0.0, bz - az};
    line = vec3_scale(line, speed / (vec3_length(line) * (mass_a + mass_b)));
    a->wish_mps = vec3_sub(a->wish_mps, vec3_scale(line, mass_b));
    b->wish_mps = vec3_add(b->wish_mps, vec3_scale(line, mass_a));
    a->parts = b->parts = true;
}

/* Marks a pair of two aircraft that part, from each other or from others. */
static void mark(struct response_context *context, const struct pair *pair,
                 struct aircraft_pair *one)
{
    uint8_t *marks = &context->contacts->marks[one->pair - 1];
    *marks |= CONTACT_PARTS | CONTACT_CAPSULES;
    if (!one->overlaps)
        return;
    *marks |= CONTACT_PRESSED | CONTACT_OVERLAPS;
    one->gap.point[0] = vec3_lerp(context->path[pair->a].at, context->path[pair->b].at, 0.5);
    if (!one->known && contact_table_begins(context, one->pair))
        resting_report(context, pair, &one->gap);
}

/* Counts the pairs that overlap. If those that are new are few, they are left to impacts. */
static uint32_t count_overlaps(struct aircraft_parting *parting)
{
    uint32_t count = 0, fresh = 0;
    for (uint32_t i = 0; i < parting->list.count; i++)
        fresh += parting->pair[i].fresh && parting->pair[i].overlaps;
    for (uint32_t i = 0; i < parting->list.count; i++) {
        parting->pair[i].overlaps &= !parting->pair[i].fresh || fresh >= CROWD_PAIRS;
        count += parting->pair[i].overlaps;
    }
    return count;
}

/* Returns true if two aircraft part, from each other or from others. */
static bool part(const struct aircraft_parting *parting, const struct pair *pair)
{
    return parting->body[parting->body_of[pair->a] - 1].parts &&
           parting->body[parting->body_of[pair->b] - 1].parts;
}

void aircraft_parting_find(struct aircraft_parting *parting, struct response_context *context,
                           const uint32_t *fresh, uint32_t count)
{
    struct job job = {parting, context};
    forget_rows(parting);
    for (uint32_t i = 0; i < count; i++)
        add_row(parting, context, fresh[i]);
    parting->fresh = parting->rows;
    add_parted(parting, context);
    if (parting->rows == 0)
        return;
    add_pairs(parting, context);
    thread_pool_run(parting->workers, stand_some, &job, parting->rows, ROWS_A_PIECE);
    thread_pool_run(parting->workers, test_some, &job, parting->list.count, PAIRS_A_PIECE);
    bool crowded = count_overlaps(parting) >= CROWD_PAIRS;
    for (uint32_t i = 0; i < parting->list.count; i++) {
        if (parting->pair[i].overlaps)
            push(parting, context, &parting->list.pair[i], -parting->pair[i].gap.gap_m);
    }
    for (uint32_t i = 0; i < parting->list.count; i++) {
        const struct pair *pair = &parting->list.pair[i];
        if (parting->pair[i].overlaps || (crowded && part(parting, pair)))
            mark(context, pair, &parting->pair[i]);
    }
}

/* Displaces one row. */
static void go(struct response_context *context, uint32_t row, struct vec3 wish_mps)
{
    double dt_s = world_dt_s(context->world), speed = vec3_length(wish_mps);
    struct vec3 at = entities_position(&context->next->entities, row);
    struct vec3 way = vec3_scale(wish_mps, dt_s * maths_min(1.0, MOST_MPS / speed));
    cruise_rows_stop(&context->input, row);
    at.x = world_clamp(context->world, at.x + way.x);
    at.z = world_clamp(context->world, at.z + way.z);
    table_set_position(&context->writer, row, at);
    body_motion_compute(context->motion, row);
    contact_queue_ground(context->contacts, &context->input, row);
}

uint32_t aircraft_parting_go(struct aircraft_parting *parting, struct response_context *context,
                             uint32_t *moved, uint32_t count)
{
    for (uint32_t i = 0; i < parting->rows; i++) {
        uint32_t row = parting->row[i];
        const struct aircraft_body *body = &parting->body[i];
        if (vec3_dot(body->wish_mps, body->wish_mps) == 0.0)
            continue;
        go(context, row, body->wish_mps);
        contact_queue_look(context->contacts, &context->input, row, false);
        moved[count++] = row;
    }
    return count;
}
