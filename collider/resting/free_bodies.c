/* Gathers free bodies and their points, and solves them. */
#include "collider/resting/free_bodies.h"

#include "collider/motion/free_fall.h"
#include "collider/response/contact_impulse.h"
#include "collider/response/contact_table.h"
#include "collider/response/path_change.h"
#include "collider/resting/free_motion.h"
#include "collider/resting/resting.h"
#include "world/entity/free_rotation.h"
#include "world/entity/mass_properties.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/wreck_drag.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/work_done.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

#define NEAR_M 0.02 /* farther bodies that do not come as near bear no load on each other */

/* Bodies that touch already when the frame begins have no bounce up to this speed, at which they
 * roll on each other or a third one falls on them. */
#define TOUCHING_MPS 5.0

/* Nearer bodies are pushed apart, by this share of the depth a frame and not faster. The ground is
 * not pushed out of until it is so deep. */
#define PUSH_M        2e-3
#define PUSH_GROUND_M -2e-3
#define PUSH_SHARE    0.3
#define PUSH_MPS      3.0
#define SPRUNG_DEEP_M 0.018 /* vehicles on their springs count as no deeper in the ground */

#define GROUND_FRICTION 0.7    /* of soil */
#define PLOUGH_S2PM2    2.5e-4 /* as of a wreck on the ground (mover/motion/ground_contacts.c) */

#define STEERING_RPS 1e-6 /* less is rounding */

/* Resistance against rolling: a lever as a share of the distance from the centre of mass. */
#define ROLLING_GROUND 0.1
#define ROLLING_BODY   0.05

int free_bodies_init(struct free_bodies *bodies, const struct world *world)
{
    uint32_t rows = world->params->capacity;
    /* A wreck among bushes has more pairs than the table of contacts keeps. */
    uint64_t pairs = 2 * (uint64_t)world->params->contact_slots;
    *bodies = (struct free_bodies){.contact_capacity = (uint32_t)pairs * 8u + FREE_POINTS_MAX,
                                   .pair_capacity = (uint32_t)pairs};
    bodies->body = reserve_take((uint64_t)rows + 1, sizeof *bodies->body);
    bodies->side = reserve_take((uint64_t)rows + 1, sizeof *bodies->side);
    bodies->contact = reserve_take(bodies->contact_capacity, sizeof *bodies->contact);
    bodies->pair = reserve_take(pairs, sizeof *bodies->pair);
    bodies->moved = reserve_take(2 * (uint64_t)rows, sizeof *bodies->moved);
    bodies->body_of = calloc(rows, sizeof *bodies->body_of);
    bodies->owned = calloc(rows, sizeof *bodies->owned);
    bodies->drift = calloc(rows, sizeof *bodies->drift);
    bodies->drifting = reserve_take(2 * (uint64_t)rows, sizeof *bodies->drifting);
    if (contact_groups_init(&bodies->groups, world) == 0 && bodies->body && bodies->side &&
        bodies->contact && bodies->pair && bodies->moved && bodies->body_of && bodies->owned &&
        bodies->drift && bodies->drifting)
        return 0;
    free_bodies_free(bodies);
    errno = ENOMEM;
    return -1;
}

void free_bodies_free(struct free_bodies *bodies)
{
    contact_groups_free(&bodies->groups);
    reserve_free(bodies->body);
    reserve_free(bodies->side);
    reserve_free(bodies->contact);
    reserve_free(bodies->pair);
    reserve_free(bodies->moved);
    free(bodies->body_of);
    free(bodies->owned);
    free(bodies->drift);
    reserve_free(bodies->drifting);
    *bodies = (struct free_bodies){.count = 0};
}

/* --- bodies ------------------------------------------------------------------------------------*/

/* A wreck begins as it was committed, with the drag and the fall of this frame. */
static void begin_wreck(const struct response_context *context, struct free_side *side,
                        struct free_body *body)
{
    const struct entities *w = &context->motion->before;
    uint32_t row = side->row;
    body->moved.spin = (struct vec3){w->row[row].spin_x, w->row[row].spin_y, w->row[row].spin_z};
    side->fall = (struct vec3){0.0, -GRAVITY_MPS2 * world_dt_s(context->world), 0.0};
    struct vec3 centre =
        vec3_add(entities_velocity(w, row), vec3_cross(body->moved.spin, side->arm));
    const struct mat3 turn = rotation_matrix(side->turn);
    const struct kind *kind = &context->world->kinds[w->row[row].kind];
    centre = wreck_drag_slow(kind, &turn, centre, world_dt_s(context->world));
    body->moved.spin =
        wreck_drag_slow_spin(kind, &turn, body->moved.spin, world_dt_s(context->world));
    body->moved.velocity = vec3_add(centre, side->fall);
}

/* What holds its course goes with its position, and turns about the vertical. The tilt that the
 * ground gives it presses on nobody: no impulse could slow it down. */
static void begin_course(const struct response_context *context, const struct free_side *side,
                         struct free_body *body)
{
    body->moved.spin = path_change_spin(context, side->row, 1.0);
    body->moved.velocity =
        vec3_scale(context->path[side->row].along, 1.0 / world_dt_s(context->world));
}

/* Any other body begins with the motion that it has had so far in this frame: that of its centre of
 * mass, which goes straight while the body turns about it. The path of a vehicle in the air has the
 * mean speed of the frame, which its weight makes faster until the end. */
static void begin_moved(const struct response_context *context, struct free_side *side,
                        struct free_body *body)
{
    double hz = 1.0 / world_dt_s(context->world);
    struct rotation_path turn = body_motion_rotation(context->motion, side->row);
    body->moved.spin = vec3_scale(rotation_speed(turn.from, turn.to, 0.0), hz);
    const struct mat3 axes = rotation_matrix(turn.to);
    struct vec3 arm = rotation_apply(&axes, (struct vec3){0.0, side->mass.centre_m, 0.0});
    body->moved.velocity =
        vec3_scale(vec3_add(context->path[side->row].along, vec3_sub(arm, side->arm)), hz);
    if (side->is_free && free_fall_only(context->motion, side->row))
        body->moved.velocity.y -= 0.5 * GRAVITY_MPS2 * world_dt_s(context->world);
}

/* An aircraft begins with its velocity and its committed spin, less what its pilot has stopped of
 * it. What he turns it by in addition presses on nobody. */
static void begin_piloted(const struct response_context *context, struct free_side *side,
                          struct free_body *body)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    double dt_s = world_dt_s(context->world);
    uint32_t row = side->row;
    struct vec3 spin = {w->row[row].spin_x, w->row[row].spin_y, w->row[row].spin_z};
    const struct vec3 left = {e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z},
                      begun = spin;
    struct quat freely = side->turn;
    free_rotation_turn(side->mass.moment, &freely, &spin, dt_s);
    double rate = vec3_length(spin);
    body->moved.spin = vec3_scale(begun, rate > 0.0 ? vec3_length(left) / rate : 0.0);
    body->moved.velocity = vec3_scale(context->path[row].along, 1.0 / dt_s);
    struct quat to = body_motion_rotation(context->motion, row).to;
    struct vec3 steering = vec3_scale(rotation_speed(freely, to, 0.0), 1.0 / dt_s);
    if (vec3_length(steering) > STEERING_RPS)
        side->steering = steering;
}

/* Returns the direction in which the ground holds a body. One that only holds its course is moved
 * along the ground whatever presses on it, up and down as well: it moves in the plane of that
 * motion and of the level direction across it. If impulses moved it horizontally only, one that
 * comes down on a wreck could not be slowed down, and would be thrown aside instead. */
static struct vec3 up_of(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    struct vec3 along = context->path[row].along;
    double level2 = along.x * along.x + along.z * along.z;
    if (e->row[row].behaviour != BEHAVIOUR_HOLD || !(level2 > 0.0) || along.y == 0.0)
        return (struct vec3){0.0, 1.0, 0.0};
    double length = sqrt(level2 + along.y * along.y), level = sqrt(level2);
    double sine = along.y / length;
    return (struct vec3){-sine * along.x / level, level / length, -sine * along.z / level};
}

static void hold(const struct response_context *context, uint32_t row, struct free_body *body)
{
    struct level_body level;
    resting_level_body(context, row, &level);
    body->held = true;
    body->up = up_of(context, row);
    body->forward = (struct vec3){level.forward_x, 0.0, level.forward_z};
    body->most = (struct free_grip){level.grip_along, level.grip_across, level.grip_turn};
}

static uint32_t body_for(struct free_bodies *bodies, const struct response_context *context,
                         uint32_t row)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    if (bodies->body_of[row] != 0)
        return bodies->body_of[row];
    uint32_t index = bodies->body_of[row] = bodies->count++;
    struct free_side *side = &bodies->side[index];
    struct free_body *body = &bodies->body[index];
    *side = (struct free_side){
        .row = row,
        .is_free = contact_groups_is_free(context, row),
        .wreck = e->row[row].state == ENTITY_WRECK,
        .piloted = contact_groups_is_piloted(context, row),
        .mass = mass_properties_of(&context->world->kinds[e->row[row].kind]),
        .turn = rotation_of(w->row[row].heading, w->row[row].pitch, w->row[row].roll),
        .at = entities_position(w, row),
        .parent = index};
    struct mat3 axes = rotation_matrix(side->turn);
    side->arm = path_change_arm(context, row, &axes);
    *body = (struct free_body){.inverse_mass = 1.0 / side->mass.mass_kg};
    if (side->is_free) {
        body->inverse_inertia = mass_properties_inverse_world(&side->mass, &axes);
    } else {
        hold(context, row, body);
        body->inverse_inertia.m[1][1] = 1.0 / side->mass.moment.y;
    }
    if (side->is_free && side->wreck)
        begin_wreck(context, side, body);
    else if (side->piloted)
        begin_piloted(context, side, body);
    else if (path_change_on_course(context, row))
        begin_course(context, side, body);
    else
        begin_moved(context, side, body);
    return index;
}

uint32_t free_bodies_root(struct free_bodies *bodies, uint32_t body)
{
    while (bodies->side[body].parent != body) {
        bodies->side[body].parent = bodies->side[bodies->side[body].parent].parent;
        body = bodies->side[body].parent;
    }
    return body;
}

static bool drifts(const struct free_bodies *bodies, uint32_t row)
{
    const struct vec3 drift = bodies->drift[row];
    return vec3_dot(drift, drift) > 0.0;
}

void free_bodies_drift(struct free_bodies *bodies, uint32_t row, struct vec3 drift)
{
    bool listed = drifts(bodies, row);
    bodies->drift[row] = drift;
    if (!listed && drifts(bodies, row))
        bodies->drifting[bodies->drifting_count++] = row;
}

static void join(struct free_bodies *bodies, uint32_t p, uint32_t q)
{
    uint32_t a = free_bodies_root(bodies, p), b = free_bodies_root(bodies, q);
    bodies->side[a > b ? a : b].parent = a > b ? b : a;
}

/* --- points ------------------------------------------------------------------------------------*/

static struct free_contact *next_contact(struct free_bodies *bodies)
{
    if (bodies->contacts == bodies->contact_capacity) {
        uint32_t more = 2 * bodies->contact_capacity;
        bodies->contact =
            reserve_grow(bodies->contact, bodies->contacts, more, sizeof *bodies->contact);
        bodies->contact_capacity = more;
    }
    return &bodies->contact[bodies->contacts++];
}

static struct vec3 centre_of(const struct free_bodies *bodies, uint32_t body)
{
    return vec3_add(bodies->side[body].at, bodies->side[body].arm);
}

/* rest_m: the gap that the bodies keep; push_m: a smaller one is pushed apart. */
static void set_room(const struct response_context *context, struct free_contact *contact,
                     double gap_m, double rest_m, double push_m)
{
    double dt_s = world_dt_s(context->world), deep = push_m - gap_m;
    contact->least_mps = -maths_max(0.0, gap_m - rest_m) / dt_s;
    contact->apart_mps = deep > 0.0 ? maths_min(PUSH_SHARE * deep / dt_s, PUSH_MPS) : 0.0;
}

static void add_point(struct free_bodies *bodies, const struct response_context *context,
                      const struct pair *pair, uint32_t a, uint32_t b,
                      const struct free_point *point)
{
    const struct kind *ka = contact_impulse_kind(context, pair->a);
    const struct kind *kb = contact_impulse_kind(context, pair->b);
    struct free_contact *contact = next_contact(bodies);
    double arm = INFINITY;
    *contact = (struct free_contact){.a = a,
                                     .b = b,
                                     .normal = point->normal,
                                     .arm_a = vec3_sub(point->at, centre_of(bodies, a)),
                                     .friction = sqrt(ka->friction * kb->friction)};
    if (bodies->side[a].is_free)
        arm = vec3_length(contact->arm_a);
    if (b != 0) {
        contact->arm_b = vec3_sub(point->at, centre_of(bodies, b));
        if (bodies->side[b].is_free)
            arm = maths_min(arm, vec3_length(contact->arm_b));
    }
    contact->rolling_m = ROLLING_BODY * arm;
    set_room(context, contact, point->gap_m, CONTACT_REST_M, PUSH_M);
}

/* Returns how fast the bodies of the pair close at most without the fall of this frame [m/s]. */
static double closing(const struct free_bodies *bodies, const struct free_pair *pair, bool falls)
{
    double most = 0.0;
    for (uint32_t i = pair->first; i < pair->first + pair->count; i++) {
        const struct free_contact *contact = &bodies->contact[i];
        struct vec3 fall = vec3_sub(bodies->side[contact->b].fall, bodies->side[contact->a].fall);
        double speed = free_solver_closing(bodies->body, contact);
        if (falls)
            speed += vec3_dot(fall, contact->normal);
        most = maths_max(most, speed);
    }
    return most;
}

static struct free_pair *next_pair(struct free_bodies *bodies)
{
    if (bodies->pairs == bodies->pair_capacity) {
        uint32_t more = 2 * bodies->pair_capacity + 1;
        bodies->pair = reserve_grow(bodies->pair, bodies->pairs, more, sizeof *bodies->pair);
        bodies->pair_capacity = more;
    }
    return &bodies->pair[bodies->pairs];
}

static double nearing(const struct swept_body *a, const struct swept_body *b)
{
    return vec3_length(vec3_sub(a->path.along, b->path.along)) +
           rotation_rate(a->from, a->to) * a->bound_m + rotation_rate(b->from, b->to) * b->bound_m;
}

/* Returns the closing speed from which on a pair is left to the search for impacts [m/s]. One that
 * has pressed in the last frame is never: where two bodies hook into each other at several points,
 * impacts at one point after the other do not end. */
static double impact_mps(const struct response_context *context, const struct pair *pair,
                         double gap_m)
{
    const struct persistent_contact *known = contact_table_find(context, pair->a, pair->b);
    if (gap_m > CONTACT_TOUCHING_M)
        return CONTACT_IMPACT_MPS;
    bool pressed = known && known->pressed_tick + 1 >= (uint32_t)context->next->head->tick;
    return pressed ? INFINITY : TOUCHING_MPS;
}

/* Takes a pair whose bodies are near and do not close as fast as in an impact. */
static void take(struct free_bodies *bodies, struct response_context *context,
                 const struct pair *pair)
{
    struct free_point point[FREE_POINTS_MAX];
    struct free_turn turn_a, turn_b;
    struct swept_body a = body_motion_body(context->motion, pair->a, &turn_a);
    struct swept_body b = body_motion_side(context->motion, pair->b, &turn_b);
    uint32_t count = free_points_find(&a, &b, NEAR_M + nearing(&a, &b), point);
    if (count == 0)
        return;
    struct free_pair *taken = next_pair(bodies);
    *taken = (struct free_pair){.first = bodies->contacts, .count = count};
    uint32_t body_a = body_for(bodies, context, pair->a);
    uint32_t body_b = pair->b & PAIR_FIXED ? 0 : body_for(bodies, context, pair->b);
    double gap = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        add_point(bodies, context, pair, body_a, body_b, &point[i]);
        gap = maths_min(gap, point[i].gap_m);
    }
    taken->overlaps = gap < 0.0;
    if (closing(bodies, taken, true) >= impact_mps(context, pair, gap)) {
        bodies->contacts = taken->first;
        return;
    }
    bodies->side[body_a].points += count;
    bodies->side[body_b].points += count;
    if (body_b != 0)
        join(bodies, body_a, body_b);
    taken->pair = contact_queue_pair(context->contacts, pair);
    bodies->pairs++;
}

/* Adds the points of a free body on the ground. The springs of a vehicle let hulls into the ground,
 * those of its wheels for one: the ground stops them, and pushes them out only slowly. */
static void add_ground(struct free_bodies *bodies, const struct response_context *context,
                       uint32_t index)
{
    const struct free_side *side = &bodies->side[index];
    const struct free_motion *moved = &bodies->body[index].moved;
    const struct kind *kind = contact_impulse_kind(context, side->row);
    struct free_point point[FREE_POINTS_MAX];
    struct body_points points;
    double speed = vec3_length(moved->velocity);
    body_points_of(context->world, context->next->entities.row[side->row].kind, &points);
    double reach = points.reach_m + side->mass.centre_m;
    double margin =
        NEAR_M + (speed + vec3_length(moved->spin) * reach) * world_dt_s(context->world);
    uint32_t count = free_points_on_ground(context->world, context->input.detect.craters, &points,
                                           side->at, side->turn, margin, point);
    for (uint32_t i = 0; i < count; i++) {
        struct free_contact *contact = next_contact(bodies);
        struct vec3 arm = vec3_sub(point[i].at, centre_of(bodies, index));
        *contact = (struct free_contact){.a = 0,
                                         .b = index,
                                         .normal = point[i].normal,
                                         .arm_b = arm,
                                         .friction = sqrt(kind->friction * GROUND_FRICTION) +
                                                     PLOUGH_S2PM2 * speed * speed,
                                         .rolling_m = ROLLING_GROUND * vec3_length(arm)};
        double most_m = side->wreck ? INFINITY : SPRUNG_DEEP_M;
        double gap_m = maths_max(point[i].gap_m, -most_m);
        set_room(context, contact, gap_m, 0.0, PUSH_GROUND_M);
    }
}

/* --- all ---------------------------------------------------------------------------------------*/

/* Returns true if the bodies of the pair press on each other. */
static bool presses(const struct free_bodies *bodies, const struct free_pair *pair)
{
    for (uint32_t n = pair->first; n < pair->first + pair->count; n++) {
        if (bodies->contact[n].impulse_ns[FREE_NORMAL] > 0.0)
            return true;
    }
    return pair->overlaps;
}

/* A pair that rests without points on the map is swept, and an impact if it closes as fast. */
static void mark(struct free_bodies *bodies, struct response_context *context)
{
    for (uint32_t i = 0; i < bodies->pairs; i++) {
        const struct free_pair *pair = &bodies->pair[i];
        uint8_t *marks = &context->contacts->marks[pair->pair];
        if (!presses(bodies, pair))
            continue;
        if (closing(bodies, pair, false) < CONTACT_IMPACT_MPS)
            contact_queue_rest(context->contacts, pair->pair, NULL, 0);
        *marks |= CONTACT_PRESSED | (pair->overlaps ? CONTACT_OVERLAPS : 0);
        bodies->side[bodies->contact[pair->first].a].pressed = true;
        bodies->side[bodies->contact[pair->first].b].pressed = true;
    }
}

/* Forgets the last frame. */
static void forget(struct free_bodies *bodies)
{
    for (uint32_t i = 0; i < bodies->moved_count; i++)
        bodies->owned[bodies->moved[i]] = 0;
    for (uint32_t i = 0; i < bodies->drifting_count; i++)
        bodies->drift[bodies->drifting[i]] = (struct vec3){0.0, 0.0, 0.0};
    bodies->drifting_count = 0;
    bodies->moved_count = bodies->pairs = bodies->contacts = 0;
    bodies->count = 1;
}

/* Solves the contacts of the groups, and moves their bodies. */
static void solve(struct free_bodies *bodies, struct response_context *context)
{
    bodies->body[0] = (struct free_body){.inverse_mass = 0.0};
    bodies->side[0] = (struct free_side){.parent = 0};
    for (uint32_t i = 0; i < bodies->groups.count; i++)
        take(bodies, context, &bodies->groups.pair[i]);
    for (uint32_t i = 1; i < bodies->count; i++) {
        if (bodies->side[i].is_free && !bodies->side[i].piloted && bodies->side[i].points > 0)
            add_ground(bodies, context, i);
    }
    work_done();
    free_solver_run(bodies->body, bodies->count, bodies->contact, bodies->contacts);
    mark(bodies, context);
    free_motion_run(bodies, context);
}

void free_bodies_solve(struct free_bodies *bodies, struct response_context *context)
{
    forget(bodies);
    contact_groups_find_free(&bodies->groups, context);
    if (bodies->groups.count > 0)
        solve(bodies, context);
}
