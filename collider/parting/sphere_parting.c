/* A list of the rows that are deep in each other, with those that touch them, and sweeps over their
 * pairs that push each as far apart as it may come in a frame. */
#include "collider/parting/sphere_parting.h"

#include "collider/narrow_phase/contact_pairs.h"
#include "collider/narrow_phase/cruise_rows.h"
#include "collider/response/contact_table.h"
#include "collider/response/path_change.h"
#include "collider/resting/ground_placement.h"
#include "collider/resting/resting.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/remote.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#include <errno.h>

/* A pair parts at this speed at most, and a body goes no faster than MOST_MPS. */
#define PAIR_MPS 10.0
#define MOST_MPS 20.0

/* Bodies that part end so far apart [m]. */
#define APART_M 1e-3

/* Bodies that overlap by no more than this are apart: the guard at the frame's end leaves half of
 * that [m]. */
#define ROUNDING_M 2e-5

#define WISHES       30u /* sweeps */
#define BOUNDS       300u
#define SETTLES      2u
#define HALVINGS     3u
#define GOLDEN_RAD   2.399963229728653 /* spreads the directions of bodies at one place */
#define SAME_PLACE_M 1e-6

int sphere_parting_init(struct sphere_parting *parting, const struct world *world)
{
    *parting = (struct sphere_parting){.members = 0};
    if (parting_rows_init(&parting->rows, world) == 0) {
        parting->body = reserve_take(world->params->capacity, sizeof *parting->body);
        parting->pair = reserve_take(parting->rows.pair_capacity, sizeof *parting->pair);
    }
    if (parting->body && parting->pair)
        return 0;
    sphere_parting_free(parting);
    errno = ENOMEM;
    return -1;
}

void sphere_parting_free(struct sphere_parting *parting)
{
    parting_rows_free(&parting->rows);
    reserve_free(parting->body);
    reserve_free(parting->pair);
    *parting = (struct sphere_parting){.members = 0};
}

/* --- rows --------------------------------------------------------------------------------------*/

/* Returns true for a body that the ground holds. What flies is left to impacts, which conserve its
 * momentum. */
static bool is_body(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return e->row[row].state != ENTITY_FREE &&
           context->world->kinds[e->row[row].kind].domain != DOMAIN_MUNITION &&
           path_change_grounded(context, row);
}

static bool is_of_bodies(const struct response_context *context, const struct pair *pair)
{
    return !(pair->b & PAIR_FIXED) && is_body(context, pair->a) && is_body(context, pair->b);
}

static double reach_of(const struct response_context *context, const struct pair *pair)
{
    return pair_filter_row_reach(&context->input.detect, pair->a) +
           pair_filter_row_reach(&context->input.detect, pair->b);
}

/* Returns how far the middles of two bodies are apart when the frame begins [m]. */
static double begins_apart(const struct response_context *context, const struct pair *pair)
{
    const struct vec3 a = entities_position(body_motion_before(context->motion, pair->a), pair->a);
    const struct vec3 b = entities_position(body_motion_before(context->motion, pair->b), pair->b);
    return vec3_length(vec3_sub(b, a));
}

/* Returns true if two bodies begin the frame in each other. */
static bool is_deep(const struct response_context *context, const struct pair *pair)
{
    return reach_of(context, pair) - begins_apart(context, pair) > ROUNDING_M;
}

static void add_deep(struct sphere_parting *parting, struct response_context *context,
                     const struct pair *pair)
{
    if (!is_of_bodies(context, pair))
        return;
    body_motion_require(context->motion, pair->a);
    body_motion_require(context->motion, pair->b);
    if (!is_deep(context, pair))
        return;
    parting_rows_add(&parting->rows, pair->a);
    parting_rows_add(&parting->rows, pair->b);
}

/* Lists the bodies of the pairs that were not apart a frame ago. */
static void add_parting(struct sphere_parting *parting, struct response_context *context)
{
    const struct state *committed = context->motion->committed;
    const struct entities *e = &context->next->entities;
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        const struct persistent_contact *contact = &committed->contacts[i];
        const struct pair pair = {contact->a_row, contact->b_row};
        if (contact->flags & PERSISTENT_CONTACT_OVERLAPS &&
            entities_alive(e, contact->a_row, contact->a_id) &&
            entities_alive(e, contact->b_row, contact->b_id))
            add_deep(parting, context, &pair);
    }
}

/* Returns a pair of the queue by its link. */
static struct pair linked(const struct response_context *context, uint32_t link)
{
    return context->contacts->pair[context->contacts->link[link - 1].pair];
}

/* Lists the bodies that a row may meet in this frame, or only those that it touches. */
static void add_near(struct sphere_parting *parting, struct response_context *context, uint32_t row,
                     bool touching)
{
    const struct contact_queue *contacts = context->contacts;
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        const struct pair pair = linked(context, link);
        uint32_t other = pair.a == row ? pair.b : pair.a;
        if (!is_of_bodies(context, &pair))
            continue;
        body_motion_require(context->motion, other);
        if ((!touching ||
             begins_apart(context, &pair) < reach_of(context, &pair) + CONTACT_TOUCHING_M))
            parting_rows_add(&parting->rows, other);
    }
}

/* Lists the bodies that are deep in others, and those that touch a listed one: in the middle of a
 * crowd nobody could part if those at its rim did not make room. Then lists those that stand in
 * their way. */
static void add_rows(struct sphere_parting *parting, struct response_context *context,
                     const uint32_t *fresh, uint32_t count)
{
    const struct contact_queue *contacts = context->contacts;
    double most_m = 2.0 * MOST_MPS * world_dt_s(context->world);
    add_parting(parting, context);
    for (uint32_t i = 0; i < count; i++) {
        body_motion_require(context->motion, fresh[i]);
        contact_queue_look(context->contacts, &context->input, fresh[i], true);
    }
    for (uint32_t i = 0; i < contacts->pair_count; i++) {
        const struct pair pair = contacts->pair[i];
        add_deep(parting, context, &pair);
    }
    for (uint32_t i = 0; i < parting->rows.count; i++) {
        contact_queue_look_wider(context->contacts, &context->input, parting->rows.row[i], most_m);
        add_near(parting, context, parting->rows.row[i], true);
    }
    parting->members = parting->rows.count;
    for (uint32_t i = 0; i < parting->members; i++)
        add_near(parting, context, parting->rows.row[i], false);
}

static void place_bodies(struct sphere_parting *parting, const struct response_context *context)
{
    const struct entities *e = &context->next->entities;
    for (uint32_t i = 0; i < parting->rows.count; i++) {
        uint32_t row = parting->rows.row[i];
        parting->body[i] = (struct sphere_body){
            .from = entities_position(body_motion_before(context->motion, row), row),
            .to = entities_position(e, row),
            .light = i < parting->members && !remote_is(e, row) ? 1.0 : 0.0,
            .share = 1.0};
    }
}

/* --- pairs -------------------------------------------------------------------------------------*/

/* Lists the pairs of two listed rows, in an order that does not depend on the method. */
static void list_pairs(struct sphere_parting *parting, const struct response_context *context)
{
    const struct contact_queue *contacts = context->contacts;
    for (uint32_t i = 0; i < parting->rows.count; i++) {
        uint32_t row = parting->rows.row[i];
        for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
            const struct pair *pair = &contacts->pair[contacts->link[link - 1].pair];
            if (pair->a == row && !(pair->b & PAIR_FIXED) && parting->rows.place[pair->b] != 0)
                pair_list_add(&parting->rows.list, pair->a, pair->b);
        }
    }
    parting->pair = parting_rows_sort(&parting->rows, parting->pair, sizeof *parting->pair);
}

/* Marks a pair, and tells its beginning. */
static void mark(struct response_context *context, const struct pair *pair, bool deep)
{
    uint32_t index = contact_pairs_find(context->contacts, pair);
    uint8_t *marks = &context->contacts->marks[index - 1];
    *marks |= CONTACT_PARTS;
    if (!deep)
        return;
    *marks |= CONTACT_PRESSED | CONTACT_OVERLAPS;
    if (contact_table_find(context, pair->a, pair->b) || !contact_table_begins(context, index))
        return;
    const struct vec3 a = context->path[pair->a].at, b = context->path[pair->b].at;
    const struct vec3 between = vec3_sub(b, a);
    double far = vec3_length(between);
    const struct level_gap gap = {.normal = far > 0.0 ? vec3_scale(between, 1.0 / far)
                                                      : (struct vec3){0.0, 1.0, 0.0},
                                  .gap_m = far - reach_of(context, pair),
                                  .point = {vec3_lerp(a, b, 0.5)}};
    resting_report(context, pair, &gap);
}

static void find_pairs(struct sphere_parting *parting, struct response_context *context)
{
    double most_m = PAIR_MPS * world_dt_s(context->world);
    for (uint32_t i = 0; i < parting->rows.list.count; i++) {
        const struct pair *pair = &parting->rows.list.pair[i];
        double reach = reach_of(context, pair), apart = begins_apart(context, pair);
        bool deep = is_deep(context, pair);
        struct sphere_pair *one = &parting->pair[i];
        *one = (struct sphere_pair){.a = parting->rows.place[pair->a] - 1,
                                    .b = parting->rows.place[pair->b] - 1,
                                    .least_m = maths_min(reach, apart)};
        one->wish_m = deep ? maths_min(reach + APART_M, apart + most_m) : one->least_m;
        if (one->a < parting->members || one->b < parting->members)
            mark(context, pair, deep);
    }
}

/* --- ways --------------------------------------------------------------------------------------*/

/* Pushes a pair so far apart. Returns by how much [m]. */
static double push(const struct sphere_parting *parting, const struct sphere_pair *pair,
                   double far_m)
{
    struct sphere_body *a = &parting->body[pair->a], *b = &parting->body[pair->b];
    struct vec3 between = vec3_sub(b->to, a->to);
    double least = sqrt(maths_max(0.0, far_m * far_m - between.y * between.y));
    double light = a->light + b->light;
    between.y = 0.0;
    double far = vec3_length(between);
    if (far >= least || light == 0.0)
        return 0.0;
    double way = least - far;
    if (far < SAME_PLACE_M) {
        double turn =
            GOLDEN_RAD * (double)(parting->rows.row[pair->a] + parting->rows.row[pair->b]);
        maths_sincos(maths_wrap_turn(turn), &between.x, &between.z);
        far = 1.0;
    }
    between = vec3_scale(between, way / (far * light));
    a->to = vec3_sub(a->to, vec3_scale(between, a->light));
    b->to = vec3_add(b->to, vec3_scale(between, b->light));
    return way;
}

/* One sweep over the pairs. Returns the longest push [m]. */
static double sweep(const struct sphere_parting *parting, uint32_t n, bool wishes)
{
    uint32_t count = parting->rows.list.count;
    double most_m = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const struct sphere_pair *pair = &parting->pair[n % 2 == 0 ? i : count - 1 - i];
        most_m = maths_max(most_m, push(parting, pair, wishes ? pair->wish_m : pair->least_m));
    }
    return most_m;
}

/* All go by the same share of their wishes, so that nobody goes farther than so much. */
static void shorten(const struct sphere_parting *parting, const struct response_context *context,
                    double most_m)
{
    const struct entities *e = &context->next->entities;
    double far = most_m;
    for (uint32_t i = 0; i < parting->rows.count; i++) {
        struct vec3 at = entities_position(e, parting->rows.row[i]);
        far = maths_max(far, vec3_length(vec3_sub(parting->body[i].to, at)));
    }
    for (uint32_t i = 0; i < parting->rows.count; i++) {
        struct sphere_body *body = &parting->body[i];
        struct vec3 at = entities_position(e, parting->rows.row[i]);
        body->to = vec3_lerp(at, body->to, most_m / far);
    }
}

static struct vec3 end_of(const struct sphere_body *body)
{
    return vec3_lerp(body->from, body->to, body->share);
}

/* Lets bodies that would get deeper into others go less far. Returns true if there was one. */
static bool hold_back(const struct sphere_parting *parting, double keep)
{
    bool any = false;
    for (uint32_t i = 0; i < parting->rows.list.count; i++) {
        const struct sphere_pair *pair = &parting->pair[i];
        struct sphere_body *a = &parting->body[pair->a], *b = &parting->body[pair->b];
        if (vec3_length(vec3_sub(end_of(b), end_of(a))) < pair->least_m - ROUNDING_M)
            a->jams = b->jams = true;
    }
    for (uint32_t i = 0; i < parting->rows.count; i++) {
        struct sphere_body *body = &parting->body[i];
        any |= body->jams && body->share > 0.0;
        body->share *= body->jams ? keep : 1.0;
        body->jams = false;
    }
    return any;
}

/* Gives the bodies the height of the ground where they go. */
static void set_down(const struct sphere_parting *parting, const struct response_context *context)
{
    const struct entities *e = &context->next->entities;
    const struct terrain *terrain = &context->world->terrain;
    const struct crater_index *craters = context->input.detect.craters;
    for (uint32_t i = 0; i < parting->members; i++) {
        const struct vec3 at = entities_position(e, parting->rows.row[i]);
        struct vec3 *to = &parting->body[i].to;
        to->y = at.y + terrain_height(terrain, craters, to->x, to->z) -
                terrain_height(terrain, craters, at.x, at.z);
    }
}

/* Finds where the bodies are to go: as far as they wish, and then so that none gets deeper. */
static void find_ways(const struct sphere_parting *parting, const struct response_context *context)
{
    for (uint32_t n = 0; n < WISHES; n++)
        (void)sweep(parting, n, true);
    shorten(parting, context, MOST_MPS * world_dt_s(context->world));
    for (uint32_t k = 0; k < SETTLES; k++) {
        set_down(parting, context);
        for (uint32_t n = 0; n < BOUNDS && sweep(parting, n, false) > 0.1 * ROUNDING_M; n++)
            ;
    }
    set_down(parting, context);
    for (uint32_t n = 0; n < HALVINGS && hold_back(parting, 0.5); n++)
        ;
    while (hold_back(parting, 0.0))
        ;
}

/* Puts a body to where it ends the frame. Returns true if that is not where the mover has it. */
static bool go(struct response_context *context, uint32_t row, const struct sphere_body *body)
{
    const struct entities *e = &context->next->entities;
    struct vec3 end = end_of(body), at = entities_position(e, row);
    if (end.x == at.x && end.z == at.z)
        return false;
    cruise_rows_stop(&context->input, row);
    at.x = world_clamp(context->world, end.x);
    at.z = world_clamp(context->world, end.z);
    ground_placement_put(context, row, at, e->row[row].heading);
    if (e->row[row].state == ENTITY_WRECK)
        table_set_until_tick(&context->writer, row, 0);
    body_motion_compute(context->motion, row);
    contact_queue_look(context->contacts, &context->input, row, false);
    return true;
}

uint32_t sphere_parting_run(struct sphere_parting *parting, struct response_context *context,
                            const uint32_t *fresh, uint32_t count, uint32_t *moved)
{
    uint32_t went = 0;
    parting_rows_forget(&parting->rows);
    add_rows(parting, context, fresh, count);
    if (parting->rows.count == 0)
        return 0;
    place_bodies(parting, context);
    list_pairs(parting, context);
    find_pairs(parting, context);
    find_ways(parting, context);
    for (uint32_t i = 0; i < parting->members; i++) {
        if (go(context, parting->rows.row[i], &parting->body[i]))
            moved[went++] = parting->rows.row[i];
    }
    return went;
}
