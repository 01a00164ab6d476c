/* Springs, tyres and shell of a body in a sub-step. */
#include "mover/motion/chassis_run.h"

#include "mover/motion/chassis.h"
#include "mover/motion/fording.h"
#include "mover/motion/ground_vehicle.h"
#include "mover/motion/kinematics.h"
#include "mover/query/ground_marks.h"
#include "world/terrain/terrain_cache.h"
#include "world/world.h"

/* A sub-step is cut into parts of at most this length where a wheel is on its bump stop or off the
 * ground [s].
 */
#define ROUGH_STEP_S (1.0 / 240.0)
#define RISE_SHARE                                                                                 \
    0.5 /* of the travel, by which the ground ahead is higher than the body's plane */
#define FAST_SHARE 0.3 /* of the travel of a wheel, in a sub-step */

#define NEAR_M   1.0 /* between a body and works or craters that cannot touch it in a frame */
#define SCRAPE_M 0.1 /* a shell that is no higher may touch the ground */
#define LEAST_LOAD                                                                                 \
    0.1                 /* of a wheel over its load at rest: one that bears less is off the ground \
                         */
#define WATER_MPS2 30.0 /* by which water that is too deep slows a vehicle */
#define CREEP_MPS  0.05 /* a slower vehicle goes where it wants to */
#define UPRIGHT    0.95 /* cosine: a body that leans less stands on its wheels alone */
#define NEAR_STOPS 0.7  /* share of the travel from which the shell may touch */

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

/* --- the ground
 * ---------------------------------------------------------------------------------*/

/* Returns the rolling resistance of all wheels [N], and sets the friction under each. Where the
 * outermost wheels stand on the same ground, the others do. */
static double find_grip(struct chassis *chassis)
{
    const struct rigid_body *body = &chassis->body;
    struct wheel *wheel = chassis->suspension.wheel;
    const uint32_t count = chassis->suspension.count, last = count - 1;
    struct ground_grip grip[SUSPENSION_WHEELS_MAX];
    bool mixed = chassis->cratered || chassis->littered;
    double rolling = 0.0;
    for (uint32_t n = 0; n < count; n++) {
        /* 0, 1, last - 1 and last first */
        uint32_t i = n < 2 ? n : n < 4 ? last - (n - 2) : n - 2;
        if (n >= 4 && !mixed) {
            grip[i] = grip[0];
        } else {
            grip[i] = ground_grip_at(chassis->context, body->centre.x + wheel[i].arm.x,
                                     body->centre.z + wheel[i].arm.z);
            mixed |= grip[i].friction != grip[0].friction || grip[i].wheels != grip[0].wheels;
        }
        wheel[i].friction = grip[i].friction;
        rolling += (chassis->kind->tracked ? grip[i].tracks : grip[i].wheels) * wheel[i].load_n;
    }
    return rolling;
}

/* Returns the slope of the ground along the heading [rad]. */
static double slope_ahead(const struct chassis *chassis, struct vec3 at, const struct mat3 *turn)
{
    double x = turn->m[0][0], z = turn->m[2][0], length = sqrt(x * x + z * z);
    double half = 0.5 * chassis->kind->length_m / maths_max(length, 1e-9);
    x *= half;
    z *= half;
    return maths_atan2(kinematics_ground(chassis->context, at.x + x, at.z + z) -
                           kinematics_ground(chassis->context, at.x - x, at.z - z),
                       chassis->kind->length_m);
}

/* Sets the wanted speed, without what fuel, debris, water and slopes do not allow. */
static void want(struct chassis *chassis, const struct mat3 *turn)
{
    const struct kind *kind = chassis->kind;
    const struct desired_motion *desired = &chassis->desired;
    const struct vec3 centre = {0.0, -chassis->body.inertia.centre_m, 0.0};
    const struct vec3 at = vec3_add(chassis->body.centre, rotation_apply(turn, centre));
    double most = chassis->most_mps, pitch = slope_ahead(chassis, at, turn);
    double climb = desired->speed_mps < 0.0 ? -pitch : pitch;
    double steepest = kind->max_slope_rad * (desired->gear == GEAR_LOW ? CHASSIS_LOW_CLIMB : 1.0);
    if (climb >= steepest)
        most = 0.0;
    else if (fording_is_water(chassis->context, at.x, at.z))
        most = maths_min(most, CHASSIS_FORD_MPS);
    chassis->drivetrain.wanted_mps = maths_clamp(desired->speed_mps, -most, most);
    chassis->drivetrain.slowing = desired->driven ? desired->brake : 1.0;
    if (fabs(chassis->drivetrain.wanted_mps) < fabs(desired->speed_mps))
        chassis->drivetrain.slowing = 1.0; /* the ground slows it as well */
}

/* Returns true if the place is one that the kind can neither drive nor ford through. */
static bool is_deep(const struct chassis *chassis, double x, double z)
{
    return world_holds(chassis->context->world, x, z) &&
           !fording_passable(chassis->context, chassis->kind, x, z);
}

/* Returns true if water that is too deep slows or holds the body: under its middle, or where its
 * nose would be when it stands. One that is fast gets some metres too deep, and may leave the water
 * at a walk where that is not further than four times its length. One that flies over the water is
 * not slowed. load_n: of the wheels; dt_s: the sub-step. */
static bool is_drowning(const struct chassis *chassis, const struct mat3 *turn, double load_n,
                        double dt_s)
{
    const struct step_context *context = chassis->context;
    const struct vec3 centre = {0.0, -chassis->body.inertia.centre_m, 0.0};
    const struct vec3 at = vec3_add(chassis->body.centre, rotation_apply(turn, centre));
    const struct vec3 velocity = chassis->body.velocity;
    double x = turn->m[0][0], z = turn->m[2][0], level = maths_max(sqrt(x * x + z * z), 1e-9);
    double forward = (velocity.x * x + velocity.z * z) / level;
    double way = fabs(forward) > CREEP_MPS ? forward : chassis->desired.speed_mps;
    double lead = (way < 0.0 ? -0.5 : 0.5) * chassis->kind->length_m / level;
    double nose = lead + forward * (dt_s + fabs(forward) / (2.0 * WATER_MPS2)) / level;
    bool deep = is_deep(chassis, at.x, at.z);
    if (!deep && !is_deep(chassis, at.x + nose * x, at.z + nose * z))
        return false;
    if (load_n == 0.0 && at.y > kinematics_ground(context, at.x, at.z) +
                                    terrain_water_depth(&context->world->terrain, at.x, at.z))
        return false;
    return sqrt(velocity.x * velocity.x + velocity.z * velocity.z) >= CHASSIS_FORD_MPS || !deep ||
           !fording_passable(context, chassis->kind, at.x + 8.0 * lead * x, at.z + 8.0 * lead * z);
}

/* --- a part of a sub-step ----------------------------------------------------------------------*/

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
        chassis->fall_j += wheel->stop_w * dt_s;
    }
    body->velocity = vec3_add(body->velocity, vec3_scale(push, dt_s / body->inertia.mass_kg));
    body->spin = vec3_add(body->spin, rotation_apply(inverse, vec3_scale(twist, dt_s)));
    return push;
}

/* Water takes from the speed on the map, and holds what is slow. */
static void slow_in_water(struct rigid_body *body, double dt_s)
{
    struct vec3 *velocity = &body->velocity;
    double speed = sqrt(velocity->x * velocity->x + velocity->z * velocity->z);
    double share = maths_max(0.0, speed - WATER_MPS2 * dt_s) / maths_max(speed, 1e-9);
    velocity->x *= share;
    velocity->z *= share;
}

/* Acts on the body by springs, weight, tyres and deep water. load_n: of all wheels. */
static void wheels(struct chassis *chassis, const struct mat3 *turn, double load_n, double dt_s)
{
    struct rigid_body *body = &chassis->body;
    struct drivetrain *drivetrain = &chassis->drivetrain;
    const struct mat3 inverse = mass_properties_inverse_world(&body->inertia, turn);
    double forward = forward_speed(chassis, turn);
    const struct vec3 push = push_up(chassis, &inverse, dt_s);
    body->velocity.y -= GRAVITY_MPS2 * dt_s;
    struct drivetrain_ground ground = {.rise = rise_of(turn, push)};
    if (load_n > 0.0) {
        ground.rolling_n = find_grip(chassis);
        ground.grip_n = suspension_grip(&chassis->suspension);
        chassis->friction = ground.grip_n / load_n;
    }
    drivetrain_steer(drivetrain, forward, chassis->friction, dt_s);
    const struct tyre_demand demand = {.drivetrain = drivetrain,
                                       .force = drivetrain_force(drivetrain, forward, &ground),
                                       .side =
                                           tyre_side_share(chassis->kind, forward, body->spin.y),
                                       .grip_n = ground.grip_n,
                                       .dt_s = dt_s};
    if (ground.grip_n > 0.0)
        tyre_solve(&chassis->suspension, body, turn, &inverse, &demand);
    if (chassis->drowns)
        slow_in_water(body, dt_s);
}

/* Returns true if the shell may touch the ground. */
static bool shell_is_near(const struct chassis *chassis, const struct mat3 *turn)
{
    const struct suspension *suspension = &chassis->suspension;
    double most = suspension->sag_m + NEAR_STOPS * chassis->kind->travel_m;
    if (turn->m[1][1] < UPRIGHT || chassis->cratered || chassis->bent || chassis->rough)
        return true;
    for (uint32_t i = 0; i < suspension->count; i++) {
        if (suspension->wheel[i].squeeze_m > most)
            return true;
    }
    return false;
}

/* Returns the shell of the body. Most vehicles need none in a frame. */
static struct chassis_shell *shell_of(struct chassis *chassis)
{
    if (chassis->shell.count == 0)
        chassis_shell_of(chassis->kind, &chassis->suspension, &chassis->shell);
    return &chassis->shell;
}

/* Lets the shell of the body act on the ground, and moves the body. load_n: of the wheels. */
static void move(struct chassis *chassis, const struct mat3 *turn, double load_n, double dt_s)
{
    struct rigid_body *body = &chassis->body;
    struct chassis_shell_push shell = {0};
    if (shell_is_near(chassis, turn)) {
        chassis_shell_follow(shell_of(chassis), &chassis->suspension);
        shell = chassis_shell_press(&chassis->shell, &chassis->context->world->terrain,
                                    chassis->cratered ? chassis->context->craters : NULL,
                                    chassis->kind, body, dt_s);
        chassis->fall_j += shell.hard_j - shell.strike_j;
        chassis->strike_j += shell.strike_j;
    }
    struct vec3 push = shell.velocity_mps;
    if (load_n == 0.0 && !shell.acts)
        push.y = 0.5 * GRAVITY_MPS2 * dt_s; /* a free fall is exact */
    body->centre = vec3_add(body->centre, vec3_scale(vec3_add(body->velocity, push), dt_s));
    if (chassis->rough || load_n == 0.0 || shell.acts)
        rigid_body_turn(body, shell.spin_rps, dt_s);
    else /* springs and tyres hold it, beside which its own momentum is nothing */
        body->turn = rotation_spun(body->turn, body->spin, dt_s);
}

/* Returns true if the ground rises before the body within a sub-step. */
static bool ground_rises(const struct chassis *chassis, const struct mat3 *turn)
{
    const struct rigid_body *body = &chassis->body;
    double way = forward_speed(chassis, turn) * CHASSIS_SUBSTEP_S;
    double ahead = way + (way < 0.0 ? -0.5 : 0.5) * chassis->kind->length_m;
    const struct vec3 point = {ahead, -body->inertia.centre_m, 0.0};
    struct vec3 at = vec3_add(body->centre, rotation_apply(turn, point));
    return kinematics_ground(chassis->context, at.x, at.z) - at.y >
           RISE_SHARE * chassis->kind->travel_m;
}

/* Returns true if the underside is or the ends are about to touch uneven ground. */
static bool is_scraping(struct chassis *chassis, const struct mat3 *turn)
{
    const bool uneven = chassis->cratered || chassis->bent;
    for (unsigned n = 0; uneven && n < VEHICLE_SHELL_ENDS; n++) {
        struct vec3 point = shell_of(chassis)->point[n];
        point.y -= chassis->body.inertia.centre_m;
        const struct vec3 at = vec3_add(chassis->body.centre, rotation_apply(turn, point));
        if (at.y - kinematics_ground(chassis->context, at.x, at.z) < SCRAPE_M)
            return true;
    }
    return false;
}

/* Returns true if a wheel is on its bump stop or bears next to nothing, if the body comes down
 * fast, or if the ground rises before it. */
static bool is_rough(struct chassis *chassis, const struct mat3 *turn)
{
    const struct suspension *suspension = &chassis->suspension;
    double least = LEAST_LOAD * suspension->spring_npm * suspension->sag_m;
    const struct vec3 up = {turn->m[0][1], turn->m[1][1], turn->m[2][1]};
    bool rough = -vec3_dot(chassis->body.velocity, up) * CHASSIS_SUBSTEP_S >
                     FAST_SHARE * chassis->kind->travel_m ||
                 ground_rises(chassis, turn) || is_scraping(chassis, turn);
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

/* Looks whether works or craters may be under the body in the sub-step: its wheels and its shell
 * then look at them. */
static void find_uneven(struct chassis *chassis)
{
    const struct step_context *context = chassis->context;
    const struct rigid_body *body = &chassis->body;
    const uint8_t marks = ground_marks_at(context->ground_marks, body->centre.x, body->centre.z);
    const double reach = vehicle_shell_reach(chassis->kind) + NEAR_M +
                         CHASSIS_SUBSTEP_S * vec3_length(body->velocity);
    bool uneven = marks & GROUND_MARKS_CRATER &&
                  terrain_uneven_near(&context->world->terrain, context->craters, body->centre.x,
                                      body->centre.z, reach);
    if (uneven != chassis->cratered)
        suspension_of(chassis->kind, uneven, &chassis->suspension);
    chassis->cratered = uneven;
}

/* --- all of it ---------------------------------------------------------------------------------*/

void chassis_run_begin(struct chassis *chassis, const struct step_context *context, uint32_t i,
                       const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const uint8_t marks = ground_marks_at(context->ground_marks, m->row[i].x, m->row[i].z);
    chassis->context = context;
    chassis->kind = &context->world->kinds[m->row[i].kind];
    chassis->body = rigid_body_take(context, i);
    chassis->desired = *desired;
    chassis->most_mps =
        maths_max(chassis->kind->max_speed_mps, 1e-9) * ground_vehicle_debris(context, i);
    chassis->cratered = false;
    chassis->littered = marks & GROUND_MARKS_DEBRIS;
    chassis->bent =
        terrain_cache_bend(&context->world->terrain, &context->terrain_entries[i], m->row[i].x,
                           m->row[i].z) > chassis_shell_bend(chassis->kind);
    chassis->level = true;
    chassis->drowns = false;
    chassis->fall_j = chassis->strike_j = 0.0;
    chassis->friction = ground_grip_at(context, m->row[i].x, m->row[i].z).friction;
    chassis->drivetrain = drivetrain_of(context, i, desired);
    suspension_of(chassis->kind, chassis->cratered, &chassis->suspension);
    chassis->shell.count = 0;
}

void chassis_run(struct chassis *chassis)
{
    const double dt_s = chassis->context->dt_s;
    int more = (int)ceil(dt_s / ROUGH_STEP_S - 1e-9);
    struct mat3 turn;
    find_uneven(chassis);
    double load = find_load(chassis, &turn);
    want(chassis, &turn);
    chassis->rough = is_rough(chassis, &turn);
    chassis->drowns = is_drowning(chassis, &turn, load, dt_s);
    int parts = chassis->rough ? more : 1;
    for (int p = 0; p < parts; p++) {
        if (p > 0)
            load = find_load(chassis, &turn);
        wheels(chassis, &turn, load, dt_s / parts);
        move(chassis, &turn, load, dt_s / parts);
    }
}
