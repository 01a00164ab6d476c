/* A search for those that are in each other, one for what is near where they end the frame, and the
 * steps of bodies on the ground. */
#include "collider/parting/aircraft_parting.h"

#include "collider/narrow_phase/contact_pairs.h"
#include "collider/narrow_phase/cruise_rows.h"
#include "collider/parting/made_way.h"
#include "collider/response/contact_impulse.h"
#include "collider/response/contact_table.h"
#include "collider/resting/deep_pair.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/remote.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/thread_pool.h"
#include "world/runtime/work_done.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>

/* Nobody goes faster than this (collider/resting/parting_wishes.c). */
#define MOST_MPS 20.0

/* Two go on until they overlap by no more than this [m]. */
#define ROUNDING_M 1e-5

/* Two that part end so far apart, so that their pilots do not press on each other at once [m]. */
#define APART_M 0.1

#define PAIRS_A_PIECE 8u
#define ROWS_A_PIECE  16u

int aircraft_parting_init(struct aircraft_parting *parting, const struct world *world,
                          struct thread_pool *workers)
{
    uint32_t rows = world->params->capacity, pairs = pair_filter_pairs_first(world);
    *parting = (struct aircraft_parting){
        .workers = workers, .parted_capacity = pairs, .point_capacity = pairs};
    parting->body = reserve_take(rows, sizeof *parting->body);
    parting->pair = reserve_take(pairs, sizeof *parting->pair);
    parting->level = reserve_take(rows, sizeof *parting->level);
    parting->level_row = reserve_take(rows, sizeof *parting->level_row);
    parting->parted = reserve_take(pairs, sizeof *parting->parted);
    parting->point = reserve_take(pairs, sizeof *parting->point);
    if (parting_rows_init(&parting->rows, world) == 0 &&
        pair_list_init(&parting->deep, pairs) == 0 && level_exit_init(&parting->exit) == 0 &&
        crowds_init(&parting->crowds, world) == 0 &&
        parting_init(&parting->steps, rows, pairs) == 0 && parting->body && parting->pair &&
        parting->level && parting->level_row && parting->parted && parting->point)
        return 0;
    aircraft_parting_free(parting);
    errno = ENOMEM;
    return -1;
}

void aircraft_parting_free(struct aircraft_parting *parting)
{
    parting_rows_free(&parting->rows);
    pair_list_free(&parting->deep);
    level_exit_free(&parting->exit);
    crowds_free(&parting->crowds);
    parting_free(&parting->steps);
    reserve_free(parting->body);
    reserve_free(parting->pair);
    reserve_free(parting->level);
    reserve_free(parting->level_row);
    reserve_free(parting->parted);
    reserve_free(parting->point);
    *parting = (struct aircraft_parting){.fresh = 0};
}

/* --- rows and pairs ----------------------------------------------------------------------------*/

static void add_row(struct aircraft_parting *parting, struct response_context *context,
                    uint32_t row)
{
    if (!parting_rows_add(&parting->rows, row))
        return;
    cruise_rows_stop(&context->input, row);
    body_motion_require(context->motion, row);
    struct aircraft_body *body = &parting->body[parting->rows.count - 1];
    body->in = body->level = 0;
    body->parent = parting->rows.count - 1;
    body->kg = 0.0;
    body->way = body->momentum = (struct vec3){0.0, 0.0, 0.0};
}

struct aircraft_body *aircraft_parting_body(const struct aircraft_parting *parting, uint32_t row)
{
    return &parting->body[parting->rows.place[row] - 1];
}

/* Returns the other row of a linked pair that is in the air, too, or SLOT_NONE. */
static uint32_t other_of(const struct response_context *context, uint32_t link, uint32_t row)
{
    const struct contact_queue *contacts = context->contacts;
    const struct pair *pair = &contacts->pair[contacts->link[link - 1].pair];
    uint32_t other = pair->a == row ? pair->b : pair->a;
    return other & PAIR_FIXED || !contact_groups_in_air(context, other) ? SLOT_NONE : other;
}

/* Lists a pair of two listed rows once: from the row that was listed first. */
static void add_pair(struct aircraft_parting *parting, uint32_t index, uint32_t other)
{
    uint32_t row = parting->rows.row[index];
    if (parting->rows.place[other] > index + 1)
        pair_list_add(&parting->rows.list, row < other ? row : other, row < other ? other : row);
}

/* Lists the rows that are new, and their pairs with all others. */
static void list_begun(struct aircraft_parting *parting, struct response_context *context,
                       const uint32_t *fresh, uint32_t count)
{
    const struct contact_queue *contacts = context->contacts;
    for (uint32_t i = 0; i < count; i++)
        add_row(parting, context, fresh[i]);
    parting->fresh = parting->rows.count;
    for (uint32_t i = 0; i < parting->fresh; i++)
        contact_queue_look(context->contacts, &context->input, fresh[i], true);
    for (uint32_t i = 0; i < parting->fresh; i++) {
        uint32_t link = contacts->head[fresh[i]];
        for (; link != 0; link = contacts->link[link - 1].next) {
            uint32_t other = other_of(context, link, fresh[i]);
            if (other == SLOT_NONE)
                continue;
            add_row(parting, context, other);
            add_pair(parting, i, other);
        }
    }
}

static bool is_fresh(const struct aircraft_parting *parting, uint32_t row)
{
    uint32_t place = parting->rows.place[row];
    return place != 0 && place <= parting->fresh;
}

/* Lists the pairs that parted a frame ago. */
static void list_parting(struct aircraft_parting *parting, struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    const struct entities *e = &context->next->entities;
    uint32_t count = context->contacts_sleep ? 0 : committed->head->contact_count;
    for (uint32_t i = 0; i < count; i++) {
        const struct persistent_contact *contact = &committed->contacts[i];
        uint32_t a = contact->a_row, b = contact->b_row;
        if (!(contact->flags & PERSISTENT_CONTACT_PARTS) ||
            contact->b_id & PERSISTENT_CONTACT_FIXED || !entities_alive(e, a, contact->a_id) ||
            !entities_alive(e, b, contact->b_id) || !contact_groups_in_air(context, a) ||
            !contact_groups_in_air(context, b) || is_fresh(parting, a) || is_fresh(parting, b))
            continue;
        add_row(parting, context, a);
        add_row(parting, context, b);
        pair_list_add(&parting->rows.list, a < b ? a : b, a < b ? b : a);
    }
}

struct job {
    struct aircraft_parting *parting;
    const struct response_context *context;
    bool ends; /* the frame */
};

/* Finds how rows first .. end - 1 stand. */
static void stand_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = argument;
    const struct body_motion *motion = job->context->motion;
    (void)worker;
    for (uint32_t i = first; i < end; i++) {
        struct aircraft_body *body = &job->parting->body[i];
        uint32_t row = job->parting->rows.row[i];
        const struct entities *e =
            job->ends ? &job->context->next->entities : body_motion_before(motion, row);
        body->body = body_motion_standing(motion, e, row);
        body->turn = level_gap_turn(&body->body, 0.0);
    }
}

void aircraft_parting_stand(struct aircraft_parting *parting,
                            const struct response_context *context, bool ends)
{
    struct job job = {.parting = parting, .context = context, .ends = ends};
    thread_pool_run(parting->workers, stand_some, &job, parting->rows.count, ROWS_A_PIECE);
}

struct turned_body aircraft_parting_turned(const struct aircraft_parting *parting, uint32_t row)
{
    const struct aircraft_body *body = aircraft_parting_body(parting, row);
    return (struct turned_body){&body->body, body->turn};
}

/* Returns true if two overlap by more than so much. The depth is right up to that by which they can
 * part in a frame. */
static bool overlap(const struct job *job, const struct pair *pair, double least_m,
                    struct level_gap *gap)
{
    const struct turned_body a = aircraft_parting_turned(job->parting, pair->a),
                             b = aircraft_parting_turned(job->parting, pair->b);
    struct vec3 between = vec3_sub(b.body->path.at, a.body->path.at);
    double reach = a.body->bound_m + b.body->bound_m;
    return vec3_dot(between, between) < reach * reach &&
           level_gap_deepest(&a, &b, least_m, 2.0 * MOST_MPS * world_dt_s(job->context->world),
                             gap);
}

/* --- those that are in each other --------------------------------------------------------------*/

/* Tests whether pairs first .. end - 1 overlap when the frame begins. */
static void test_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = argument;
    const struct aircraft_parting *parting = job->parting;
    (void)worker;
    for (uint32_t i = first; i < end; i++) {
        const struct pair *pair = &parting->rows.list.pair[i];
        bool fresh = is_fresh(parting, pair->a) || is_fresh(parting, pair->b);
        struct aircraft_pair *one = &parting->pair[i];
        one->overlaps = overlap(job, pair, fresh ? RESTING_PARTS_M : ROUNDING_M, &one->gap[0]);
    }
    work_done();
}

/* Marks a pair that parts, and tells its beginning. */
static void mark(struct response_context *context, const struct pair *pair, struct level_gap *gap)
{
    uint32_t index = contact_queue_pair(context->contacts, pair);
    context->contacts->marks[index] |= CONTACT_PARTS | CONTACT_PRESSED | CONTACT_OVERLAPS;
    gap->point[0] = vec3_lerp(context->path[pair->a].at, context->path[pair->b].at, 0.5);
    if (!contact_table_find(context, pair->a, pair->b) && contact_table_begins(context, index + 1))
        resting_report(context, pair, gap);
}

static void find_deep(struct aircraft_parting *parting, struct response_context *context,
                      const uint32_t *fresh, uint32_t count)
{
    struct job job = {.parting = parting, .context = context};
    parting_rows_forget(&parting->rows);
    parting->deep.count = 0;
    list_begun(parting, context, fresh, count);
    list_parting(parting, context);
    if (parting->rows.list.count == 0)
        return;
    parting->pair = parting_rows_sort(&parting->rows, parting->pair, sizeof *parting->pair);
    aircraft_parting_stand(parting, context, false);
    thread_pool_run(parting->workers, test_some, &job, parting->rows.list.count, PAIRS_A_PIECE);
    for (uint32_t i = 0; i < parting->rows.list.count; i++) {
        const struct pair *pair = &parting->rows.list.pair[i];
        if (!parting->pair[i].overlaps)
            continue;
        mark(context, pair, &parting->pair[i].gap[0]);
        pair_list_add(&parting->deep, pair->a, pair->b);
    }
}

/* --- those that go together --------------------------------------------------------------------*/

static bool is_alone(const struct aircraft_parting *parting, const struct pair *pair)
{
    return aircraft_parting_body(parting, pair->a)->in == 1 &&
           aircraft_parting_body(parting, pair->b)->in == 1;
}

/* Returns the body that stands for all that are in each other, directly or not. */
static struct aircraft_body *root_of(const struct aircraft_parting *parting, uint32_t row)
{
    uint32_t i = parting->rows.place[row] - 1;
    while (parting->body[i].parent != i)
        i = parting->body[i].parent = parting->body[parting->body[i].parent].parent;
    return &parting->body[i];
}

/* The lower root becomes that of both. */
static void join(const struct aircraft_parting *parting, const struct pair *pair)
{
    struct aircraft_body *a = root_of(parting, pair->a), *b = root_of(parting, pair->b);
    struct aircraft_body *low = a < b ? a : b, *high = a < b ? b : a;
    high->parent = low->parent;
}

static void add_up(const struct aircraft_parting *parting, const struct response_context *context,
                   uint32_t row)
{
    struct aircraft_body *root = root_of(parting, row);
    double kg = contact_impulse_kind(context, row)->mass_kg;
    root->kg += kg;
    root->way = vec3_add(root->way, vec3_scale(context->path[row].along, kg));
    root->momentum =
        vec3_add(root->momentum, vec3_scale(entities_velocity(&context->next->entities, row), kg));
}

static struct quat pose_of(const struct entities *e, uint32_t row)
{
    return rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll);
}

/* Turns a row as it was when the frame began, and gives it the common velocity. It has no spin:
 * with one that does not turn it, it would drive what it touches in each frame anew. */
static void carry(const struct aircraft_parting *parting, struct response_context *context,
                  uint32_t row, struct vec3 way)
{
    const struct aircraft_body *root = root_of(parting, row);
    const struct entities *w = body_motion_before(context->motion, row);
    table_set_position(&context->writer, row, vec3_add(entities_position(w, row), way));
    table_set_velocity(&context->writer, row, vec3_scale(root->momentum, 1.0 / root->kg));
    table_set_heading(&context->writer, row, w->row[row].heading);
    table_set_pitch(&context->writer, row, w->row[row].pitch);
    table_set_roll(&context->writer, row, w->row[row].roll);
    table_set_spin(&context->writer, row, (struct vec3){0.0, 0.0, 0.0});
}

/* Those that are in each other go as their common centre of mass does, and do not turn: neither
 * their motion nor their pilots bring them deeper into each other or into those beside them, and
 * they do not close when they have parted. Their momentum is what it was, and their energy no more.
 */
static void go_together(const struct aircraft_parting *parting, struct response_context *context,
                        struct free_bodies *bodies)
{
    for (uint32_t i = 0; i < parting->deep.count; i++)
        join(parting, &parting->deep.pair[i]);
    for (uint32_t i = 0; i < parting->rows.count; i++)
        add_up(parting, context, parting->rows.row[i]);
    for (uint32_t i = 0; i < parting->rows.count; i++) {
        uint32_t row = parting->rows.row[i];
        const struct aircraft_body *root = root_of(parting, row);
        struct vec3 way = vec3_scale(root->way, 1.0 / root->kg);
        carry(parting, context, row, way);
        body_motion_compute(context->motion, row);
        free_bodies_drift(bodies, row, way);
    }
}

struct vec3 aircraft_parting_step(const struct aircraft_parting *parting,
                                  const struct response_context *context, uint32_t index)
{
    const struct level_motion *pushed = &parting->level[index].pushed;
    double dt_s = world_dt_s(context->world);
    return (struct vec3){pushed->x * dt_s, 0.0, pushed->z * dt_s};
}

/* Returns how far the steps displace a body [m]. */
static struct vec3 step_of(const struct aircraft_parting *parting,
                           const struct response_context *context, uint32_t index)
{
    const uint32_t level = parting->body[index].level;
    return level == 0 ? (struct vec3){0.0, 0.0, 0.0}
                      : aircraft_parting_step(parting, context, level - 1);
}

/* Adds up the ways without steps, and the momenta, of those that go together. */
static void add_up_ends(const struct aircraft_parting *parting,
                        const struct response_context *context)
{
    const struct entities *e = &context->next->entities;
    for (uint32_t i = 0; i < parting->members; i++) {
        parting->body[i].way = parting->body[i].momentum = (struct vec3){0.0, 0.0, 0.0};
        parting->body[i].struck = false;
    }
    for (uint32_t i = 0; i < parting->members; i++) {
        uint32_t row = parting->rows.row[i];
        struct aircraft_body *root = root_of(parting, row);
        const struct entities *w = body_motion_before(context->motion, row);
        double kg = contact_impulse_kind(context, row)->mass_kg;
        struct vec3 came = vec3_sub(entities_position(e, row), entities_position(w, row));
        came = vec3_sub(came, step_of(parting, context, i));
        root->way = vec3_add(root->way, vec3_scale(came, kg));
        root->momentum = vec3_add(root->momentum, vec3_scale(entities_velocity(e, row), kg));
        root->struck |= context->motion->change[row] != 0;
    }
}

void aircraft_parting_share(struct aircraft_parting *parting, struct response_context *context,
                            struct free_bodies *bodies)
{
    add_up_ends(parting, context);
    for (uint32_t i = 0; i < parting->members; i++) {
        uint32_t row = parting->rows.row[i];
        const struct aircraft_body *root = root_of(parting, row);
        if (!root->struck)
            continue;
        const struct entities *w = body_motion_before(context->motion, row);
        struct vec3 way = vec3_scale(root->way, 1.0 / root->kg);
        struct vec3 along = vec3_add(way, step_of(parting, context, i));
        const struct path path = {.at = entities_position(w, row), .along = along};
        const struct rotation_path rotation = {.from = pose_of(w, row), .to = pose_of(w, row)};
        body_motion_change(context->motion, row, &path, &rotation);
        carry(parting, context, row, along);
        free_bodies_drift(bodies, row, way);
    }
}

/* Finds the shortest way out of each other. */
static void find_way(struct aircraft_parting *parting, const struct pair *pair,
                     struct level_gap *gap)
{
    struct vec3 normal;
    double way_m = level_exit_of(&parting->exit, (struct exit_slope){0.0, 0.0},
                                 &aircraft_parting_body(parting, pair->a)->body,
                                 &aircraft_parting_body(parting, pair->b)->body, &normal);
    if (way_m < INFINITY) {
        gap->normal = normal;
        gap->gap_m = -way_m;
    }
}

/* --- what is near ------------------------------------------------------------------------------*/

bool aircraft_parting_is_near(const struct response_context *context, uint32_t row, uint32_t other,
                              double margin_m)
{
    const struct entities *e = &context->next->entities;
    double reach = contact_impulse_kind(context, row)->bound_m +
                   contact_impulse_kind(context, other)->bound_m + margin_m;
    return vec3_length(vec3_sub(entities_position(e, other), entities_position(e, row))) < reach;
}

/* Lists all that part, what is near them, and what is near that: those who make room may push
 * others. */
static void list_near(struct aircraft_parting *parting, struct response_context *context,
                      double margin_m)
{
    const struct contact_queue *contacts = context->contacts;
    for (uint32_t i = 0; i < parting->rows.count; i++) {
        uint32_t row = parting->rows.row[i];
        contact_queue_look_wider(context->contacts, &context->input, row, margin_m);
        for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
            uint32_t other = other_of(context, link, row);
            if (other == SLOT_NONE)
                continue;
            cruise_rows_stop(&context->input, other);
            if (!aircraft_parting_is_near(context, row, other, margin_m))
                continue;
            add_row(parting, context, other);
            add_pair(parting, i, other);
        }
    }
}

/* Lists the rows that part, and lets them go together. */
static void list_deep(struct aircraft_parting *parting, struct response_context *context,
                      struct free_bodies *bodies)
{
    parting_rows_forget(&parting->rows);
    for (uint32_t i = 0; i < parting->deep.count; i++) {
        const struct pair *pair = &parting->deep.pair[i];
        add_row(parting, context, pair->a);
        add_row(parting, context, pair->b);
        aircraft_parting_body(parting, pair->a)->in++;
        aircraft_parting_body(parting, pair->b)->in++;
    }
    for (uint32_t i = 0; i < parting->deep.count; i++) {
        const struct pair *pair = &parting->deep.pair[i];
        if (!is_alone(parting, pair)) /* the guard at the frame's end does not hold it back */
            context->contacts->marks[contact_pairs_find(context->contacts, pair) - 1] |=
                CONTACT_CAPSULES;
    }
    parting->members = parting->rows.count;
    go_together(parting, context, bodies);
}

static double margin_of(const struct response_context *context)
{
    return 2.0 * MOST_MPS * world_dt_s(context->world);
}

/* Returns true if a pair began the frame in each other. */
static bool parts(const struct response_context *context, const struct pair *pair)
{
    uint32_t index = contact_pairs_find(context->contacts, pair);
    return index != 0 && context->contacts->marks[index - 1] & CONTACT_PARTS;
}

/* Measures pairs first .. end - 1 as they end the frame. */
static void measure_some(void *argument, uint32_t first, uint32_t end, uint32_t worker)
{
    const struct job *job = argument;
    const struct aircraft_parting *parting = job->parting;
    (void)worker;
    for (uint32_t i = first; i < end; i++) {
        const struct pair *pair = &parting->rows.list.pair[i];
        struct aircraft_pair *one = &parting->pair[i];
        struct level_gap_memory memory = {0};
        double apart_m;
        one->count = 1;
        one->overlaps = parts(job->context, pair) && overlap(job, pair, ROUNDING_M, &one->gap[0]);
        if (one->overlaps)
            continue;
        const struct turned_body a = aircraft_parting_turned(parting, pair->a),
                                 b = aircraft_parting_turned(parting, pair->b);
        one->count = level_gap_find_more(&a, &b, margin_of(job->context), one->gap,
                                         RESTING_GAPS_MAX, &apart_m, &memory);
    }
    work_done();
}

static void measure_near(struct aircraft_parting *parting, struct response_context *context)
{
    struct job job = {.parting = parting, .context = context};
    list_near(parting, context, margin_of(context));
    parting->pair = parting_rows_sort(&parting->rows, parting->pair, sizeof *parting->pair);
    aircraft_parting_stand(parting, context, true);
    thread_pool_run(parting->workers, measure_some, &job, parting->rows.list.count, PAIRS_A_PIECE);
}

/* --- steps -------------------------------------------------------------------------------------*/

/* Sets the line along which two that are in others, too, part. */
static void set_line(const struct response_context *context, const struct pair *pair,
                     struct level_gap *gap)
{
    double ax, az, bx, bz;
    deep_pair_place(context, pair->a, &ax, &az);
    deep_pair_place(context, pair->b, &bx, &bz);
    double far = sqrt((bx - ax) * (bx - ax) + (bz - az) * (bz - az));
    gap->normal = (struct vec3){(bx - ax) / far, 0.0, (bz - az) / far};
}

/* Finds the normals of those that part, and their crowds. */
static void find_normals(struct aircraft_parting *parting, const struct response_context *context)
{
    crowds_forget(&parting->crowds);
    for (uint32_t i = 0; i < parting->rows.list.count; i++) {
        const struct pair *pair = &parting->rows.list.pair[i];
        struct level_gap *gap = parting->pair[i].gap;
        if (!parting->pair[i].overlaps)
            continue;
        if (is_alone(parting, pair))
            find_way(parting, pair, gap);
        else
            set_line(context, pair, gap);
        crowds_join(&parting->crowds, pair, -gap->gap_m);
    }
    crowds_measure(&parting->crowds, context);
}

/* Returns the row as a body of the steps. One of another simulator stays where that has it. */
static uint32_t level_of(struct aircraft_parting *parting, const struct response_context *context,
                         uint32_t row)
{
    struct aircraft_body *body = aircraft_parting_body(parting, row);
    bool remote = remote_is(&context->next->entities, row);
    if (body->level != 0)
        return body->level - 1;
    parting->level[parting->levels] = (struct level_body){
        .inverse_mass = remote ? 0.0 : 1.0 / contact_impulse_kind(context, row)->mass_kg};
    parting->level_row[parting->levels] = remote ? SLOT_NONE : row;
    body->level = ++parting->levels;
    return body->level - 1;
}

static void add_point(struct aircraft_parting *parting, const struct response_context *context,
                      const struct level_gap *gap, bool parts, bool turned_round, uint32_t a,
                      uint32_t b)
{
    double hz = 1.0 / world_dt_s(context->world), side = turned_round ? -1.0 : 1.0;
    double wish = maths_min(PARTING_MPS, (APART_M - gap->gap_m) * hz);
    parting->point[parting->points++] = (struct level_contact){
        .a = turned_round ? b : a,
        .b = turned_round ? a : b,
        .normal_x = side * gap->normal.x,
        .normal_z = side * gap->normal.z,
        .least_mps = parts ? 0.0 : (CONTACT_REST_M - maths_max(0.0, gap->gap_m)) * hz,
        .apart_mps = parts ? PARTING_SHARE * wish : 0.0};
}

/* Keeps two that are in nobody else to their way out of each other: beside it a longer one may be
 * before them. */
static void keep_to_way(struct aircraft_parting *parting, const struct response_context *context,
                        const struct level_gap *way, bool turned_round, uint32_t a, uint32_t b)
{
    struct level_gap across = {.normal = {-way->normal.z, 0.0, way->normal.x},
                               .gap_m = CONTACT_REST_M};
    parting->parted[parting->parteds++] =
        (struct resting_pair){.first = parting->points, .count = 2, .gaps = 2};
    add_point(parting, context, &across, false, turned_round, a, b);
    across.normal = vec3_scale(across.normal, -1.0);
    add_point(parting, context, &across, false, turned_round, a, b);
}

/* Adds a pair. Of one whose first side stays, the other side comes first. */
static void add_parted(struct aircraft_parting *parting, const struct response_context *context,
                       uint32_t index)
{
    const struct pair *pair = &parting->rows.list.pair[index];
    const struct aircraft_pair *one = &parting->pair[index];
    uint32_t a = level_of(parting, context, pair->a), b = level_of(parting, context, pair->b);
    bool turned_round = parting->level_row[a] == SLOT_NONE;
    if (turned_round && parting->level_row[b] == SLOT_NONE)
        return;
    /* Those that part do so whatever they overlap by. */
    double gap_m = one->overlaps ? -RESTING_PARTS_M : maths_max(0.0, one->gap[0].gap_m);
    parting->parted[parting->parteds++] = (struct resting_pair){
        .first = parting->points, .count = one->count, .gaps = one->count, .gap_m = gap_m};
    for (uint32_t i = 0; i < one->count; i++)
        add_point(parting, context, &one->gap[i], one->overlaps, turned_round, a, b);
    if (one->overlaps && is_alone(parting, pair))
        keep_to_way(parting, context, &one->gap[0], turned_round, a, b);
}

/* Bodies that hardly move past each other, and are only displaced beside each other, have no
 * impact.
 */
static void let_touch(const struct aircraft_parting *parting, struct response_context *context)
{
    for (uint32_t i = 0; i < parting->rows.list.count; i++) {
        const struct aircraft_pair *one = &parting->pair[i];
        const struct pair *pair = &parting->rows.list.pair[i];
        struct vec3 nearing = vec3_sub(context->path[pair->a].along, context->path[pair->b].along);
        if (one->count > 0 && !one->overlaps && one->gap[0].gap_m < CONTACT_TOUCHING_M &&
            vec3_length(nearing) < CONTACT_IMPACT_MPS * world_dt_s(context->world))
            contact_queue_rest(context->contacts, contact_queue_pair(context->contacts, pair), NULL,
                               0);
    }
}

static void make_room(struct aircraft_parting *parting)
{
    uint64_t pairs = 2 * (uint64_t)parting->rows.list.count, points = pairs;
    for (uint32_t i = 0; i < parting->rows.list.count; i++)
        points += parting->pair[i].count;
    if (pairs > parting->parted_capacity) {
        parting->parted_capacity = 2 * pairs;
        parting->parted =
            reserve_grow(parting->parted, 0, parting->parted_capacity, sizeof *parting->parted);
    }
    if (points > parting->point_capacity) {
        parting->point_capacity = 2 * points;
        parting->point =
            reserve_grow(parting->point, 0, parting->point_capacity, sizeof *parting->point);
    }
}

/* Finds how far everybody goes. */
static void find_steps(struct aircraft_parting *parting, const struct response_context *context)
{
    parting->parteds = parting->points = 0;
    make_room(parting);
    for (uint32_t i = 0; i < parting->rows.list.count; i++) {
        if (parting->pair[i].count > 0)
            add_parted(parting, context, i);
    }
    parting_run(&parting->steps, &(struct parting_input){.context = context,
                                                         .crowds = &parting->crowds,
                                                         .row = parting->level_row,
                                                         .body = parting->level,
                                                         .point = parting->point,
                                                         .pair = parting->parted,
                                                         .bodies = parting->levels,
                                                         .points = parting->points,
                                                         .pairs = parting->parteds});
}

/* --- all ---------------------------------------------------------------------------------------*/

/* Displaces one row. */
static void go(struct response_context *context, uint32_t row, const struct level_motion *pushed)
{
    struct vec3 at = entities_position(&context->next->entities, row);
    double dt_s = world_dt_s(context->world);
    at.x = world_clamp(context->world, at.x + pushed->x * dt_s);
    at.z = world_clamp(context->world, at.z + pushed->z * dt_s);
    table_set_position(&context->writer, row, at);
    body_motion_compute(context->motion, row);
    contact_queue_ground(context->contacts, &context->input, row);
}

void aircraft_parting_run(struct aircraft_parting *parting, struct response_context *context,
                          struct free_bodies *bodies)
{
    uint32_t first = bodies->moved_count;
    parting->levels = parting->members = 0;
    find_deep(parting, context, bodies->groups.begun, bodies->groups.begun_count);
    if (parting->deep.count == 0)
        return;
    list_deep(parting, context, bodies);
    measure_near(parting, context);
    find_normals(parting, context);
    find_steps(parting, context);
    made_way_draw_back(parting, context);
    let_touch(parting, context);
    for (uint32_t i = 0; i < parting->levels; i++) {
        uint32_t row = parting->level_row[i];
        const struct level_motion *pushed = &parting->level[i].pushed;
        if (row == SLOT_NONE || (pushed->x == 0.0 && pushed->z == 0.0))
            continue;
        go(context, row, pushed);
        bodies->moved[bodies->moved_count++] = row;
    }
    for (uint32_t i = first; i < bodies->moved_count; i++)
        contact_queue_look(context->contacts, &context->input, bodies->moved[i], false);
}
