/* Touch-down, stand, slide and take-off. */
#include "mover/motion/ground/landing.h"

#include "mover/motion/airframe.h"
#include "mover/motion/ground/ground_body.h"
#include "mover/context/ground_strike.h"
#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

/* Faster over the ground than this, or tilted more against it, it crashes. */
#define SKIDS_MPS   20.0 /* helicopters: 40 knots, a run-on landing */
#define BELLY_SHARE 1.7  /* aeroplanes: of the stalling speed */
#define BELLY_MPS   6.0  /* aeroplanes: towards the ground */
#define LEVEL       0.94 /* cosine: 20 degrees */
#define BELLY_HARM  0.35 /* of what destroys an aeroplane: a landing without wheels */

#define CLIMBS_M 1.0 /* over the ground: an agent that wants to be higher takes off */
#define CLEAR_M  0.1 /* and flies from here */

/* A body that is slower, does not gain speed and is no deeper stays where it is. */
#define REST_MPS     0.03
#define REST_RPS     0.03
#define REST_MPS2    0.5
#define REST_DEPTH_M 0.02

/* --- touch-down --------------------------------------------------------------------------------*/

/* How a body meets the ground. */
struct touchdown {
    double closing_mps, along_mps;
    double level; /* cosine between its own up and that of the ground */
};

static struct touchdown touchdown_of(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    struct vec3 velocity = entities_velocity(m, i);
    struct vec3 normal =
        terrain_normal(&context->world->terrain, context->craters, m->row[i].x, m->row[i].z);
    struct mat3 turn =
        rotation_matrix(rotation_of(m->row[i].heading, m->row[i].pitch, m->row[i].roll));
    const struct vec3 up = {turn.m[0][1], turn.m[1][1], turn.m[2][1]};
    double closing = -vec3_dot(velocity, normal);
    return (struct touchdown){
        .closing_mps = closing,
        .along_mps = vec3_length(vec3_add(velocity, vec3_scale(normal, closing))),
        .level = vec3_dot(up, normal),
    };
}

static bool is_gentle(const struct kind *kind, const struct touchdown *touch)
{
    if (touch->level < LEVEL)
        return false;
    if (kind_hovers(kind))
        return touch->closing_mps < LANDING_HARD_MPS && touch->along_mps < SKIDS_MPS;
    return touch->closing_mps < BELLY_MPS && touch->along_mps < BELLY_SHARE * kind->min_speed_mps;
}

/* Returns the harm of a touch-down, as a share of what destroys the kind. */
static double harm_of(const struct kind *kind, double closing_mps)
{
    const double soft = LANDING_SOFT_MPS * LANDING_SOFT_MPS,
                 hard = LANDING_HARD_MPS * LANDING_HARD_MPS;
    double harm = maths_max(0.0, (closing_mps * closing_mps - soft) / (hard - soft));
    if (closing_mps <= LANDING_SOFT_MPS)
        harm = 0.0;
    return kind_hovers(kind) ? harm : maths_max(harm, BELLY_HARM);
}

/* Returns the height of the lowest point of row i over the ground [m]. */
static double clearance_of(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    struct body_points points;
    body_points_of(context->world, m->row[i].kind, &points);
    return body_points_clearance(context->world, context->craters, &points, entities_position(m, i),
                                 rotation_of(m->row[i].heading, m->row[i].pitch, m->row[i].roll));
}

bool landing_touch(const struct step_context *context, uint32_t i,
                   const struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct entities *w = &context->committed->entities;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (cover_is_water(terrain_cover(&context->world->terrain, m->row[i].x, m->row[i].z)) ||
        clearance_of(context, i) > 0.0)
        return false;
    struct touchdown touch = touchdown_of(context, i);
    if (!is_gentle(kind, &touch))
        return false;
    double harm = harm_of(kind, touch.closing_mps);
    m->row[i].flags |= ENTITY_FLAG_LANDED;
    m->row[i].harm_j += harm * kind->resistance_j;
    entities_set_position(m, i, entities_position(w, i));
    m->row[i].heading = w->row[i].heading, m->row[i].pitch = w->row[i].pitch,
    m->row[i].roll = w->row[i].roll;
    landing_move(context, i, desired);
    if (harm > 0.0)
        m->row[i].trigger = TRIGGER_AGROUND;
    return true;
}

/* --- on the ground -----------------------------------------------------------------------------*/

static bool wants_up(const struct step_context *context, uint32_t i, const struct kind *kind,
                     const struct desired_motion *desired)
{
    bool fuel = !(kind->fuel_l > 0.0) || context->m->row[i].fuel_l > 0.0;
    if (desired == NULL || !kind_hovers(kind) || !fuel)
        return false;
    return desired->driven ? desired->climb_mps > 0.0 : desired->altitude_m > CLIMBS_M;
}

/* Returns the lift of the rotor [m/s2]. The engine of a driven helicopter follows the collective
 * with a lag; it idles while that is down. */
static double lift_of(const struct step_context *context, uint32_t i,
                      const struct desired_motion *desired, bool up)
{
    const double full = (1.0 + AIRFRAME_COLLECTIVE) * GRAVITY_MPS2;
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (desired == NULL || !kind_hovers(kind))
        return 0.0;
    if (!desired->driven)
        return up ? full : 0.0;
    double spool = kinematics_approach(1.0 - (double)m->row[i].dodge, up ? 1.0 : 0.0,
                                       context->dt_s / AIRFRAME_GOVERNOR_S);
    m->row[i].dodge = (float)(1.0 - spool);
    return spool * full;
}

/* Moves the body for the frame. Returns false if it stays where it is. */
static bool run(const struct step_context *context, uint32_t i, double lift_mps2,
                struct rigid_body *body)
{
    struct body_points points;
    struct ground_contacts contacts;
    const struct vec3 before = body->velocity;
    body_points_of(context->world, context->m->row[i].kind, &points);
    ground_contacts_begin(&contacts, &context->world->kinds[context->m->row[i].kind]);
    double steps = ground_body_steps(body, &points, context->dt_s), dt_s = context->dt_s / steps;
    for (int n = 0; n < (int)steps; n++) {
        ground_contacts_find(&contacts, context, &points, body, dt_s);
        (void)ground_body_step(&contacts, body, lift_mps2, dt_s);
    }
    return ground_contacts_depth(&contacts) > REST_DEPTH_M ||
           vec3_length(body->velocity) > REST_MPS || vec3_length(body->spin) > REST_RPS ||
           vec3_length(vec3_sub(body->velocity, before)) > REST_MPS2 * context->dt_s;
}

void landing_move(const struct step_context *context, uint32_t i,
                  const struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    bool up = wants_up(context, i, kind, desired);
    double lift = lift_of(context, i, desired, up);
    struct rigid_body body = rigid_body_take(context, i);
    if (run(context, i, lift, &body)) {
        rigid_body_put(context, i, &body);
    } else { /* its place keeps every bit, so that heaps can sleep */
        entities_set_velocity(m, i, (struct vec3){0.0, 0.0, 0.0});
        m->row[i].spin_x = m->row[i].spin_y = m->row[i].spin_z = 0.0;
    }
    if (up && m->row[i].vy > 0.0 && clearance_of(context, i) > CLEAR_M)
        m->row[i].flags &= (uint8_t)~ENTITY_FLAG_LANDED;
}

void landing_tell_hard(struct serial_context *context, uint32_t i)
{
    (void)ground_strike_tell_below(context, i, RESPONSE_SLOW);
}
