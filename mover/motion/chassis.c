/* Sub-steps of a body on its springs, rest, and when it is calm. */
#include "mover/motion/chassis.h"

#include "mover/motion/fording.h"
#include "mover/motion/ground_contacts.h"
#include "mover/motion/ground_vehicle.h"
#include "mover/motion/kinematics.h"
#include "mover/motion/tyre.h"
#include "mover/query/ground_marks.h"
#include "world/state.h"
#include "world/world.h"

/* Sub-steps are at most so long [s]: where all wheels bear, and where one is on its bump stop or
 * off the ground. */
#define STEP_S       (1.0 / 60.0)
#define ROUGH_STEP_S (1.0 / 240.0)
#define RISE_SHARE                                                                                 \
    0.5 /* of the travel, by which the ground ahead is higher than the body's plane */
#define FAST_SHARE 0.3 /* of the travel of a wheel, in a sub-step */

/* A body that is slower than this, and that no force makes faster, is held in its place. */
#define REST_MPS  0.03
#define REST_RPS  0.02
#define REST_MPS2 0.15

#define FORD_MPS 2.0 /* a vehicle in water is no faster */

/* A vehicle that is no higher over the ground was set down on it. */
#define PLACED_M 0.01

/* A chassis is calm below these. */
#define CALM_LOAD     0.1  /* least load of a wheel over its load at rest */
#define CALM_MPS      0.15 /* speed off the ground */
#define CALM_RPS      0.15 /* roll and pitch */
#define CALM_SLIP_MPS 0.4  /* to the side */
#define CALM_LATERAL  0.8  /* share of the greatest lateral acceleration */

/* The shell of the body. Its underside is as high as the wheels can rise. */
#define SHELL_POINTS 12u
#define UNDERSIDE    0.35 /* half length of the underside over the length */
#define NOSE_HEIGHT  0.45 /* of the ends over the height */
#define UPRIGHT      0.95 /* cosine: a body that leans less stands on its wheels alone */
#define NEAR_STOPS   0.7  /* share of the travel from which the shell may touch */

/* --- the modes ---------------------------------------------------------------------------------*/

void chassis_disturb(const struct step_context *context, uint32_t i)
{
    context->m->flags[i] |= ENTITY_FLAG_CHASSIS;
    context->m->jolt_tick[i] = (uint32_t)context->tick;
}

/* Returns the slope of the ground between two points of the row, at this distance in front and to
 * the right of its middle and as far on the other side [rad]. */
static double slope_between(const struct step_context *context, uint32_t i, double front_m,
                            double right_m)
{
    const struct entities *m = context->m;
    double sine, cosine;
    maths_sincos(m->heading[i], &sine, &cosine);
    double dx = front_m * sine + right_m * cosine, dz = right_m * sine - front_m * cosine;
    return maths_atan2(kinematics_ground(context, m->x[i] + dx, m->z[i] + dz) -
                           kinematics_ground(context, m->x[i] - dx, m->z[i] - dz),
                       2.0 * (front_m + right_m));
}

/* A vehicle that is new stands level, whatever the ground. */
static void take_slope(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    if (fabs(m->y[i] - kinematics_ground(context, m->x[i], m->z[i])) > PLACED_M)
        return;
    m->pitch[i] = slope_between(context, i, 0.5 * kind->length_m, 0.0);
    m->roll[i] = -slope_between(context, i, 0.0, 0.5 * kind->width_m);
}

bool chassis_takes(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    bool spins = m->spin_x[i] != 0.0 || m->spin_y[i] != 0.0 || m->spin_z[i] != 0.0;
    if (!(m->flags[i] & ENTITY_FLAG_CHASSIS)) {
        if (m->behaviour[i] != BEHAVIOUR_DRIVEN && !spins)
            return false;
        chassis_disturb(context, i);
        take_slope(context, i);
    }
    double calm = (double)((uint32_t)context->tick - m->jolt_tick[i]) * context->dt_s;
    return m->behaviour[i] == BEHAVIOUR_DRIVEN || calm < CHASSIS_CALM_S;
}

/* --- a frame -----------------------------------------------------------------------------------*/

/* A vehicle in a frame. */
struct chassis {
    const struct step_context *context;
    const struct kind *kind;
    struct rigid_body body;
    struct suspension suspension;
    struct drivetrain drivetrain;
    struct ground_grip grip;
    struct vec3 shell_point[SHELL_POINTS];
    struct body_points shell;
    bool cratered;
    bool rough; /* a wheel is on its bump stop or bears next to nothing */
    bool level; /* every wheel bears in every sub-step */
};

static void find_shell(struct chassis *chassis)
{
    const struct kind *kind = chassis->kind;
    for (unsigned n = 0; n < SHELL_POINTS; n++) {
        unsigned layer = n / 4;
        double length = kind->length_m * (layer == 0 ? UNDERSIDE : 0.5);
        double height = layer == 0   ? kind->travel_m
                        : layer == 1 ? maths_max(NOSE_HEIGHT * kind->height_m, kind->travel_m)
                                     : kind->height_m;
        chassis->shell_point[n] = (struct vec3){n & 1 ? length : -length, height,
                                                n & 2 ? 0.5 * kind->width_m : -0.5 * kind->width_m};
    }
    double wide = 0.25 * (kind->length_m * kind->length_m + kind->width_m * kind->width_m);
    chassis->shell = (struct body_points){.point = chassis->shell_point,
                                          .count = SHELL_POINTS,
                                          .reach_m = sqrt(wide + kind->height_m * kind->height_m)};
}

static double forward_speed(const struct chassis *chassis, const struct mat3 *turn)
{
    const struct vec3 ahead = {turn->m[0][0], turn->m[1][0], turn->m[2][0]};
    return vec3_dot(chassis->body.velocity, ahead);
}

/* Returns the sine of the slope of the ground along the heading. normal: of any length. */
static double rise_of(const struct mat3 *turn, struct vec3 normal)
{
    const struct vec3 right = {turn->m[0][2], turn->m[1][2], turn->m[2][2]};
    struct vec3 ahead = vec3_cross(normal, right);
    return ahead.y / maths_max(vec3_length(ahead), 1e-9);
}

/* Pushes the body up by its springs. Returns the normals of the ground, each by its load. */
static struct vec3 push_up(struct chassis *chassis, const struct mat3 *inverse, double dt_s)
{
    struct rigid_body *body = &chassis->body;
    const struct suspension *suspension = &chassis->suspension;
    struct vec3 push = {0.0, 0.0, 0.0}, twist = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < suspension->count; i++) {
        const struct wheel *wheel = &suspension->wheel[i];
        struct vec3 force = vec3_scale(wheel->normal, wheel->load_n);
        push = vec3_add(push, force);
        twist = vec3_add(twist, vec3_cross(wheel->arm, force));
    }
    body->velocity = vec3_add(body->velocity, vec3_scale(push, dt_s / body->inertia.mass_kg));
    body->spin = vec3_add(body->spin, rotation_apply(inverse, vec3_scale(twist, dt_s)));
    return push;
}

/* Acts on the body by springs, weight and tyres. load_n: of all wheels. */
static void wheels(struct chassis *chassis, const struct mat3 *turn, double load_n, double dt_s)
{
    struct rigid_body *body = &chassis->body;
    const struct mat3 inverse = mass_properties_inverse_world(&body->inertia, turn);
    double forward = forward_speed(chassis, turn);
    const struct vec3 push = push_up(chassis, &inverse, dt_s);
    body->velocity.y -= GRAVITY_MPS2 * dt_s;
    const struct tyre_demand demand = {
        .drivetrain = &chassis->drivetrain,
        .force = drivetrain_force(&chassis->drivetrain, forward, rise_of(turn, push),
                                  &chassis->grip, load_n),
        .friction = chassis->grip.friction,
        .side = tyre_side_share(chassis->kind, forward, body->spin.y),
        .load_n = load_n,
        .dt_s = dt_s};
    if (load_n > 0.0)
        tyre_solve(&chassis->suspension, body, turn, &inverse, &demand);
}

/* Returns true if the shell may touch the ground. */
static bool shell_is_near(const struct chassis *chassis, const struct mat3 *turn)
{
    const struct suspension *suspension = &chassis->suspension;
    double most = suspension->sag_m + NEAR_STOPS * chassis->kind->travel_m;
    if (turn->m[1][1] < UPRIGHT || chassis->cratered || chassis->rough)
        return true;
    for (uint32_t i = 0; i < suspension->count; i++) {
        if (suspension->wheel[i].squeeze_m > most)
            return true;
    }
    return false;
}

/* Lets the shell of the body act on the ground, and moves the body. load_n: of the wheels. */
static void move(struct chassis *chassis, const struct mat3 *turn, double load_n, double dt_s)
{
    struct rigid_body *body = &chassis->body;
    struct vec3 push = {0.0, 0.0, 0.0}, twist = {0.0, 0.0, 0.0};
    double shell = 0.0;
    if (shell_is_near(chassis, turn)) {
        struct ground_contacts contacts;
        ground_contacts_begin(&contacts, chassis->kind);
        ground_contacts_find(&contacts, chassis->context, &chassis->shell, body, dt_s);
        shell = ground_contacts_solve(&contacts, body, dt_s);
        if (shell > 0.0)
            ground_contacts_push(&contacts, body, dt_s, &push, &twist);
    }
    if (load_n == 0.0 && shell == 0.0)
        push.y = 0.5 * GRAVITY_MPS2 * dt_s; /* a free fall is exact */
    body->centre = vec3_add(body->centre, vec3_scale(vec3_add(body->velocity, push), dt_s));
    rigid_body_turn(body, twist, dt_s);
}

/* Returns true if the ground rises before the body within a sub-step. */
static bool ground_rises(const struct chassis *chassis, const struct mat3 *turn)
{
    const struct rigid_body *body = &chassis->body;
    double way = forward_speed(chassis, turn) * STEP_S;
    double ahead = way + (way < 0.0 ? -0.5 : 0.5) * chassis->kind->length_m;
    const struct vec3 point = {ahead, -body->inertia.centre_m, 0.0};
    struct vec3 at = vec3_add(body->centre, rotation_apply(turn, point));
    return kinematics_ground(chassis->context, at.x, at.z) - at.y >
           RISE_SHARE * chassis->kind->travel_m;
}

/* Returns true if a wheel is on its bump stop or bears next to nothing, if the body comes down
 * fast, or if the ground rises before it. */
static bool is_rough(struct chassis *chassis, const struct mat3 *turn)
{
    const struct suspension *suspension = &chassis->suspension;
    double least = CALM_LOAD * suspension->spring_npm * suspension->sag_m;
    const struct vec3 up = {turn->m[0][1], turn->m[1][1], turn->m[2][1]};
    bool rough =
        -vec3_dot(chassis->body.velocity, up) * STEP_S > FAST_SHARE * chassis->kind->travel_m ||
        ground_rises(chassis, turn);
    for (uint32_t i = 0; i < suspension->count; i++) {
        chassis->level &= suspension->wheel[i].load_n > least;
        rough |= suspension->wheel[i].squeeze_m > suspension->most_m ||
                 suspension->wheel[i].load_n <= least;
    }
    return rough;
}

static double find_load(struct chassis *chassis, struct mat3 *turn)
{
    *turn = rotation_matrix(chassis->body.turn);
    return suspension_load(&chassis->suspension, chassis->context, &chassis->body, turn,
                           chassis->cratered);
}

static void run(struct chassis *chassis)
{
    double steps = ceil(chassis->context->dt_s / STEP_S - 1e-9);
    double dt_s = chassis->context->dt_s / steps;
    int more = (int)ceil(dt_s / ROUGH_STEP_S - 1e-9);
    struct mat3 turn;
    for (int n = 0; n < (int)steps; n++) {
        double load = find_load(chassis, &turn);
        chassis->rough = is_rough(chassis, &turn);
        int parts = chassis->rough ? more : 1;
        for (int p = 0; p < parts; p++) {
            if (p > 0)
                load = find_load(chassis, &turn);
            wheels(chassis, &turn, load, dt_s / parts);
            move(chassis, &turn, load, dt_s / parts);
        }
    }
}

/* --- rest and calm -----------------------------------------------------------------------------*/

/* Returns true if the body stands still but for what springs and friction leave over. */
static bool rests(const struct chassis *chassis, const struct rigid_body *before,
                  const struct rigid_body *after)
{
    double dt_s = chassis->context->dt_s;
    struct vec3 faster = vec3_sub(after->velocity, before->velocity);
    bool wants = chassis->drivetrain.wanted_mps != 0.0 || chassis->drivetrain.neutral ||
                 (chassis->kind->tracked && chassis->drivetrain.yaw_rps != 0.0);
    return !wants && vec3_length(after->velocity) <= REST_MPS &&
           vec3_length(after->spin) <= REST_RPS && vec3_length(faster) <= REST_MPS2 * dt_s;
}

/* Holds the row in its place. Position and angles keep every bit, because a heap sleeps only if
 * nothing in it moves (collider/resting/contact_groups.h). */
static void hold(const struct step_context *context, uint32_t i, struct rigid_body *body)
{
    struct entities *m = context->m;
    body->velocity = body->spin = (struct vec3){0.0, 0.0, 0.0};
    m->vx[i] = m->vy[i] = m->vz[i] = 0.0;
    m->spin_x[i] = m->spin_y[i] = m->spin_z[i] = 0.0;
}

/* Returns true if the ground, the load and the motion are those of a vehicle that follows the
 * ground. */
static bool is_calm(const struct chassis *chassis)
{
    const struct rigid_body *body = &chassis->body;
    const struct mat3 turn = rotation_matrix(body->turn);
    const struct vec3 ahead = {turn.m[0][0], turn.m[1][0], turn.m[2][0]};
    const struct vec3 up = {turn.m[0][1], turn.m[1][1], turn.m[2][1]};
    const struct vec3 right = {turn.m[0][2], turn.m[1][2], turn.m[2][2]};
    const struct vec3 spin = body->spin, velocity = body->velocity;
    double lateral = fabs(vec3_dot(velocity, ahead) * spin.y);
    if (fording_is_water(chassis->context, body->centre.x, body->centre.z))
        return false; /* what follows the ground cannot cross water */
    return chassis->level && up.y > maths_cos(CHASSIS_TILT_RAD) &&
           fabs(vec3_dot(velocity, up)) < CALM_MPS &&
           fabs(vec3_dot(velocity, right)) < CALM_SLIP_MPS &&
           fabs(vec3_dot(spin, ahead)) < CALM_RPS && fabs(vec3_dot(spin, right)) < CALM_RPS &&
           lateral < CALM_LATERAL * drivetrain_lateral(chassis->kind, chassis->grip.friction);
}

/* --- the row -----------------------------------------------------------------------------------*/

/* Stops a row at deep water. Returns true if it was stopped. */
static bool stop_at_depth(const struct step_context *context, uint32_t i, double x, double z)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    double sine, cosine;
    maths_sincos(m->heading[i], &sine, &cosine);
    double lead = m->vx[i] * sine - m->vz[i] * cosine < 0.0 ? -0.5 : 0.5;
    lead *= kind->length_m;
    if ((m->x[i] == x && m->z[i] == z) ||
        (fording_passable(context, kind, m->x[i], m->z[i]) &&
         fording_passable(context, kind, m->x[i] + sine * lead, m->z[i] - cosine * lead)))
        return false;
    m->x[i] = x;
    m->z[i] = z;
    m->vx[i] = m->vz[i] = 0.0;
    return true;
}

/* Returns the desired motion without what fuel, debris and slopes do not allow. */
static struct desired_motion allowed(const struct step_context *context, uint32_t i,
                                     const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    struct desired_motion motion = *desired;
    double full = maths_max(kind->max_speed_mps, 1e-9);
    double most = full * ground_vehicle_debris(context, i);
    if (fording_is_water(context, m->x[i], m->z[i]))
        most = maths_min(most, FORD_MPS);
    double pitch = slope_between(context, i, 0.5 * kind->length_m, 0.0);
    double climb = desired->speed_mps < 0.0 ? -pitch : pitch;
    double steepest = kind->max_slope_rad * (desired->gear == GEAR_LOW ? CHASSIS_LOW_CLIMB : 1.0);
    double share = maths_max(DRIVETRAIN_IDLE, fabs(desired->speed_mps) / full);
    if (!kinematics_burn(context, i, share) || climb >= steepest)
        motion.speed_mps = 0.0;
    motion.speed_mps = maths_clamp(motion.speed_mps, -most, most);
    if (fabs(motion.speed_mps) < fabs(desired->speed_mps))
        motion.brake = 1.0; /* the ground slows it as well */
    return motion;
}

static void begin(struct chassis *chassis, const struct step_context *context, uint32_t i,
                  const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    chassis->context = context;
    chassis->kind = &context->world->kinds[m->kind[i]];
    chassis->body = rigid_body_take(context, i);
    chassis->grip = ground_grip_at(context, m->x[i], m->z[i]);
    chassis->cratered =
        ground_marks_at(context->ground_marks, m->x[i], m->z[i]) & GROUND_MARKS_CRATER;
    chassis->level = true;
    suspension_of(chassis->kind, &chassis->suspension);
    find_shell(chassis);
    const struct mat3 turn = rotation_matrix(chassis->body.turn);
    const struct desired_motion motion = allowed(context, i, desired);
    chassis->drivetrain =
        drivetrain_of(context, i, &motion, forward_speed(chassis, &turn), chassis->grip.friction);
}

bool chassis_move(const struct step_context *context, uint32_t i,
                  const struct desired_motion *desired)
{
    struct entities *m = context->m;
    struct chassis chassis;
    double x = m->x[i], z = m->z[i];
    begin(&chassis, context, i, desired);
    const struct rigid_body before = chassis.body;
    run(&chassis);
    if (rests(&chassis, &before, &chassis.body))
        hold(context, i, &chassis.body);
    else
        rigid_body_put(context, i, &chassis.body);
    bool blocked = stop_at_depth(context, i, x, z);
    if (m->behaviour[i] == BEHAVIOUR_DRIVEN || !is_calm(&chassis))
        m->jolt_tick[i] = (uint32_t)context->tick;
    return blocked || (desired->speed_mps != 0.0 && chassis.drivetrain.wanted_mps == 0.0);
}
