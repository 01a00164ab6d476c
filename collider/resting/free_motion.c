/* Decides who rests, and writes the rows of all others. */
#include "collider/resting/free_motion.h"

#include "collider/motion/free_fall.h"
#include "collider/resting/ground_placement.h"
#include "world/entity/free_rotation.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

/* Bodies that touch each other and are all slower than this for so long come to rest. */
#define REST_MPS 0.05
#define REST_RPS 0.05
#define REST_S   0.5

/* A held body under wrecks at rest may be this fast: a vehicle without brakes. */
#define HELD_MPS 5e-3
#define HELD_RPS 5e-3

/* A pilot may bring his aircraft nearer to another one by so much more than the contacts allow. */
#define STEERS_MPS 1e-4

/* --- rest --------------------------------------------------------------------------------------*/

/* What counts of a free body is what it kept of its velocity in the last frame: in a heap the
 * solver leaves a part of the weight's, and the guard at the frame's end takes it. */
static bool is_quick(const struct response_context *context, const struct free_side *side,
                     const struct free_body *body)
{
    const struct entities *w = &context->motion->before;
    uint32_t row = side->row;
    const struct vec3 spin = {w->row[row].spin_x, w->row[row].spin_y, w->row[row].spin_z};
    if (side->is_free)
        return vec3_length(entities_velocity(w, row)) > REST_MPS || vec3_length(spin) > REST_RPS;
    return vec3_length(body->moved.velocity) > HELD_MPS || vec3_length(body->moved.spin) > HELD_RPS;
}

/* Finds out which bodies that touch each other are all slow, and for how long they have been. */
static void find_rest(struct free_bodies *bodies, const struct response_context *context)
{
    const struct entities *w = &context->motion->before;
    uint32_t now = (uint32_t)context->next->head->tick;
    for (uint32_t i = 1; i < bodies->count; i++)
        bodies->side[i].due = true;
    for (uint32_t i = 1; i < bodies->count; i++) {
        const struct free_side *side = &bodies->side[i];
        struct free_side *root = &bodies->side[free_bodies_root(bodies, i)];
        uint32_t until = w->row[side->row].until_tick;
        if (side->points == 0)
            continue;
        root->quick |= is_quick(context, side, &bodies->body[i]);
        if (side->is_free)
            root->due &= side->wreck && until != 0 && until <= now;
    }
}

/* Returns the field until_tick of a wreck (mover/motion/ground/wreck.h). */
static uint32_t until_tick(struct free_bodies *bodies, const struct response_context *context,
                           uint32_t index)
{
    const struct free_side *root = &bodies->side[free_bodies_root(bodies, index)];
    uint32_t now = (uint32_t)context->next->head->tick;
    uint32_t until = context->motion->committed->entities.row[bodies->side[index].row].until_tick;
    if (root->quick)
        return 0;
    return until != 0 ? until : now + (uint32_t)ceil(REST_S / world_dt_s(context->world));
}

/* --- aircraft that go together -----------------------------------------------------------------*/

/* Adds up the bodies that touch each other, directly or not. */
static void add_up(struct free_bodies *bodies)
{
    for (uint32_t i = 1; i < bodies->count; i++) {
        struct free_side *root = &bodies->side[free_bodies_root(bodies, i)];
        double kg = bodies->side[i].mass.mass_kg;
        root->kg += bodies->side[i].piloted ? kg : -INFINITY;
        root->momentum = vec3_add(root->momentum, vec3_scale(bodies->body[i].moved.velocity, kg));
    }
    for (uint32_t i = 0; i < bodies->contacts; i++) {
        const struct free_contact *contact = &bodies->contact[i];
        if (contact->b == 0)
            bodies->side[free_bodies_root(bodies, contact->a)].kg = -INFINITY;
    }
}

/* Finds the way that aircraft in contact with nothing else go together. Those that the guard sends
 * back stay behind the others by no more than their own part of the motion. */
static void find_drift(struct free_bodies *bodies, double dt_s)
{
    add_up(bodies);
    for (uint32_t i = 1; i < bodies->count; i++) {
        const struct free_side *root = &bodies->side[free_bodies_root(bodies, i)];
        if (root->kg > 0.0)
            free_bodies_drift(bodies, bodies->side[i].row,
                              vec3_scale(root->momentum, dt_s / root->kg));
    }
}

/* --- motion ------------------------------------------------------------------------------------*/

static struct vec3 clamped(const struct world *world, struct vec3 at)
{
    at.x = world_clamp(world, at.x);
    at.z = world_clamp(world, at.z);
    return at;
}

static void put(const struct response_context *context, uint32_t row, struct vec3 at,
                struct quat turn, struct vec3 velocity, struct vec3 spin)
{
    double heading, pitch, roll;
    rotation_angles(turn, &heading, &pitch, &roll);
    table_set_position(&context->writer, row, clamped(context->world, at));
    table_set_velocity(&context->writer, row, velocity);
    table_set_spin(&context->writer, row, spin);
    table_set_heading(&context->writer, row, heading);
    table_set_pitch(&context->writer, row, pitch);
    table_set_roll(&context->writer, row, roll);
}

/* A wreck at rest stays as it was committed, to the bit. */
static void put_at_rest(const struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before;
    const struct vec3 none = {0.0, 0.0, 0.0};
    table_set_position(&context->writer, row, entities_position(w, row));
    table_set_velocity(&context->writer, row, none);
    table_set_spin(&context->writer, row, none);
    table_set_heading(&context->writer, row, w->row[row].heading);
    table_set_pitch(&context->writer, row, w->row[row].pitch);
    table_set_roll(&context->writer, row, w->row[row].roll);
}

/* Moves a free body for the whole frame at the velocity that it has at its end. */
static void move_free(const struct response_context *context, const struct free_side *side,
                      const struct free_body *body)
{
    double dt_s = world_dt_s(context->world);
    struct quat turn = side->turn;
    struct vec3 spin = body->moved.spin;
    free_rotation_turn(side->mass.moment, &turn, &spin, dt_s);
    turn = rotation_spun(turn, body->pushed.spin, dt_s);
    struct mat3 axes = rotation_matrix(turn);
    struct vec3 arm = rotation_apply(&axes, (struct vec3){0.0, side->mass.centre_m, 0.0});
    struct vec3 way = vec3_add(body->moved.velocity, body->pushed.velocity);
    struct vec3 centre = vec3_add(vec3_add(side->at, side->arm), vec3_scale(way, dt_s));
    put(context, side->row, vec3_sub(centre, arm), turn,
        vec3_sub(body->moved.velocity, vec3_cross(spin, arm)), spin);
}

static bool same(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Moves an aircraft. Returns false if its contacts have changed nothing. */
static bool move_piloted(struct response_context *context, const struct free_side *side,
                         const struct free_body *body)
{
    const struct entities *e = &context->next->entities;
    const struct vec3 none = {0.0, 0.0, 0.0};
    double dt_s = world_dt_s(context->world);
    struct quat turn = side->turn;
    struct vec3 spin = body->moved.spin;
    if (same(body->moved.velocity, body->wanted.velocity) &&
        same(body->moved.spin, body->wanted.spin) && same(body->pushed.velocity, none) &&
        same(body->pushed.spin, none) && !side->let_go)
        return false;
    free_rotation_turn(side->mass.moment, &turn, &spin, dt_s);
    struct mat3 freely = rotation_matrix(turn);
    turn = rotation_spun(turn, vec3_add(side->steering, body->pushed.spin), dt_s);
    struct mat3 axes = rotation_matrix(turn);
    struct vec3 way = vec3_scale(vec3_add(body->moved.velocity, body->pushed.velocity), dt_s);
    struct vec3 change = vec3_sub(body->moved.velocity, body->wanted.velocity);
    put(context, side->row, vec3_add(side->at, way), turn,
        vec3_add(entities_velocity(e, side->row), change),
        rotation_apply(&axes, rotation_back(&freely, spin)));
    return true;
}

/* Adds what the contacts have changed to the motion of a held body. Returns false if that is
 * nothing. */
static bool move_held(struct response_context *context, const struct free_side *side,
                      const struct free_body *body)
{
    const struct entities *e = &context->next->entities;
    uint32_t row = side->row;
    double dt_s = world_dt_s(context->world);
    double turn = body->moved.spin.y - body->wanted.spin.y;
    struct vec3 change = vec3_sub(body->moved.velocity, body->wanted.velocity);
    if (change.x == 0.0 && change.z == 0.0 && turn == 0.0)
        return false;
    struct vec3 at = entities_position(e, row);
    at.x += change.x * dt_s;
    at.z += change.z * dt_s;
    ground_placement_put(context, row, clamped(context->world, at),
                         maths_wrap_turn(e->row[row].heading - turn * dt_s));
    table_set_vx(&context->writer, row, e->row[row].vx + change.x);
    if (change.y != 0.0)
        table_set_vy(&context->writer, row, e->row[row].vy + change.y);
    table_set_vz(&context->writer, row, e->row[row].vz + change.z);
    table_set_spin_y(&context->writer, row, e->row[row].spin_y + turn);
    return true;
}

/* --- pilots ------------------------------------------------------------------------------------*/

static void steer(struct free_bodies *bodies, double share)
{
    for (uint32_t i = 1; i < bodies->count; i++) {
        struct vec3 by = vec3_scale(bodies->side[i].steering, share);
        bodies->body[i].moved.spin = vec3_add(bodies->body[i].moved.spin, by);
    }
}

/* A pilot of this body lets go. Returns true if he has steered. */
static bool let_go(struct free_side *side)
{
    const struct vec3 none = {0.0, 0.0, 0.0};
    bool steered = vec3_dot(side->steering, side->steering) > 0.0;
    side->steering = none;
    side->let_go |= steered;
    return steered;
}

/* Takes the steering from the pilots whom it would bring nearer to another body than the contacts
 * allow: it has no momentum that the other could take. */
static void limit_steering(struct free_bodies *bodies)
{
    bool again = true;
    while (again) {
        again = false;
        steer(bodies, 1.0);
        for (uint32_t i = 0; i < bodies->contacts; i++) {
            struct free_contact *contact = &bodies->contact[i];
            contact->crossed =
                free_solver_closing(bodies->body, contact) > STEERS_MPS - contact->least_mps;
        }
        steer(bodies, -1.0);
        for (uint32_t i = 0; i < bodies->contacts; i++) {
            const struct free_contact *contact = &bodies->contact[i];
            if (!contact->crossed)
                continue;
            again |= let_go(&bodies->side[contact->a]);
            again |= let_go(&bodies->side[contact->b]);
        }
    }
}

/* Gives a body its motion. Returns false if that stays as it was. */
static bool move(struct free_bodies *bodies, struct response_context *context, uint32_t index)
{
    const struct free_side *side = &bodies->side[index];
    uint32_t row = side->row;
    if (side->points == 0 || (side->is_free && !side->piloted && !side->pressed))
        return false;
    if (!side->is_free)
        return move_held(context, side, &bodies->body[index]);
    if (side->piloted)
        return move_piloted(context, side, &bodies->body[index]);
    const struct free_side *root = &bodies->side[free_bodies_root(bodies, index)];
    free_fall_ahead(context->motion, row);
    bodies->owned[row] = 1;
    if (side->wreck)
        table_set_until_tick(&context->writer, row, until_tick(bodies, context, index));
    if (root->due && !root->quick)
        put_at_rest(context, row);
    else
        move_free(context, side, &bodies->body[index]);
    return true;
}

void free_motion_run(struct free_bodies *bodies, struct response_context *context)
{
    limit_steering(bodies);
    find_rest(bodies, context);
    find_drift(bodies, world_dt_s(context->world));
    for (uint32_t i = 1; i < bodies->count; i++) {
        uint32_t row = bodies->side[i].row;
        bodies->body_of[row] = 0;
        if (!move(bodies, context, i))
            continue;
        body_motion_compute(context->motion, row);
        bodies->moved[bodies->moved_count++] = row;
        contact_queue_ground(context->contacts, &context->input, row);
    }
    for (uint32_t i = 0; i < bodies->moved_count; i++)
        contact_queue_look(context->contacts, &context->input, bodies->moved[i], false);
}
