/* Solves the islands of one moment, and gives the bodies their new paths. */
#include "collider/response/island.h"

#include "collider/method/method.h"
#include "collider/motion/free_fall.h"
#include "collider/response/contact_impulse.h"
#include "collider/response/island_gather.h"
#include "collider/solver/overlap_shift.h"
#include "collider/response/path_change.h"
#include "collider/response/response.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/state.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

/* Smaller overlaps are rounding, 50 km from the origin [m]. */
#define ROUNDING_M 1e-9

int island_init(struct island *island, const struct world *world)
{
    uint32_t rows = world->params->capacity, most = pair_filter_pairs_first(world);
    uint64_t solved = (uint64_t)rows + most;
    *island = (struct island){.met_capacity = most, .rows = rows};
    island->met = reserve_take(most, sizeof *island->met);
    island->body = reserve_take(rows, sizeof *island->body);
    island->row = reserve_take(rows, sizeof *island->row);
    island->body_of = calloc(rows, sizeof *island->body_of);
    island->solve = reserve_take(solved, sizeof *island->solve);
    island->solve_of = reserve_take(solved, sizeof *island->solve_of);
    island->contact = reserve_take(most, sizeof *island->contact);
    island->shift = reserve_take(rows, sizeof *island->shift);
    island->gap = reserve_take(ISLAND_RESTING_MOST, sizeof *island->gap);
    if (pair_list_init(&island->near, 2 * (uint64_t)most) == 0 && island->met && island->body &&
        island->row && island->body_of && island->solve && island->solve_of && island->contact &&
        island->shift && island->gap)
        return 0;
    island_free(island);
    errno = ENOMEM;
    return -1;
}

void island_free(struct island *island)
{
    reserve_free(island->met);
    reserve_free(island->body);
    reserve_free(island->row);
    free(island->body_of);
    reserve_free(island->solve);
    reserve_free(island->solve_of);
    reserve_free(island->contact);
    pair_list_free(&island->near);
    reserve_free(island->shift);
    reserve_free(island->gap);
    *island = (struct island){0};
}

/* --- into the solver ---------------------------------------------------------------------------*/

static struct solver_body solve_body_of(const struct response_context *context,
                                        struct island_body *body, double time)
{
    const struct entities *e = &context->next->entities;
    uint32_t row = body->row;
    const struct mass_properties inertia =
        mass_properties_of(&context->world->kinds[e->row[row].kind]);
    struct mat3 turn = rotation_matrix(body_motion_orientation(context->motion, row, time));
    double light = 1.0 / inertia.mass_kg;
    body->grounded = path_change_grounded(context, row);
    body->flies = context->world->kinds[e->row[row].kind].domain == DOMAIN_AIR;
    body->arm = path_change_arm(context, row, &turn);
    struct solver_body solve = {
        .centre = vec3_add(path_at(&context->path[row], time), body->arm),
    };
    if (body->grounded) { /* it can neither leave the ground nor roll over */
        solve.inverse_mass = (struct vec3){light, 0.0, light};
        solve.inverse_inertia.m[1][1] = 1.0 / inertia.moment.y;
    } else {
        solve.inverse_mass = (struct vec3){light, light, light};
        solve.inverse_inertia = mass_properties_inverse_world(&inertia, &turn);
    }
    solve.spin = path_change_spin(context, row, time);
    solve.velocity =
        vec3_add(path_change_velocity(context, row, time), vec3_cross(solve.spin, body->arm));
    if (body->grounded)
        solve.velocity.y = 0.0; /* the slope causes it; it would lift the other body */
    return solve;
}

/* Returns the body's index in the solver, and adds it on first use. */
static uint32_t local_of(const struct response_context *context, uint32_t *count, uint32_t index,
                         double time)
{
    struct island *island = context->island;
    if (index == BODY_FIXED) {
        island->solve[*count] = (struct solver_body){0};
        island->solve_of[*count] = BODY_FIXED;
        return (*count)++;
    }
    struct island_body *body = &island->body[index];
    if (body->local == UINT32_MAX) {
        island->solve[*count] = solve_body_of(context, body, time);
        island->solve_of[*count] = index;
        body->local = (*count)++;
    }
    return body->local;
}

/* --- and out again -----------------------------------------------------------------------------*/

/* Hulls have no depth that is right in all directions: where two edges cross, the normals of the
 * faces overstate it. Bodies on the ground and aircraft part by no more than this in an impact; the
 * rest is recovered while they are in contact, or the guard at the frame's end sends them back: two
 * jets that hooked into each other head-on were moved apart by 0.9 m in a frame [m]. Spheres on
 * the ground that are deep in each other part without impacts (collider/parting/sphere_parting.h).
 */
#define SHIFT_M 6e-3

static void shift(struct island_body *body, struct vec3 by, bool bit_by_bit)
{
    body->shift = vec3_add(body->shift, by);
    double length = vec3_length(body->shift);
    if (bit_by_bit && (body->grounded || body->flies) && length > SHIFT_M)
        body->shift = vec3_scale(body->shift, SHIFT_M / length);
}

/* The backup vector (Hahn 1988; thesis row 46): moves overlapping bodies apart along the normal,
 * the lighter by more, until their skins touch. In free space all bodies are limited together,
 * afterwards. */
static void move_apart(const struct response_context *context, const struct island_contact *met,
                       const struct solver_contact *contact, bool free)
{
    struct island *island = context->island;
    const struct collision_params *how = &context->world->params->collision;
    bool hulls = how->shape == SHAPE_MODEL;
    bool parts = !method_discrete((enum method)how->method) && met->body_b != BODY_FIXED &&
                 island->body[met->body_a].grounded && island->body[met->body_b].grounded;
    bool bit_by_bit = !free && (hulls || parts);
    double depth = met->impact.depth_m;
    if (!(depth > ROUNDING_M))
        return;
    struct vec3 n = contact->normal;
    double slant = vec3_dot(n, met->contact.impact.normal);
    double distance = (depth + (hulls ? SKIN_M : 0.0)) / maths_max(slant, 0.5);
    const struct solver_body *a = &island->solve[contact->a], *b = &island->solve[contact->b];
    double la = a->inverse_mass.x, lb = b->inverse_mass.x;
    shift(&island->body[met->body_a], vec3_scale(n, -distance * la / (la + lb)), bit_by_bit);
    if (met->body_b != BODY_FIXED)
        shift(&island->body[met->body_b], vec3_scale(n, distance * lb / (la + lb)), bit_by_bit);
}

/* Returns true if nothing but each other acts on the bodies. */
static bool in_free_space(const struct island *island, uint32_t bodies)
{
    for (uint32_t i = 0; i < bodies; i++) {
        if (island->solve_of[i] == BODY_FIXED || island->body[island->solve_of[i]].grounded)
            return false;
    }
    return true;
}

/* Returns the share of their shifts that bodies in free space get: one for all, so that their
 * centre of mass stays where it is. Models part bit by bit if one of them flies. */
static double share_of_shifts(const struct response_context *context, uint32_t bodies)
{
    const struct island *island = context->island;
    double share = 1.0;
    for (uint32_t i = 0; i < bodies; i++) {
        const struct island_body *body = &island->body[island->solve_of[i]];
        double length = vec3_length(body->shift);
        if (context->world->params->collision.shape == SHAPE_MODEL && body->flies &&
            length > SHIFT_M)
            share = maths_min(share, SHIFT_M / length);
    }
    return share;
}

/* Shifts bodies in free space, and gives them the momentum back that the shift took. */
static void keep_momentum(const struct response_context *context, uint32_t bodies)
{
    struct island *island = context->island;
    double share = share_of_shifts(context, bodies);
    bool shifts = false;
    for (uint32_t i = 0; i < bodies; i++) {
        struct island_body *body = &island->body[island->solve_of[i]];
        body->shift = vec3_scale(body->shift, share);
        island->shift[i] = body->shift;
        shifts |= vec3_dot(island->shift[i], island->shift[i]) > 0.0;
    }
    if (!shifts || overlap_shift_free(island->solve, island->shift, bodies))
        return;
    for (uint32_t i = 0; i < bodies; i++)
        island->body[island->solve_of[i]].shift = (struct vec3){0.0, 0.0, 0.0};
}

static void leave(struct response_context *context, const struct solver_body *solve,
                  const struct island_body *body, double time)
{
    uint32_t row = body->row;
    struct vec3 velocity = vec3_sub(solve->velocity, vec3_cross(solve->spin, body->arm));
    if (body->grounded)
        velocity.y = 0.0; /* the mover follows the slope again */
    velocity.y -= body->fallen_mps;
    struct vec3 at = vec3_add(path_at(&context->path[row], time), body->shift);
    path_change_leave(context, row, time, at, velocity, solve->spin, body->stays);
}

/* The way of a body in the air may differ from its velocity and spin: a pilot steers it, a wreck
 * falls, or it has met the ground. If this way alone makes a contact, the body goes on without the
 * difference, because no impulse can answer it; one that falls takes the speed of its fall at once.
 * Returns true if the body still had such a way. */
static bool drop_steering(const struct response_context *context, struct island_body *body,
                          double time)
{
    double fall = free_fall_left_mps(context->motion, body->row, time);
    if (body->grounded || (context->motion->change[body->row] != 0 && fall == 0.0))
        return false;
    if (fall > 0.0 && !body->stays) {
        body->fallen_mps = fall;
        free_fall_ahead(context->motion, body->row);
    }
    body->follows_spin = true;
    return true;
}

/* The bodies of this contact do not close by their velocities. */
static void answer_without_impulse(const struct response_context *context,
                                   const struct island_contact *met)
{
    struct island *island = context->island;
    double time = met->impact.time;
    bool drops = drop_steering(context, &island->body[met->body_a], time);
    if (met->body_b != BODY_FIXED)
        drops |= drop_steering(context, &island->body[met->body_b], time);
    if (!drops)
        contact_queue_skip_pair(context->contacts, &met->contact); /* it would be found again */
}

static bool same(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool is_unmoved(const struct solver_body *solve, const struct island_body *body)
{
    const struct vec3 none = {0.0, 0.0, 0.0};
    return !body->stays && !body->follows_spin && same(body->shift, none) &&
           same(solve->velocity, solve->velocity_before) && same(solve->spin, solve->spin_before);
}

static void solve_group(struct response_context *context, uint32_t first, double time)
{
    struct island *island = context->island;
    uint32_t bodies = 0, contacts = 0;
    for (uint32_t i = first; i != 0; i = island->met[i - 1].next) {
        const struct island_contact *met = &island->met[i - 1];
        uint32_t a = local_of(context, &bodies, met->body_a, time);
        uint32_t b = local_of(context, &bodies, met->body_b, time);
        const struct solver_body sides[2] = {island->solve[a], island->solve[b]};
        struct solver_contact *contact = &island->contact[contacts++];
        *contact = contact_impulse_contact(context, met, sides);
        contact->a = a;
        contact->b = b;
    }
    context->functions->joint(context, first, bodies);
    bool free = in_free_space(island, bodies);
    contacts = 0;
    for (uint32_t i = first; i != 0; i = island->met[i - 1].next) {
        const struct island_contact *met = &island->met[i - 1];
        const struct solver_contact *contact = &island->contact[contacts++];
        move_apart(context, met, contact, free);
        if (vec3_dot(contact->impulse, contact->impulse) == 0.0)
            answer_without_impulse(context, met);
    }
    if (free)
        keep_momentum(context, bodies);
    for (uint32_t i = 0; i < bodies; i++) {
        if (island->solve_of[i] == BODY_FIXED)
            continue;
        struct island_body *body = &island->body[island->solve_of[i]];
        body->unmoved = is_unmoved(&island->solve[i], body);
        if (!body->unmoved)
            leave(context, &island->solve[i], body, time);
    }
    contacts = 0;
    for (uint32_t i = first; i != 0; i = island->met[i - 1].next)
        contact_impulse_damage(context, &island->met[i - 1], &island->contact[contacts++]);
}

void island_answer(struct response_context *context, const struct contact *contact)
{
    struct island *island = context->island;
    double time = contact->impact.toi;
    island_gather(context, contact);
    for (uint32_t i = 0; i < island->bodies; i++) {
        if (island->body[i].first != 0)
            solve_group(context, island->body[i].first, time);
    }
    uint32_t moved = 0;
    for (uint32_t i = 0; i < island->bodies; i++) {
        island->body_of[island->body[i].row] = 0;
        if (!island->body[i].unmoved)
            island->row[moved++] = island->body[i].row;
    }
    path_change_swept(context, island->row, moved, time);
}
