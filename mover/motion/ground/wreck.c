/* Moves wrecks: rigid bodies over the ground, and hulls that drift on the water and sink. */
#include "mover/motion/ground/wreck.h"

#include "mover/motion/ground/ground_body.h"
#include "mover/context/ground_strike.h"
#include "mover/motion/kinematics.h"
#include "mover/motion/ground/sinking.h"
#include "mover/motion/spin.h"
#include "world/entity/wreck_drag.h"
#include "world/state.h"
#include "world/world.h"

#define AFLOAT_FRICTION 0.03 /* of a ship's wreck: share of the weight */

/* A wreck that is slower than this for so long comes to rest, if no point is deeper. */
#define REST_MPS     0.05
#define REST_RPS     0.05
#define REST_S       0.5
#define REST_DEPTH_M 0.02

/* The ground holds a wreck at rest that its neighbours push no faster than this [m/s, rad/s]. */
#define HELD_MPS 1e-3
#define HELD_RPS 1e-3

static bool is_slower(const struct entities *m, uint32_t i, double most_mps, double most_rps)
{
    struct vec3 spin = {m->row[i].spin_x, m->row[i].spin_y, m->row[i].spin_z};
    return vec3_length(entities_velocity(m, i)) < most_mps && vec3_length(spin) < most_rps;
}

static void stop(struct entities *m, uint32_t i)
{
    entities_set_velocity(m, i, (struct vec3){0.0, 0.0, 0.0});
    m->row[i].spin_x = m->row[i].spin_y = m->row[i].spin_z = 0.0;
}

static bool is_due(const struct step_context *context, uint32_t i)
{
    uint32_t until = context->m->row[i].until_tick;
    return until != 0 && until <= (uint32_t)context->tick;
}

/* --- ships -------------------------------------------------------------------------------------*/

static void drift(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    bool turned = spin_row(context, i);
    double speed = sqrt(m->row[i].vx * m->row[i].vx + m->row[i].vz * m->row[i].vz);
    double left = maths_max(0.0, speed - AFLOAT_FRICTION * GRAVITY_MPS2 * context->dt_s);
    double share = speed > 0.0 ? left / speed : 0.0;
    m->row[i].vx *= share;
    m->row[i].vz *= share;
    kinematics_advance(context, &m->row[i].x, &m->row[i].vx);
    kinematics_advance(context, &m->row[i].z, &m->row[i].vz);
    bool sinks = sinking_hull(context, i);
    if (!turned && !sinks && entities_still(m, i))
        m->row[i].until_tick = (uint32_t)context->tick;
}

/* --- rigid bodies ------------------------------------------------------------------------------*/

/* Breaks up an aircraft from which the ground took this energy at once. */
static void break_up(const struct step_context *context, uint32_t i, double taken_j,
                     struct ground_contacts *contacts)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (kind->domain != DOMAIN_AIR || m->row[i].flags & ENTITY_FLAG_BROKEN ||
        taken_j < WRECK_BREAKS_JPKG * kind->mass_kg)
        return;
    m->row[i].flags |= ENTITY_FLAG_BROKEN;
    m->row[i].trigger = TRIGGER_BROKEN;
    ground_contacts_break(contacts);
}

void wreck_tell_broken(struct serial_context *context, uint32_t i)
{
    const struct step_context *step = context->step;
    struct vec3 before = entities_velocity(&step->committed->entities, i);
    struct vec3 change = vec3_sub(entities_velocity(step->m, i), before);
    struct event_collision *hit = ground_strike_tell_below(context, i, RESPONSE_DESTROYED);
    table_set_changed_tick(&context->writer, i, (uint32_t)step->tick);
    if (hit == NULL)
        return;
    hit->toi = 1.0;
    hit->impulse_ns =
        (float)(step->world->kinds[step->m->row[i].kind].mass_kg * vec3_length(change));
}

/* Notes that the row is slow, or that it is not, and brings it to rest when it has been slow for
 * long enough. */
static void settle(const struct step_context *context, uint32_t i, double depth_m)
{
    struct entities *m = context->m;
    if (!is_slower(m, i, REST_MPS, REST_RPS) || depth_m >= REST_DEPTH_M) {
        m->row[i].until_tick = 0;
    } else if (m->row[i].until_tick == 0 && !sinking_begin(context, i)) {
        m->row[i].until_tick = (uint32_t)context->tick + (uint32_t)ceil(REST_S / context->dt_s);
    } else if (is_due(context, i)) {
        stop(m, i);
    }
}

/* The air slows the spin at the end of the frame, so that the body has turned as a free one. */
static void slow_spin(const struct kind *kind, struct rigid_body *body, double dt_s)
{
    const struct mat3 turn = rotation_matrix(body->turn);
    body->spin = wreck_drag_slow_spin(kind, &turn, body->spin, dt_s);
}

static void tumble(const struct step_context *context, uint32_t i)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    struct body_points points;
    struct ground_contacts contacts;
    body_points_of(context->world, context->m->row[i].kind, &points);
    ground_contacts_begin(&contacts, kind);
    if (context->m->row[i].flags & ENTITY_FLAG_BROKEN)
        ground_contacts_break(&contacts);
    struct rigid_body body = rigid_body_take(context, i);
    const struct mat3 turn = rotation_matrix(body.turn);
    body.velocity = wreck_drag_slow(kind, &turn, body.velocity, context->dt_s);
    double steps = ground_body_steps(&body, &points, context->dt_s), dt_s = context->dt_s / steps;
    double energy_j = rigid_body_energy(&body);
    bool met = false;
    for (int n = 0; n < (int)steps; n++) {
        ground_contacts_find(&contacts, context, &points, &body, dt_s);
        double taken_j = ground_body_step(&contacts, &body, 0.0, dt_s);
        break_up(context, i, taken_j, &contacts);
        met |= taken_j > 0.0;
    }
    if (met) /* a body that was lifted out of the ground falls again before the frame ends */
        (void)rigid_body_limit_energy(&body, energy_j);
    slow_spin(kind, &body, context->dt_s);
    rigid_body_put(context, i, &body);
    settle(context, i, ground_contacts_depth(&contacts));
}

bool wreck_rests(const struct step_context *context, uint32_t i)
{
    return is_due(context, i) && entities_still(context->m, i);
}

void wreck_row(const struct step_context *context, uint32_t i)
{
    if (wreck_rests(context, i))
        return; /* the common case */
    if (is_due(context, i) && is_slower(context->m, i, HELD_MPS, HELD_RPS))
        stop(context->m, i);
    else if (context->world->kinds[context->m->row[i].kind].domain == DOMAIN_SEA)
        drift(context, i);
    else if (!sinking_row(context, i))
        tumble(context, i);
}
