/* A body that stays on a line along its velocity has the same angular momentum about any point. */
#include "collider/guard/drift_guard.h"

#include "collider/solver/overlap_shift.h"
#include "world/entity/free_rotation.h"
#include "world/entity/mass_properties.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>

/* Newton's steps by which an orientation is found that gains no energy, and the longest turn of
 * one: a longer one would be a pose beside the way. */
#define GAIN_STEPS    5
#define GAIN_MOST_RAD 0.1

int drift_guard_init(struct drift_guard *drift, const struct world *world)
{
    uint32_t rows = world->params->capacity;
    *drift = (struct drift_guard){.count = 0};
    drift->before = reserve_take(rows, sizeof *drift->before);
    drift->after = reserve_take(rows, sizeof *drift->after);
    drift->row = reserve_take(rows, sizeof *drift->row);
    drift->seen_row = reserve_take(rows, sizeof *drift->seen_row);
    drift->seen = calloc(rows, sizeof *drift->seen);
    if (drift->before && drift->after && drift->row && drift->seen_row && drift->seen)
        return 0;
    drift_guard_free(drift);
    errno = ENOMEM;
    return -1;
}

void drift_guard_free(struct drift_guard *drift)
{
    reserve_free(drift->before);
    reserve_free(drift->after);
    reserve_free(drift->row);
    reserve_free(drift->seen_row);
    free(drift->seen);
    *drift = (struct drift_guard){.count = 0};
}

bool drift_guard_drifts(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return e->row[row].state == ENTITY_ACTIVE && e->row[row].behaviour == BEHAVIOUR_HOLD &&
           context->world->kinds[e->row[row].kind].domain == DOMAIN_AIR;
}

bool drift_guard_heeds(const struct response_context *context,
                       const struct persistent_contact *contact)
{
    const struct entities *e = &context->next->entities;
    uint32_t a = contact->a_row, b = contact->b_row;
    bool fixed = contact->b_id & PERSISTENT_CONTACT_FIXED;
    return entities_alive(e, a, contact->a_id) && (fixed || entities_alive(e, b, contact->b_id)) &&
           (drift_guard_drifts(context, a) || (!fixed && drift_guard_drifts(context, b)));
}

static struct mass_properties mass_of(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return mass_properties_of(&context->world->kinds[e->row[row].kind]);
}

static struct vec3 spin_of(const struct entities *e, uint32_t row)
{
    return (struct vec3){e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z};
}

static struct quat pose_of(const struct entities *e, uint32_t row)
{
    return rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll);
}

/* Returns the angular momentum of the row's rotation [N m s]. */
static struct vec3 own_momentum(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return free_rotation_momentum(mass_of(context, row).moment, pose_of(e, row), spin_of(e, row));
}

/* Returns an orientation beside this one in which a body with this momentum has no more than this
 * energy of rotation, twice. Its energy changes with a turn by the product of turn, spin and
 * momentum. A share of a turn that contacts have changed is not quite on the way on which the body
 * would turn freely, without a gain of energy. */
static struct quat without_gain(struct vec3 moment, struct quat turned, struct vec3 momentum,
                                double twice_j)
{
    for (int i = 0; i < GAIN_STEPS; i++) {
        struct vec3 spin = free_rotation_spin(moment, turned, momentum);
        struct vec3 slope = vec3_cross(spin, momentum);
        double gain = vec3_dot(spin, momentum) - twice_j, square = vec3_dot(slope, slope);
        double turn_rad = 0.5 * gain / sqrt(square);
        if (!(gain > 0.0) || !(turn_rad < GAIN_MOST_RAD))
            break;
        turned = rotation_spun(turned, vec3_scale(slope, -0.5 * gain / square), 1.0);
    }
    return turned;
}

void drift_guard_send_back(struct response_context *context, uint32_t row, double share)
{
    const struct entities *w = &context->motion->before;
    const struct path *path = &context->path[row];
    double time = path->since + (1.0 - path->since) * maths_max(share, 0.0);
    struct vec3 momentum = own_momentum(context, row);
    struct vec3 at = share < 0.0 ? entities_position(w, row) : path_at(path, time);
    struct quat to =
        share < 0.0 ? pose_of(w, row) : body_motion_orientation(context->motion, row, time);
    double heading, pitch, roll;
    if (share >= 0.0)
        to = without_gain(mass_of(context, row).moment, to, momentum,
                          vec3_dot(momentum, spin_of(&context->next->entities, row)));
    rotation_angles(to, &heading, &pitch, &roll);
    table_set_position(&context->writer, row, at);
    table_set_heading(&context->writer, row, heading);
    table_set_pitch(&context->writer, row, pitch);
    table_set_roll(&context->writer, row, roll);
    table_set_spin(&context->writer, row,
                   free_rotation_spin(mass_of(context, row).moment, to, momentum));
}

/* --- momenta -----------------------------------------------------------------------------------*/

/* Returns the row as a body with this position and orientation, and with the momenta that it has in
 * the table. */
static struct solver_body body_at(const struct response_context *context, uint32_t row,
                                  struct vec3 at, struct quat turned)
{
    const struct mass_properties mass = mass_of(context, row);
    struct mat3 axes = rotation_matrix(turned);
    struct vec3 arm = rotation_apply(&axes, (struct vec3){0.0, mass.centre_m, 0.0});
    double light = 1.0 / mass.mass_kg;
    struct vec3 spin = free_rotation_spin(mass.moment, turned, own_momentum(context, row));
    return (struct solver_body){
        .inverse_mass = {light, light, light},
        .inverse_inertia = mass_properties_inverse_world(&mass, &axes),
        .centre = vec3_add(at, arm),
        .velocity =
            vec3_add(entities_velocity(&context->next->entities, row), vec3_cross(spin, arm)),
        .spin = spin};
}

static void add(struct drift_guard *drift, uint32_t row)
{
    if (drift->seen[row])
        return;
    drift->seen[row] = 1;
    drift->seen_row[drift->seen_count++] = row;
    drift->row[drift->count++] = row;
}

/* Lists the row, and all that it has met, directly or not. Returns false if one of them does not
 * drift. */
static bool gather(struct drift_guard *drift, const struct response_context *context, uint32_t row)
{
    const struct contact_queue *contacts = context->contacts;
    bool all = true;
    drift->count = 0;
    add(drift, row);
    for (uint32_t i = 0; i < drift->count; i++) {
        uint32_t link = contacts->head[drift->row[i]];
        for (; link != 0; link = contacts->link[link - 1].next) {
            const struct pair *pair = &contacts->pair[contacts->link[link - 1].pair];
            uint32_t other = pair->a == drift->row[i] ? pair->b : pair->a;
            if (contacts->met[contacts->link[link - 1].pair] == 0)
                continue;
            if (other & PAIR_FIXED || !drift_guard_drifts(context, other))
                all = false;
            else
                add(drift, other);
        }
    }
    return all;
}

void drift_guard_restore(struct drift_guard *drift, struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    if (drift->seen[row] || !gather(drift, context, row))
        return;
    for (uint32_t i = 0; i < drift->count; i++) {
        uint32_t one = drift->row[i];
        drift->before[i] = body_at(context, one, path_at(&context->path[one], 1.0),
                                   body_motion_rotation(context->motion, one).to);
        drift->after[i] = body_at(context, one, entities_position(e, one), pose_of(e, one));
    }
    if (!overlap_shift_restore(drift->before, drift->after, drift->count))
        return;
    for (uint32_t i = 0; i < drift->count; i++) {
        const struct solver_body *body = &drift->after[i];
        struct vec3 arm = vec3_sub(body->centre, entities_position(e, drift->row[i]));
        table_set_velocity(&context->writer, drift->row[i],
                           vec3_sub(body->velocity, vec3_cross(body->spin, arm)));
        table_set_spin(&context->writer, drift->row[i], body->spin);
    }
}

void drift_guard_forget(struct drift_guard *drift)
{
    for (uint32_t i = 0; i < drift->seen_count; i++)
        drift->seen[drift->seen_row[i]] = 0;
    drift->seen_count = 0;
}
