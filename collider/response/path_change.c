/* How the response to a contact changes a body's path in the rest of the frame. */
#include "collider/response/path_change.h"

#include "world/entity/mass_properties.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

/* A wreck this near to the ground lies on it [m]. */
#define LIES_M 0.05

bool path_change_grounded(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    const struct world *world = context->world;
    enum domain domain = (enum domain)world->kinds[e->kind[row]].domain;
    if (domain == DOMAIN_LAND || domain == DOMAIN_SEA)
        return true;
    return e->state[row] == ENTITY_WRECK &&
           e->y[row] <= LIES_M + terrain_height(&world->terrain, context->input.detect.craters,
                                                e->x[row], e->z[row]);
}

struct vec3 path_change_spin(const struct response_context *context, uint32_t row)
{
    const struct body_motion *motion = context->motion;
    const struct entities *w = &motion->committed->entities, *n = &motion->next->entities;
    if (!path_change_grounded(context, row))
        return (struct vec3){n->spin_x[row], n->spin_y[row], n->spin_z[row]};
    double yaw = n->spin_y[row];
    if (motion->change[row] != 0)
        yaw += body_motion_rotation(motion, row).driven_rps;
    else if (body_motion_old(motion, row))
        yaw = -maths_wrap_half(n->heading[row] - w->heading[row]) / world_dt_s(context->world);
    return (struct vec3){0.0, yaw, 0.0};
}

/* Returns the rotation by the driver, in addition to the row's spin [rad/s]. */
static double driven(const struct response_context *context, uint32_t row)
{
    return path_change_spin(context, row).y - context->next->entities.spin_y[row];
}

/* Ends the path at the world's edge. It may begin beyond it, if the body was pushed out of
 * another. */
static struct path within_world(struct path path)
{
    double left = 1.0 - path.since;
    if (!(left > 0.0)) {
        path.at.x = maths_clamp(path.at.x, 0.0, WORLD_SIDE_M);
        path.at.z = maths_clamp(path.at.z, 0.0, WORLD_SIDE_M);
    }
    if (left > 0.0) {
        path.along.x =
            (maths_clamp(path.at.x + path.along.x * left, 0.0, WORLD_SIDE_M) - path.at.x) / left;
        path.along.z =
            (maths_clamp(path.at.z + path.along.z * left, 0.0, WORLD_SIDE_M) - path.at.z) / left;
    }
    return path;
}

/* Gives the row this path, and writes the pose and velocity at the frame's end that follow from
 * it. */
static void take_path(struct response_context *context, uint32_t row, const struct path *path,
                      const struct rotation_path *rotation, struct vec3 velocity)
{
    double heading, pitch, roll;
    struct path within = within_world(*path);
    body_motion_change(context->motion, row, &within, rotation);
    rotation_angles(rotation->to, &heading, &pitch, &roll);
    table_set_position(&context->writer, row, path_at(&within, 1.0));
    table_set_velocity(&context->writer, row, velocity);
    table_set_heading(&context->writer, row, heading);
    table_set_pitch(&context->writer, row, pitch);
    table_set_roll(&context->writer, row, roll);
}

void path_change_swept(struct response_context *context, const uint32_t *rows, uint32_t count,
                       double time)
{
    contact_queue_change(context->contacts, &context->input, rows, count, time);
}

void path_change_stay(struct response_context *context, uint32_t row, double time,
                      struct vec3 velocity)
{
    struct quat turned = body_motion_orientation(context->motion, row, time);
    const struct rotation_path rotation = {.from = turned, .to = turned};
    const struct path path = {.at = path_at(&context->path[row], time), .since = time};
    take_path(context, row, &path, &rotation, velocity);
    path_change_swept(context, &row, 1, time);
}

void path_change_slow(struct response_context *context, uint32_t row, double time, double share)
{
    const struct entities *e = &context->next->entities;
    const struct path *before = &context->path[row];
    const struct rotation_path rotation = {.from =
                                               body_motion_orientation(context->motion, row, time),
                                           .to = body_motion_rotation(context->motion, row).to,
                                           .driven_rps = driven(context, row)};
    const struct path path = {
        .at = path_at(before, time), .along = vec3_scale(before->along, share), .since = time};
    take_path(context, row, &path, &rotation, vec3_scale(entities_velocity(e, row), share));
}

void path_change_leave(struct response_context *context, uint32_t row, double time, struct vec3 at,
                       struct vec3 velocity, struct vec3 spin_rps, bool stays)
{
    double dt_s = world_dt_s(context->world);
    struct quat turned = body_motion_orientation(context->motion, row, time);
    const struct rotation_path rotation = {
        .from = turned,
        .to = stays ? turned : rotation_spun(turned, spin_rps, (1.0 - time) * dt_s),
        .driven_rps = driven(context, row)};
    const struct path path = {
        .at = at, .along = vec3_scale(velocity, stays ? 0.0 : dt_s), .since = time};
    if (!path_change_grounded(context, row)) {
        /* The inertia rotates with the body; angular momentum is conserved. */
        const struct mass_properties inertia =
            mass_properties_of(&context->world->kinds[context->next->entities.kind[row]]);
        struct mat3 before = rotation_matrix(turned), after = rotation_matrix(rotation.to);
        spin_rps = mass_properties_carried(&inertia, &before, spin_rps, &after);
    }
    spin_rps.y -= rotation.driven_rps;
    table_set_spin(&context->writer, row, spin_rps);
    take_path(context, row, &path, &rotation, velocity);
}
