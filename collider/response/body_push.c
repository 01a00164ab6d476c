/* A single impulse on one body. */
#include "collider/response/body_push.h"

#include "collider/response/path_change.h"
#include "world/entity/mass_properties.h"
#include "world/world.h"

/* A row as the impulse finds it. */
struct pushed {
    struct vec3 centre, arm; /* [m, world] of mass; from the position to it */
    double inverse_mass;
    struct mat3 inverse_inertia;
    bool grounded;
};

static struct mass_properties properties_of(const struct response_context *context, uint32_t row)
{
    return mass_properties_of(&context->world->kinds[context->next->entities.row[row].kind]);
}

struct vec3 body_push_centre(const struct response_context *context, uint32_t row, double time,
                             struct mat3 *turn)
{
    const struct mass_properties inertia = properties_of(context, row);
    *turn = rotation_matrix(body_motion_orientation(context->motion, row, time));
    struct vec3 arm = rotation_apply(turn, (struct vec3){0.0, inertia.centre_m, 0.0});
    return vec3_add(path_at(&context->path[row], time), arm);
}

static struct pushed pushed_of(const struct response_context *context, uint32_t row, double time)
{
    const struct mass_properties inertia = properties_of(context, row);
    struct mat3 turn;
    struct pushed body = {.centre = body_push_centre(context, row, time, &turn),
                          .inverse_mass = 1.0 / inertia.mass_kg,
                          .grounded = path_change_grounded(context, row)};
    body.arm = vec3_sub(body.centre, path_at(&context->path[row], time));
    if (body.grounded)
        body.inverse_inertia.m[1][1] = 1.0 / inertia.moment.y;
    else
        body.inverse_inertia = mass_properties_inverse_world(&inertia, &turn);
    return body;
}

double body_push_mobility(const struct response_context *context, uint32_t row, double time,
                          struct vec3 point, struct vec3 direction)
{
    const struct pushed body = pushed_of(context, row, time);
    struct vec3 moment = vec3_cross(vec3_sub(point, body.centre), direction);
    return body.inverse_mass + vec3_dot(moment, rotation_apply(&body.inverse_inertia, moment));
}

/* The climb of a body that follows its slope with another velocity. What rises or falls faster than
 * a slope makes it does so on its springs, and goes on so. */
static double climb(struct vec3 before, struct vec3 after)
{
    double level = before.x * before.x + before.z * before.z;
    return before.y * before.y < level
               ? before.y * (before.x * after.x + before.z * after.z) / level
               : before.y;
}

void body_push(struct response_context *context, uint32_t row, double time, struct vec3 point,
               struct vec3 impulse_ns)
{
    const struct pushed body = pushed_of(context, row, time);
    struct vec3 before = path_change_velocity(context, row, time);
    struct vec3 moment = vec3_cross(vec3_sub(point, body.centre), impulse_ns);
    struct vec3 turned = rotation_apply(&body.inverse_inertia, moment);
    struct vec3 velocity = vec3_add(before, vec3_scale(impulse_ns, body.inverse_mass));
    velocity = vec3_sub(velocity, vec3_cross(turned, body.arm));
    if (body.grounded)
        velocity.y = climb(before, velocity);
    path_change_leave(context, row, time, path_at(&context->path[row], time), velocity,
                      vec3_add(path_change_spin(context, row, time), turned), false);
}
