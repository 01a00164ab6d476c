/* Makes the points of the contacts that last, solves them, and moves the bodies. */
#include "collider/resting/resting.h"

#include "collider/response/contact_impulse.h"
#include "collider/response/contact_table.h"
#include "collider/response/response.h"
#include "collider/resting/ground_placement.h"
#include "collider/resting/parting.h"
#include "collider/resting/parting_ways.h"
#include "collider/resting/resting_gaps.h"
#include "collider/resting/stalled.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

#define ROUNDING_M 1e-6 /* smaller overlaps of the skins are rounding */

#define POINTS_A_PAIR 2u /* most pairs have no more; else the lanes' arrays grow */

int resting_init(struct resting *resting, const struct world *world, struct thread_pool *workers)
{
    uint32_t rows = world->params->capacity;
    uint64_t pairs = world->params->contact_slots;
    *resting = (struct resting){.workers = workers, .capacity = world->params->contact_slots};
    resting->gap = reserve_take(pairs, sizeof *resting->gap);
    resting->wide = reserve_take(RESTING_GAPS_MAX * (uint64_t)pairs, sizeof *resting->wide);
    resting->gap_before = reserve_take(pairs, sizeof *resting->gap_before);
    resting->key = reserve_take(pairs, sizeof *resting->key);
    resting->key_before = reserve_take(pairs, sizeof *resting->key_before);
    resting->before_of = reserve_take(pairs, sizeof *resting->before_of);
    resting->put_off = reserve_take(pairs, sizeof *resting->put_off);
    resting->pair = reserve_take(pairs, sizeof *resting->pair);
    resting->point = reserve_take(pairs * RESTING_POINTS_MAX, sizeof *resting->point);
    resting->body = reserve_take(rows + pairs, sizeof *resting->body);
    resting->row = reserve_take(rows + pairs, sizeof *resting->row);
    resting->pressed_ns = reserve_take(rows + pairs, sizeof *resting->pressed_ns);
    resting->stands = reserve_take(rows + pairs, sizeof *resting->stands);
    resting->body_of = calloc(rows, sizeof *resting->body_of);
    resting->moved = reserve_take(rows, sizeof *resting->moved);
    resting->leaving = calloc(rows, sizeof *resting->leaving);
    if (contact_groups_init(&resting->groups, world) == 0 &&
        begun_bodies_init(&resting->begun, world) == 0 &&
        crowds_init(&resting->crowds, world) == 0 &&
        parting_init(&resting->parting, rows + pairs, pairs * RESTING_POINTS_MAX) == 0 &&
        level_lanes_init(&resting->lanes, rows + pairs, POINTS_A_PAIR * pairs) == 0 &&
        neighbours_init(&resting->neighbours, world) == 0 && level_exit_init(&resting->exit) == 0 &&
        resting->gap && resting->wide && resting->gap_before && resting->key &&
        resting->key_before && resting->before_of && resting->put_off && resting->pair &&
        resting->point && resting->body && resting->row && resting->pressed_ns && resting->stands &&
        resting->body_of && resting->moved && resting->leaving)
        return 0;
    resting_free(resting);
    errno = ENOMEM;
    return -1;
}

void resting_free(struct resting *resting)
{
    contact_groups_free(&resting->groups);
    begun_bodies_free(&resting->begun);
    crowds_free(&resting->crowds);
    parting_free(&resting->parting);
    level_lanes_free(&resting->lanes);
    neighbours_free(&resting->neighbours);
    level_exit_free(&resting->exit);
    free(resting->leaving);
    reserve_free(resting->gap);
    reserve_free(resting->wide);
    reserve_free(resting->gap_before);
    reserve_free(resting->key);
    reserve_free(resting->key_before);
    reserve_free(resting->before_of);
    reserve_free(resting->put_off);
    reserve_free(resting->pair);
    reserve_free(resting->point);
    reserve_free(resting->body);
    reserve_free(resting->row);
    reserve_free(resting->pressed_ns);
    reserve_free(resting->stands);
    free(resting->body_of);
    reserve_free(resting->moved);
    *resting = (struct resting){0};
}

/* --- bodies ------------------------------------------------------------------------------------*/

/* Sets what tyres, tracks or the weight can hold in this frame, less what the mover has used of it.
 * An engine that drives is no brake. A vehicle that only holds its course has no brakes. */
static void set_grip(const struct response_context *context, uint32_t row, struct level_body *body)
{
    const struct entities *w = body_motion_before(context->motion, row),
                          *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    bool active = e->row[row].state == ENTITY_ACTIVE;
    if (kind->domain != DOMAIN_LAND || (active && e->row[row].behaviour == BEHAVIOUR_HOLD))
        return;
    double before = w->row[row].vx * body->forward_x + w->row[row].vz * body->forward_z;
    double now = e->row[row].vx * body->forward_x + e->row[row].vz * body->forward_z;
    bool wreck = e->row[row].state == ENTITY_WRECK; /* what pushes it takes its mean velocity on */
    double dx = (wreck ? body->moved.x : e->row[row].vx) - w->row[row].vx;
    double dz = (wreck ? body->moved.z : e->row[row].vz) - w->row[row].vz;
    double grip = GROUND_GRIP * GRAVITY_MPS2 * world_dt_s(context->world);
    double left = kind->mass_kg * maths_max(0.0, grip - sqrt(dx * dx + dz * dz));
    body->grip_along = active && fabs(now) > fabs(before) ? 0.0 : left;
    body->grip_across = left;
    body->grip_turn = left * 0.25 * kind->length_m;
}

/* Takes from the motion of a wreck's path what no velocity of its frame explains: the ground pushes
 * it out of itself, which is no motion that others feel. */
static void leave_out_push(const struct response_context *context, uint32_t row,
                           struct level_motion *moved)
{
    const struct entities *w = body_motion_before(context->motion, row),
                          *e = &context->next->entities;
    double before = sqrt(w->row[row].vx * w->row[row].vx + w->row[row].vz * w->row[row].vz);
    double after = sqrt(e->row[row].vx * e->row[row].vx + e->row[row].vz * e->row[row].vz);
    double speed = sqrt(moved->x * moved->x + moved->z * moved->z);
    double share = maths_min(1.0, maths_max(before, after) / maths_max(speed, 1e-9));
    double rate = maths_max(fabs(w->row[row].spin_y), fabs(e->row[row].spin_y));
    moved->x *= share;
    moved->z *= share;
    moved->spin = maths_clamp(moved->spin, -rate, rate);
}

void resting_level_body(const struct response_context *context, uint32_t row,
                        struct level_body *body)
{
    const struct entities *w = body_motion_before(context->motion, row),
                          *e = &context->next->entities;
    const struct mass_properties mass =
        mass_properties_of(&context->world->kinds[e->row[row].kind]);
    double hz = 1.0 / world_dt_s(context->world);
    struct vec3 along = context->path[row].along;
    *body = (struct level_body){.inverse_mass = 1.0 / mass.mass_kg,
                                .inverse_moment = 1.0 / mass.moment.y,
                                .moved = {along.x * hz, along.z * hz, 0.0}};
    body->moved.spin = -maths_wrap_half(e->row[row].heading - w->row[row].heading) * hz;
    if (e->row[row].state == ENTITY_WRECK)
        leave_out_push(context, row, &body->moved);
    maths_sincos(e->row[row].heading, &body->forward_x, &body->forward_z);
    body->forward_z = -body->forward_z;
    set_grip(context, row, body);
}

static uint32_t body_for(struct resting *resting, const struct response_context *context,
                         uint32_t row)
{
    if (resting->body_of[row] != 0)
        return resting->body_of[row] - 1;
    uint32_t index = resting->bodies++;
    resting_level_body(context, row, &resting->body[index]);
    resting->row[index] = row;
    resting->body_of[row] = index + 1;
    return index;
}

static uint32_t fixed_body(struct resting *resting)
{
    uint32_t index = resting->bodies++;
    resting->body[index] = (struct level_body){.forward_x = 1.0};
    resting->row[index] = SLOT_NONE;
    return index;
}

/* --- points ------------------------------------------------------------------------------------*/

/* Sets a point of a pair, which bears nothing yet. It is written where it stays: a copy of what has
 * just been written in parts waits for it. */
static void set_point(const struct response_context *context, const struct pair *pair,
                      const struct level_gap *gap, struct vec3 at, struct level_contact *point)
{
    const struct kind *ka = contact_impulse_kind(context, pair->a);
    const struct kind *kb = contact_impulse_kind(context, pair->b);
    double dt_s = world_dt_s(context->world), room = gap->gap_m - CONTACT_REST_M;
    struct vec3 a = context->path[pair->a].at;
    struct vec3 b = pair->b & PAIR_FIXED ? at : context->path[pair->b].at;
    point->normal_x = gap->normal.x;
    point->normal_z = gap->normal.z;
    point->a_x = at.x - a.x;
    point->a_z = at.z - a.z;
    point->b_x = at.x - b.x;
    point->b_z = at.z - b.z;
    point->least_mps = room > 0.0 ? -room / dt_s : 0.0;
    point->apart_mps =
        room < -ROUNDING_M ? maths_min(-PARTING_SHARE * room / dt_s, PARTING_MPS) : 0.0;
    point->friction = sqrt(ka->friction * kb->friction);
    point->normal_ns = point->friction_ns = 0.0;
    point->apart_ns = point->part_mps = 0.0;
}

/* Returns how fast the bodies of the pair close at most, at its points [m/s]. */
static double closing(const struct resting *resting, const struct resting_pair *pair)
{
    double most = 0.0;
    for (uint32_t i = pair->first; i < pair->first + pair->count; i++)
        most = maths_max(most, level_solver_closing(resting->body, &resting->point[i]));
    return most;
}

static void forget_bodies(struct resting *resting, uint32_t first)
{
    while (resting->bodies > first) {
        uint32_t row = resting->row[--resting->bodies];
        if (row != SLOT_NONE)
            resting->body_of[row] = 0;
    }
}

void resting_report(struct response_context *context, const struct pair *pair,
                    const struct level_gap *gap)
{
    const struct contact contact = {
        .a = pair->a,
        .b = pair->b,
        .impact = {.point = gap->point[0], .normal = gap->normal, .depth_m = -gap->gap_m}};
    const struct impact impact = response_impact(context, &contact);
    const struct outcome outcome = {RESPONSE_NONE, 0.0};
    const struct report report = response_report(context, &impact, IMPACT_BEGINS);
    write_collision_event(context, &report, &impact, &outcome);
}

/* --- pairs -------------------------------------------------------------------------------------*/

/* Lets the points of a gap begin with the impulses that its hulls bore a frame ago. Where two
 * points have become one, it bears both. */
static void warm(const struct resting_gap *found, const struct level_gap *gap,
                 struct level_contact *point)
{
    const struct persistent_contact *known = found->known;
    for (uint32_t i = 0; known && i < PERSISTENT_CONTACT_NEAREST; i++) {
        const struct contact_load *load = &known->load[i];
        if (known->nearest[i].hulls != gap->hulls)
            continue;
        for (uint32_t p = 0; p < 2; p++) {
            struct level_contact *of = &point[gap->points == 2 ? p : 0];
            of->normal_ns += (double)load->normal_ns[p];
            of->friction_ns += (double)load->friction_ns[p];
        }
        return;
    }
}

/* Keeps the impulses that the hulls of a pair bear, for the next frame. */
static void keep_loads(const struct resting *resting, struct contact_queue *contacts,
                       const struct resting_pair *pair)
{
    const struct level_contact *point = &resting->point[pair->first];
    struct resting_known *rested = contact_queue_rested(contacts, pair->pair);
    if (pair->gap_m <= -RESTING_PARTS_M)
        return; /* along which normal they part does not last */
    for (uint32_t g = 0; g < pair->gaps && g < PERSISTENT_CONTACT_NEAREST; g++) {
        struct contact_load *load = &rested->load[g];
        for (uint32_t p = 0; p < pair->gap[g].points; p++, point++) {
            load->normal_ns[p] = (float)point->normal_ns;
            load->friction_ns[p] = (float)point->friction_ns;
        }
    }
}

/* Takes a pair whose bodies are near and do not close as fast as in an impact. */
static void take(struct resting *resting, struct response_context *context, const struct pair *pair,
                 const struct resting_gap *found)
{
    const struct level_gap *gap = found->gap;
    uint32_t gaps = found->count;
    uint32_t bodies = resting->bodies;
    if (gaps == 0)
        return;
    struct resting_pair *taken = &resting->pair[resting->pairs];
    taken->first = resting->points;
    taken->count = 0;
    taken->gaps = gaps;
    taken->capsules = found->capsules;
    taken->known = found->known != NULL;
    taken->holds = found->known && found->known->flags & PERSISTENT_CONTACT_HOLDS;
    taken->gap_m = gap[0].gap_m;
    taken->gap = gap;
    taken->pair = found->pair;
    uint32_t body_a = body_for(resting, context, pair->a);
    uint32_t body_b =
        pair->b & PAIR_FIXED ? fixed_body(resting) : body_for(resting, context, pair->b);
    for (uint32_t g = 0; g < gaps; g++) {
        struct level_contact *point = &resting->point[taken->first + taken->count];
        for (uint32_t p = 0; p < gap[g].points; p++) {
            set_point(context, pair, &gap[g], gap[g].point[p], &point[p]);
            point[p].a = body_a, point[p].b = body_b;
        }
        warm(found, &gap[g], point);
        taken->count += gap[g].points;
    }
    if (taken->gap_m > -RESTING_PARTS_M && closing(resting, taken) >= CONTACT_IMPACT_MPS) {
        forget_bodies(resting, bodies);
        return;
    }
    struct resting_known *rested = contact_queue_rested(context->contacts, taken->pair);
    context->contacts->known[taken->pair].plane[0] = gap[0].normal;
    rested->normal_x = gap[0].normal.x;
    rested->normal_z = gap[0].normal.z;
    resting->points += taken->count;
    resting->pairs++;
}

/* Stops the bodies that are deep in walls: only the shortest way leads out, and any other motion
 * may bring them deeper into another hull of the wall. */
static void stop_in_walls(const struct resting *resting, const struct response_context *context)
{
    for (uint32_t i = 0; i < resting->pairs; i++) {
        const struct resting_pair *pair = &resting->pair[i];
        if (pair->gap_m <= -RESTING_PARTS_M && context->contacts->pair[pair->pair].b & PAIR_FIXED)
            resting->body[resting->point[pair->first].a].moved =
                (struct level_motion){0.0, 0.0, 0.0};
    }
}

/* --- motion ------------------------------------------------------------------------------------*/

/* The rotation that the contacts take from a row is taken from its steering first: a driver who
 * steers against a wall turns the wheels, and the body has no spin by that. */
static double spin_after(const struct level_body *body, double own_rps)
{
    double steering = body->wanted.spin - own_rps, change = body->moved.spin - body->wanted.spin;
    double stopped = 0.0;
    if (steering * change < 0.0)
        stopped = fabs(change) < fabs(steering) ? -change : steering;
    return own_rps + change + stopped;
}

static bool changed(const struct level_body *body)
{
    return body->moved.x != body->wanted.x || body->moved.z != body->wanted.z ||
           body->moved.spin != body->wanted.spin || body->pushed.x != 0.0 ||
           body->pushed.z != 0.0 || body->pushed.spin != 0.0;
}

/* Gives a row the velocity of its body. A wreck slows down on the ground in the course of a frame:
 * one that is pushed has the velocity at which it went and not what the push adds to that of the
 * frame's end, or its way would be longer than any velocity that it had. */
static void set_velocity(struct response_context *context, uint32_t row,
                         const struct level_body *body)
{
    const struct entities *e = &context->next->entities;
    bool pushed = body->moved.x != body->wanted.x || body->moved.z != body->wanted.z ||
                  body->moved.spin != body->wanted.spin;
    if (e->row[row].state == ENTITY_WRECK && pushed) {
        table_set_vx(&context->writer, row, body->moved.x);
        table_set_vz(&context->writer, row, body->moved.z);
        table_set_spin_y(&context->writer, row, body->moved.spin);
        return;
    }
    table_set_vx(&context->writer, row, e->row[row].vx + body->moved.x - body->wanted.x);
    table_set_vz(&context->writer, row, e->row[row].vz + body->moved.z - body->wanted.z);
    table_set_spin_y(&context->writer, row, spin_after(body, e->row[row].spin_y));
}

/* Gives a row the motion of its body. */
static void move(struct response_context *context, uint32_t row, const struct level_body *body)
{
    const struct entities *w = body_motion_before(context->motion, row);
    double dt_s = world_dt_s(context->world);
    struct vec3 at = context->path[row].at;
    at.x = world_clamp(context->world, at.x + (body->moved.x + body->pushed.x) * dt_s);
    at.z = world_clamp(context->world, at.z + (body->moved.z + body->pushed.z) * dt_s);
    double turn = (body->moved.spin + body->pushed.spin) * dt_s;
    context->motion->parting_rps[row] = body->pushed.spin;
    ground_placement_put(context, row, at, maths_wrap_turn(w->row[row].heading - turn));
    set_velocity(context, row, body);
    body_motion_compute(context->motion, row);
}

static void move_bodies(struct resting *resting, struct response_context *context)
{
    for (uint32_t i = 0; i < resting->bodies; i++) {
        uint32_t row = resting->row[i];
        if (row == SLOT_NONE)
            continue;
        resting->body_of[row] = 0;
        if (resting->stands[i])
            stalled_stop(context, row);
        if (resting->stands[i] || !changed(&resting->body[i]))
            continue;
        move(context, row, &resting->body[i]);
        resting->moved[resting->moved_count++] = row;
    }
    for (uint32_t i = 0; i < resting->moved_count; i++) {
        if (!resting->neighbours.listed[resting->moved[i]]) /* or its neighbours are known */
            contact_queue_look(context->contacts, &context->input, resting->moved[i], false);
    }
}

/* --- all ---------------------------------------------------------------------------------------*/

/* Returns true if the bodies touch: they bear a load, or their skins meet. */
static bool touches(const struct resting *resting, const struct resting_pair *pair)
{
    for (uint32_t i = pair->first; i < pair->first + pair->count; i++) {
        if (resting->point[i].normal_ns > 0.0)
            return true;
    }
    return pair->gap_m < CONTACT_TOUCHING_M;
}

/* Tells the search for impacts where the pair rests. */
static void rest(const struct resting *resting, struct contact_queue *contacts,
                 const struct resting_pair *pair)
{
    struct rest_point point[RESTING_POINTS_MAX];
    for (uint32_t i = 0; i < pair->count; i++) {
        const struct level_contact *c = &resting->point[pair->first + i];
        point[i] = (struct rest_point){c->normal_x, c->normal_z, c->a_x, c->a_z, c->b_x, c->b_z};
    }
    contact_queue_rest(contacts, pair->pair, point, pair->count);
}

/* A pair that the sweeps have not brought to rest is left to the search for impacts. */
static void mark(struct resting *resting, struct response_context *context)
{
    for (uint32_t i = 0; i < resting->pairs; i++) {
        const struct resting_pair *pair = &resting->pair[i];
        const struct pair *bodies = &context->contacts->pair[pair->pair];
        uint8_t *marks = &context->contacts->marks[pair->pair];
        bool bears = touches(resting, pair);
        keep_loads(resting, context->contacts, pair);
        if (bears && !pair->known && contact_table_begins(context, pair->pair + 1))
            resting_report(context, bodies, pair->gap);
        if ((bears || pair->known) && closing(resting, pair) < CONTACT_IMPACT_MPS)
            rest(resting, context->contacts, pair);
        if (bears)
            *marks |= CONTACT_PRESSED;
        if (pair->gap_m <= -RESTING_PARTS_M)
            *marks |= CONTACT_PARTS | (pair->capsules ? CONTACT_CAPSULES : 0u);
        if (pair->gap_m < -ROUNDING_M)
            *marks |= CONTACT_OVERLAPS;
    }
}

void resting_solve(struct resting *resting, struct response_context *context)
{
    for (uint32_t i = 0; i < resting->moved_count; i++)
        context->motion->parting_rps[resting->moved[i]] = 0.0;
    resting->moved_count = 0;
    resting->pairs = resting->points = resting->bodies = 0;
    contact_groups_find(&resting->groups, context);
    resting_gaps_measure(resting, context);
    parting_ways_find(resting, context);
    for (uint32_t i = 0; i < resting->groups.count; i++)
        take(resting, context, &resting->groups.pair[i], &resting->gap[i]);
    level_solver_run(&resting->lanes, resting->body, resting->bodies, resting->point,
                     resting->points);
    stop_in_walls(resting, context);
    parting_run(&resting->parting, &(struct parting_input){.context = context,
                                                           .crowds = &resting->crowds,
                                                           .lanes = &resting->lanes,
                                                           .row = resting->row,
                                                           .body = resting->body,
                                                           .point = resting->point,
                                                           .pair = resting->pair,
                                                           .bodies = resting->bodies,
                                                           .points = resting->points,
                                                           .pairs = resting->pairs});
    stalled_find(resting, context);
    mark(resting, context);
    move_bodies(resting, context);
}
