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

/* --- rest --------------------------------------------------------------------------------------*/

static bool is_quick(const struct free_side *side, const struct free_body *body)
{
    double mps = side->is_free ? REST_MPS : HELD_MPS, rps = side->is_free ? REST_RPS : HELD_RPS;
    return vec3_length(body->moved.velocity) > mps || vec3_length(body->moved.spin) > rps;
}

/* Finds out which bodies that touch each other are all slow, and for how long they have been. */
static void find_rest(struct free_bodies *bodies, const struct response_context *context)
{
    const struct entities *w = &context->motion->committed->entities;
    uint32_t now = (uint32_t)context->next->head->tick;
    for (uint32_t i = 1; i < bodies->count; i++)
        bodies->side[i].due = true;
    for (uint32_t i = 1; i < bodies->count; i++) {
        const struct free_side *side = &bodies->side[i];
        struct free_side *root = &bodies->side[free_bodies_root(bodies, i)];
        uint32_t until = w->until_tick[side->row];
        if (side->points == 0)
            continue;
        root->quick |= is_quick(side, &bodies->body[i]);
        if (side->is_free)
            root->due &= side->wreck && until != 0 && until <= now;
    }
}

/* Returns the column until_tick of a wreck (mover/motion/wreck.h). */
static uint32_t until_tick(struct free_bodies *bodies, const struct response_context *context,
                           uint32_t index)
{
    const struct free_side *root = &bodies->side[free_bodies_root(bodies, index)];
    uint32_t now = (uint32_t)context->next->head->tick;
    uint32_t until = context->motion->committed->entities.until_tick[bodies->side[index].row];
    if (root->quick)
        return 0;
    return until != 0 ? until : now + (uint32_t)ceil(REST_S / world_dt_s(context->world));
}

/* --- motion ------------------------------------------------------------------------------------*/

static struct vec3 clamped(struct vec3 at)
{
    at.x = maths_clamp(at.x, 0.0, WORLD_SIDE_M);
    at.z = maths_clamp(at.z, 0.0, WORLD_SIDE_M);
    return at;
}

static void put(const struct response_context *context, uint32_t row, struct vec3 at,
                struct quat turn, struct vec3 velocity, struct vec3 spin)
{
    double heading, pitch, roll;
    rotation_angles(turn, &heading, &pitch, &roll);
    table_set_position(&context->writer, row, clamped(at));
    table_set_velocity(&context->writer, row, velocity);
    table_set_spin(&context->writer, row, spin);
    table_set_heading(&context->writer, row, heading);
    table_set_pitch(&context->writer, row, pitch);
    table_set_roll(&context->writer, row, roll);
}

/* A wreck at rest stays as it was committed, to the bit. */
static void put_at_rest(const struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->committed->entities;
    const struct vec3 none = {0.0, 0.0, 0.0};
    table_set_position(&context->writer, row, entities_position(w, row));
    table_set_velocity(&context->writer, row, none);
    table_set_spin(&context->writer, row, none);
    table_set_heading(&context->writer, row, w->heading[row]);
    table_set_pitch(&context->writer, row, w->pitch[row]);
    table_set_roll(&context->writer, row, w->roll[row]);
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
    ground_placement_put(context, row, clamped(at), maths_wrap_turn(e->heading[row] - turn * dt_s));
    table_set_vx(&context->writer, row, e->vx[row] + change.x);
    table_set_vz(&context->writer, row, e->vz[row] + change.z);
    table_set_spin_y(&context->writer, row, e->spin_y[row] + turn);
    return true;
}

/* Gives a body its motion. Returns false if that stays as it was. */
static bool move(struct free_bodies *bodies, struct response_context *context, uint32_t index)
{
    const struct free_side *side = &bodies->side[index];
    uint32_t row = side->row;
    if (side->points == 0)
        return false;
    if (!side->is_free)
        return move_held(context, side, &bodies->body[index]);
    const struct free_side *root = &bodies->side[free_bodies_root(bodies, index)];
    free_fall_end(context->motion, row);
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
    find_rest(bodies, context);
    for (uint32_t i = 1; i < bodies->count; i++) {
        uint32_t row = bodies->side[i].row;
        bodies->body_of[row] = 0;
        if (!move(bodies, context, i))
            continue;
        body_motion_compute(context->motion, row);
        bodies->moved[bodies->moved_count++] = row;
    }
    for (uint32_t i = 0; i < bodies->moved_count; i++)
        contact_queue_look(context->contacts, &context->input, bodies->moved[i], false);
}
