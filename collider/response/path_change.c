/* How the response to a contact changes a body's path in the rest of the frame. */
#include "collider/response/path_change.h"

#include "collider/motion/free_fall.h"
#include "world/body_points.h"
#include "world/entity/free_rotation.h"
#include "world/entity/mass_properties.h"
#include "world/state.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

/* A wreck lies on the ground or slides over it if its lowest point is this near to the ground, it
 * neither leaves nor meets the ground faster, and it does not roll over faster. Any other wreck is
 * pushed as a free body, and the mover's contacts with the ground do the rest. */
#define LIES_M   0.05
#define LIES_MPS 2.0
#define LIES_RPS 1.0

/* A vehicle on its springs stands if it leans less than 45 degrees and its position is no higher
 * over the ground. */
#define STANDS_COSINE 0.70710678118654752
#define STANDS_M      0.4

/* Bodies that are slower than this have no faster velocity along any normal, and those whose pitch
 * and roll add up to less lean less than 45 degrees. Both save what the exact answer costs. */
#define SURELY_SLOW_MPS   (0.999 * LIES_MPS)
#define SURELY_STANDS_RAD 0.75

/* Returns true if the row's velocity along the ground's normal is not above LIES_MPS. */
static bool keeps_to_ground(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    struct vec3 velocity = entities_velocity(e, row);
    if (vec3_dot(velocity, velocity) < SURELY_SLOW_MPS * SURELY_SLOW_MPS)
        return true;
    struct vec3 normal = terrain_normal(&context->world->terrain, context->input.detect.craters,
                                        e->row[row].x, e->row[row].z);
    return fabs(vec3_dot(velocity, normal)) <= LIES_MPS;
}

static bool lies(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    const struct crater_index *craters = context->input.detect.craters;
    const struct vec3 at = entities_position(e, row);
    struct body_points points;
    if (!keeps_to_ground(context, row) ||
        vec3_length((struct vec3){e->row[row].spin_x, 0.0, e->row[row].spin_z}) > LIES_RPS)
        return false;
    body_points_of(context->world, e->row[row].kind, &points);
    return body_points_clearance(
               context->world, craters, &points, at,
               rotation_of(e->row[row].heading, e->row[row].pitch, e->row[row].roll)) <= LIES_M;
}

static bool is_upright(double pitch_rad, double roll_rad)
{
    return fabs(pitch_rad) + fabs(roll_rad) < SURELY_STANDS_RAD ||
           maths_cos(pitch_rad) * maths_cos(roll_rad) > STANDS_COSINE;
}

/* Returns true if a vehicle on its springs (mover/motion/chassis.h) stands on its wheels. */
static bool stands(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    const struct crater_index *craters = context->input.detect.craters;
    const struct vec3 at = entities_position(e, row);
    return is_upright(e->row[row].pitch, e->row[row].roll) && keeps_to_ground(context, row) &&
           at.y - terrain_height(&context->world->terrain, craters, at.x, at.z) < STANDS_M;
}

/* Returns true for an aircraft that lies on the ground as a body (mover/motion/ground/landing.h).
 */
static bool has_landed(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return context->world->kinds[e->row[row].kind].domain == DOMAIN_AIR &&
           (e->row[row].flags & ENTITY_FLAG_LANDED) != 0;
}

bool path_change_grounded(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    enum domain domain = (enum domain)context->world->kinds[e->row[row].kind].domain;
    if (domain == DOMAIN_SEA)
        return true;
    if (e->row[row].state == ENTITY_WRECK || has_landed(context, row))
        return lies(context, row);
    return domain == DOMAIN_LAND &&
           (!(e->row[row].flags & ENTITY_FLAG_CHASSIS) || stands(context, row));
}

bool path_change_on_course(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return e->row[row].state == ENTITY_ACTIVE && e->row[row].behaviour == BEHAVIOUR_HOLD &&
           context->world->kinds[e->row[row].kind].domain != DOMAIN_AIR &&
           path_change_grounded(context, row);
}

struct vec3 path_change_arm(const struct response_context *context, uint32_t row,
                            const struct mat3 *axes)
{
    const struct kind *kind = &context->world->kinds[context->next->entities.row[row].kind];
    const struct vec3 up = {0.0, mass_properties_of(kind).centre_m, 0.0};
    return path_change_on_course(context, row) ? up : rotation_apply(axes, up);
}

/* A land vehicle that is pushed moves on as a body on its springs. */
static void disturb(struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    if (context->world->kinds[e->row[row].kind].domain != DOMAIN_LAND ||
        e->row[row].state != ENTITY_ACTIVE || e->row[row].behaviour == BEHAVIOUR_HOLD)
        return;
    table_set_flags(&context->writer, row, e->row[row].flags | ENTITY_FLAG_CHASSIS);
    table_set_jolt_tick(&context->writer, row, (uint32_t)context->next->head->tick);
}

static struct vec3 own_spin(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return (struct vec3){e->row[row].spin_x, e->row[row].spin_y, e->row[row].spin_z};
}

static struct vec3 moment_of(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    return mass_properties_of(&context->world->kinds[e->row[row].kind]).moment;
}

/* Returns the rotation about the vertical of a row on the ground [rad/s]. The mover turned it by
 * its spin, and then by less than half a turn. */
static double yaw_of(const struct response_context *context, uint32_t row)
{
    const struct body_motion *motion = context->motion;
    const struct entities *w = &motion->before, *n = &motion->next->entities;
    double dt_s = world_dt_s(context->world);
    if (n->row[row].state == ENTITY_WRECK || has_landed(context, row))
        return n->row[row].spin_y; /* nobody steers it */
    if (motion->change[row] != 0)
        return n->row[row].spin_y + body_motion_rotation(motion, row).driven_rps;
    if (!body_motion_old(motion, row))
        return n->row[row].spin_y;
    double by_spin = -w->row[row].spin_y * dt_s;
    if (fabs(by_spin) <= HALF_PI)
        by_spin = 0.0;
    double turn = by_spin + maths_wrap_half(n->row[row].heading - w->row[row].heading - by_spin);
    return -turn / dt_s - motion->parting_rps[row];
}

static double fall_left_mps(const struct response_context *context, uint32_t row, double time)
{
    double fall = free_fall_left_mps(context->motion, row, time);
    return fall > 0.0 && path_change_grounded(context, row) ? 0.0 : fall;
}

/* A push on a body on the ground leaves it no spin but that about the vertical. Returns the
 * velocity that the position of a wreck on the ground gets by losing the rest of its spin [m/s]:
 * that of its centre of mass stays, so that no energy is gained. */
static struct vec3 rolling_velocity(const struct response_context *context, uint32_t row,
                                    double time)
{
    const struct entities *e = &context->next->entities;
    const struct kind *kind = &context->world->kinds[e->row[row].kind];
    struct vec3 up = {0.0, mass_properties_of(kind).centre_m, 0.0};
    struct vec3 spin = {e->row[row].spin_x, 0.0, e->row[row].spin_z};
    if (vec3_dot(spin, spin) == 0.0 || !path_change_grounded(context, row))
        return (struct vec3){0.0, 0.0, 0.0};
    struct mat3 axes = rotation_matrix(body_motion_orientation(context->motion, row, time));
    return vec3_cross(spin, rotation_apply(&axes, up));
}

struct vec3 path_change_velocity(const struct response_context *context, uint32_t row, double time)
{
    struct vec3 velocity = entities_velocity(&context->next->entities, row);
    velocity.y += fall_left_mps(context, row, time);
    return vec3_add(velocity, rolling_velocity(context, row, time));
}

struct vec3 path_change_spin(const struct response_context *context, uint32_t row, double time)
{
    if (path_change_grounded(context, row))
        return (struct vec3){0.0, yaw_of(context, row), 0.0};
    struct vec3 end = own_spin(context, row);
    if (vec3_dot(end, end) == 0.0)
        return end;
    struct vec3 moment = moment_of(context, row);
    struct quat to = body_motion_rotation(context->motion, row).to;
    return free_rotation_spin(moment, body_motion_orientation(context->motion, row, time),
                              free_rotation_momentum(moment, to, end));
}

/* Returns the rotation by the driver, in addition to the row's spin [rad/s]. */
static double driven(const struct response_context *context, uint32_t row, bool grounded)
{
    return grounded ? yaw_of(context, row) - context->next->entities.row[row].spin_y : 0.0;
}

/* Ends the path at the world's edge. It may begin beyond it, if the body was pushed out of
 * another. */
static struct path within_world(const struct world *world, struct path path)
{
    double left = 1.0 - path.since;
    if (!(left > 0.0)) {
        path.at.x = world_clamp(world, path.at.x);
        path.at.z = world_clamp(world, path.at.z);
    }
    if (left > 0.0) {
        path.along.x = (world_clamp(world, path.at.x + path.along.x * left) - path.at.x) / left;
        path.along.z = (world_clamp(world, path.at.z + path.along.z * left) - path.at.z) / left;
    }
    return path;
}

/* Wakes a wreck that is displaced (mover/motion/ground/wreck.h). Velocity and spin wake it by
 * themselves.
 */
static void wake(struct response_context *context, uint32_t row, struct vec3 to)
{
    const struct entities *e = &context->next->entities;
    struct vec3 off = vec3_sub(to, entities_position(e, row));
    if (e->row[row].state == ENTITY_WRECK && vec3_dot(off, off) > 0.0)
        table_set_until_tick(&context->writer, row, 0);
}

/* Gives the row this path, and writes the pose and velocity at the frame's end that follow from
 * it. */
static void take_path(struct response_context *context, uint32_t row, const struct path *path,
                      const struct rotation_path *rotation, struct vec3 velocity)
{
    double heading, pitch, roll;
    struct path within = within_world(context->world, *path);
    struct vec3 to = path_at(&within, 1.0);
    wake(context, row, to);
    body_motion_change(context->motion, row, &within, rotation);
    rotation_angles(rotation->to, &heading, &pitch, &roll);
    table_set_position(&context->writer, row, to);
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
    struct vec3 spin = own_spin(context, row);
    if (!path_change_grounded(context, row) && vec3_dot(spin, spin) > 0.0)
        table_set_spin(&context->writer, row, path_change_spin(context, row, time));
    take_path(context, row, &path, &rotation, velocity);
    path_change_swept(context, &row, 1, time);
}

void path_change_slow(struct response_context *context, uint32_t row, double time, double share)
{
    const struct entities *e = &context->next->entities;
    const struct path *before = &context->path[row];
    struct rotation_path rotation = body_motion_rotation_from(context->motion, row, time);
    const struct path path = {
        .at = path_at(before, time), .along = vec3_scale(before->along, share), .since = time};
    rotation.driven_rps = driven(context, row, path_change_grounded(context, row));
    take_path(context, row, &path, &rotation, vec3_scale(entities_velocity(e, row), share));
}

/* Rotates a row by its spin until the frame's end, and replaces the spin by that at the end. */
static void spin_on(const struct response_context *context, uint32_t row, bool grounded,
                    double left_s, struct rotation_path *rotation, struct vec3 *spin_rps)
{
    if (grounded && vec3_length(*spin_rps) * left_s <= HALF_PI) {
        rotation->to = rotation_spun(rotation->from, *spin_rps, left_s);
        return;
    }
    struct vec3 moment = grounded ? (struct vec3){1.0, 1.0, 1.0} : moment_of(context, row);
    struct free_rotation freely = free_rotation_of(moment, rotation->from, *spin_rps, left_s);
    rotation->turn.rotation = freely;
    rotation->to = free_rotation_at(&freely, 1.0);
    *spin_rps = free_rotation_spin(moment, rotation->to, freely.momentum);
}

void path_change_leave(struct response_context *context, uint32_t row, double time, struct vec3 at,
                       struct vec3 velocity, struct vec3 spin_rps, bool stays)
{
    double dt_s = world_dt_s(context->world);
    bool grounded = path_change_grounded(context, row);
    double fall = stays ? 0.0 : fall_left_mps(context, row, time);
    struct quat turned = body_motion_orientation(context->motion, row, time);
    struct vec3 mean = {velocity.x, velocity.y - 0.5 * fall, velocity.z};
    struct rotation_path rotation = {
        .from = turned, .to = turned, .driven_rps = driven(context, row, grounded)};
    const struct path path = {.at = at,
                              .along = vec3_scale(mean, stays ? 0.0 : dt_s),
                              .since = time,
                              .rotates = context->motion->models && !stays &&
                                         vec3_dot(spin_rps, spin_rps) > 0.0};
    if (!stays)
        spin_on(context, row, grounded, (1.0 - time) * dt_s, &rotation, &spin_rps);
    spin_rps.y -= rotation.driven_rps;
    velocity.y -= fall;
    if (stays && velocity.y < 0.0)
        velocity.y =
            maths_min(0.0, velocity.y + free_fall_unearned_mps(context->motion, row, time));
    table_set_spin(&context->writer, row, spin_rps);
    take_path(context, row, &path, &rotation, velocity);
    disturb(context, row);
}
