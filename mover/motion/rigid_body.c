/* Free motion of a rigid body. */
#include "mover/motion/rigid_body.h"

#include "world/entity/free_rotation.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

static struct vec3 arm_of(const struct rigid_body *body)
{
    struct mat3 turn = rotation_matrix(body->turn);
    return rotation_apply(&turn, (struct vec3){0.0, body->inertia.centre_m, 0.0});
}

struct rigid_body rigid_body_take(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    struct rigid_body body = {
        .inertia = mass_properties_of(&context->world->kinds[m->row[i].kind]),
        .turn = rotation_of(m->row[i].heading, m->row[i].pitch, m->row[i].roll),
        .spin = {m->row[i].spin_x, m->row[i].spin_y, m->row[i].spin_z},
    };
    struct vec3 arm = arm_of(&body);
    body.centre = vec3_add(entities_position(m, i), arm);
    body.velocity = vec3_add(entities_velocity(m, i), vec3_cross(body.spin, arm));
    return body;
}

static void stop_at_edge(const struct world *world, double *metres, double *speed_mps)
{
    double within = world_clamp(world, *metres);
    if (within != *metres)
        *speed_mps = 0.0;
    *metres = within;
}

void rigid_body_put(const struct step_context *context, uint32_t i, const struct rigid_body *body)
{
    struct entities *m = context->m;
    struct vec3 arm = arm_of(body);
    struct vec3 at = vec3_sub(body->centre, arm);
    struct vec3 velocity = vec3_sub(body->velocity, vec3_cross(body->spin, arm));
    stop_at_edge(context->world, &at.x, &velocity.x);
    stop_at_edge(context->world, &at.z, &velocity.z);
    entities_set_position(m, i, at);
    entities_set_velocity(m, i, velocity);
    rotation_angles(body->turn, &m->row[i].heading, &m->row[i].pitch, &m->row[i].roll);
    m->row[i].spin_x = body->spin.x;
    m->row[i].spin_y = body->spin.y;
    m->row[i].spin_z = body->spin.z;
}

/* Returns the kinetic energy of the rotation [J]. */
static double rotation_j(const struct rigid_body *body)
{
    struct mat3 turn = rotation_matrix(body->turn);
    struct vec3 w = rotation_back(&turn, body->spin), moment = body->inertia.moment;
    return 0.5 * (moment.x * w.x * w.x + moment.y * w.y * w.y + moment.z * w.z * w.z);
}

static double kinetic_j(const struct rigid_body *body)
{
    return 0.5 * body->inertia.mass_kg * vec3_dot(body->velocity, body->velocity) +
           rotation_j(body);
}

double rigid_body_energy(const struct rigid_body *body)
{
    return kinetic_j(body) + body->inertia.mass_kg * GRAVITY_MPS2 * body->centre.y;
}

bool rigid_body_limit_energy(struct rigid_body *body, double most_j)
{
    double kinetic = kinetic_j(body);
    double most = most_j - body->inertia.mass_kg * GRAVITY_MPS2 * body->centre.y;
    if (kinetic <= most)
        return true;
    double share = most > 0.0 ? sqrt(most / kinetic) : 0.0;
    body->velocity = vec3_scale(body->velocity, share);
    body->spin = vec3_scale(body->spin, share);
    return most >= 0.0;
}

void rigid_body_turn(struct rigid_body *body, struct vec3 extra_rps, double dt_s)
{
    free_rotation_turn(body->inertia.moment, &body->turn, &body->spin, dt_s);
    if (extra_rps.x == 0.0 && extra_rps.y == 0.0 && extra_rps.z == 0.0)
        return;
    double before = rotation_j(body);
    body->turn = rotation_spun(body->turn, extra_rps, dt_s);
    double after = rotation_j(body);
    if (after > before)
        body->spin = vec3_scale(body->spin, sqrt(before / after));
}
