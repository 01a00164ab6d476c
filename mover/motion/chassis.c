/* Which vehicles are bodies on their springs, rest, and when they are calm. */
#include "mover/motion/chassis.h"

#include "mover/motion/chassis_run.h"
#include "mover/motion/fording.h"
#include "mover/motion/kinematics.h"
#include "world/entity/overturned.h"
#include "world/state.h"
#include "world/terrain/rest_pose.h"
#include "world/world.h"

/* A body that is slower than this, and that no force makes faster, is held in its place. */
#define REST_MPS  0.03
#define REST_RPS  0.02
#define REST_MPS2 0.15

/* A vehicle that is no higher over the ground was set down on it. */
#define PLACED_M 0.01

/* A chassis is calm below these. */
#define JOLT_S        0.1  /* a jolt counts for so long */
#define CALM_MPS      0.15 /* speed towards or from the pose of a vehicle that follows the ground */
#define CALM_RPS      0.15 /* the same of roll and pitch */
#define CALM_SLIP_MPS 0.4  /* to the side */
#define CALM_SLIP     0.09 /* or as a share of its speed: tyres that hold it on a side slope */
#define CALM_LATERAL  0.8  /* share of the greatest lateral acceleration */
#define CALM_TILT_RAD 0.06 /* from the angles of that vehicle */

/* Upright ground harms as a fixed object does (collider/response/deformation.h).
 *
 * How much more the energy of a hard landing harms a vehicle than that of an explosion on it: axles
 * and tracks break first. A jeep that falls from 3 m flat on its wheels is damaged, from 10 m it is
 * destroyed. */
#define FALL_HARM 4.0

/* --- the modes ---------------------------------------------------------------------------------*/

void chassis_disturb(const struct step_context *context, uint32_t i)
{
    context->m->row[i].flags |= ENTITY_FLAG_CHASSIS;
    context->m->row[i].jolt_tick = (uint32_t)context->tick;
}

bool chassis_holds(const struct kind *kind, double friction, const struct chassis_slope *slope)
{
    if (fabs(slope->pitch_rad) <= CHASSIS_TILT_RAD && fabs(slope->roll_rad) <= CHASSIS_TILT_RAD)
        return true;
    double pitch_sine, pitch_cosine, roll_sine, roll_cosine;
    maths_sincos(slope->pitch_rad, &pitch_sine, &pitch_cosine);
    maths_sincos(slope->roll_rad, &roll_sine, &roll_cosine);
    const double along = slope->gain_mps2 + GRAVITY_MPS2 * pitch_sine;
    const double across = slope->lateral_mps2 - GRAVITY_MPS2 * roll_sine;
    const double weight = pitch_cosine * roll_cosine, grip = weight * friction;
    return along * along + across * across <= grip * grip * GRAVITY_MPS2 * GRAVITY_MPS2 &&
           fabs(across) <= weight * drivetrain_lateral(kind, friction);
}

/* A vehicle that is new stands level, whatever the ground. */
static void take_slope(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    if (fabs(m->row[i].y - kinematics_ground(context, m->row[i].x, m->row[i].z)) > PLACED_M)
        return;
    const struct rest_pose pose = rest_pose_of(&context->world->terrain, context->craters,
                                               &context->world->kinds[m->row[i].kind], m->row[i].x,
                                               m->row[i].z, m->row[i].heading);
    m->row[i].pitch = pose.pitch_rad;
    m->row[i].roll = pose.roll_rad;
}

/* Returns how long the row has been calm, in whole tenths of a second: a jolt counts for all of its
 * tenth, so that a vehicle goes back to the ground at the same time at any rate of frames. */
static double calm_s(const struct step_context *context, uint32_t i)
{
    const uint32_t frames = (uint32_t)maths_max(1.0, floor(JOLT_S / context->dt_s + 0.5));
    uint32_t since = (uint32_t)context->tick - context->m->row[i].jolt_tick;
    uint32_t into = (uint32_t)((context->tick - 1) % frames); /* of the present tenth */
    uint32_t tenths = since > into ? (since - into + frames - 1) / frames : 0;
    return ((double)(tenths * frames) + 0.5) * context->dt_s; /* no rounding decides */
}

bool chassis_takes(const struct step_context *context, uint32_t i, bool driven)
{
    const struct entities *m = context->m;
    bool spins = entities_spins(m, i);
    if (!(m->row[i].flags & ENTITY_FLAG_CHASSIS)) {
        if (!driven && !spins)
            return false;
        m->row[i].dodge = driven ? 0.0f : m->row[i].dodge;
        chassis_disturb(context, i);
        take_slope(context, i);
    }
    return driven || calm_s(context, i) < CHASSIS_CALM_S || m->row[i].jolt_tick == ENTITY_PINNED;
}

/* --- rest and calm -----------------------------------------------------------------------------*/

/* Returns true if the body stands still but for what springs and friction leave over, and if the
 * ground does not push it out. */
static bool rests(const struct chassis *chassis, const struct rigid_body *before,
                  const struct rigid_body *after)
{
    double dt_s = chassis->context->dt_s;
    struct vec3 faster = vec3_sub(after->velocity, before->velocity);
    bool wants = chassis->drivetrain.wanted_mps != 0.0 || chassis->drivetrain.neutral ||
                 (chassis->kind->tracked && chassis->drivetrain.yaw_rps != 0.0);
    return !wants && vec3_length(after->velocity) <= REST_MPS &&
           vec3_length(vec3_sub(after->centre, before->centre)) <= REST_MPS * dt_s &&
           vec3_length(after->spin) <= REST_RPS && vec3_length(faster) <= REST_MPS2 * dt_s;
}

/* Holds the row in its place. Position and angles keep every bit, because a heap sleeps only if
 * nothing in it moves (collider/resting/contact_groups.h). */
static void hold(const struct step_context *context, uint32_t i, struct rigid_body *body)
{
    struct entities *m = context->m;
    body->velocity = body->spin = (struct vec3){0.0, 0.0, 0.0};
    m->row[i].vx = m->row[i].vy = m->row[i].vz = 0.0;
    m->row[i].spin_x = m->row[i].spin_y = m->row[i].spin_z = 0.0;
}

/* Where a row is, and how it heads and leans. */
struct stance {
    struct vec3 at;
    double heading_rad, pitch_rad, roll_rad;
};

static struct stance stance_of(const struct entities *m, uint32_t i)
{
    return (struct stance){entities_position(m, i), m->row[i].heading, m->row[i].pitch,
                           m->row[i].roll};
}

/* Returns by how much a row's height and angles are above those of a vehicle that follows the
 * ground there, whose pose is *ground afterwards. */
static struct rest_pose off_ground(const struct step_context *context, const struct kind *kind,
                                   const struct stance *stance, struct rest_pose *ground)
{
    *ground = rest_pose_of(&context->world->terrain, context->craters, kind, stance->at.x,
                           stance->at.z, stance->heading_rad);
    return (struct rest_pose){stance->at.y - ground->y_m,
                              maths_wrap_half(stance->pitch_rad - ground->pitch_rad),
                              maths_wrap_half(stance->roll_rad - ground->roll_rad)};
}

/* Returns true if the row of the chassis lies as a vehicle there that follows the ground, and moves
 * as it in the sub-step. Otherwise it would be lifted from its wheels when it follows the ground,
 * beside a wall for one. Nor may such a vehicle be in the ground there. before: where it was. */
static bool follows_ground(const struct chassis *chassis, uint32_t i, const struct stance *before)
{
    const struct step_context *context = chassis->context;
    const struct kind *kind = chassis->kind;
    const struct stance now = stance_of(context->m, i);
    const double most_m = CALM_MPS * context->dt_s, most_rad = CALM_RPS * context->dt_s;
    struct rest_pose ground, ground_before;
    const struct rest_pose off = off_ground(context, kind, &now, &ground);
    if (fabs(off.y_m) > CHASSIS_LIFT_M || fabs(off.pitch_rad) > CALM_TILT_RAD ||
        fabs(off.roll_rad) > CALM_TILT_RAD)
        return false;
    const struct rest_pose was = off_ground(context, kind, before, &ground_before);
    if (fabs(off.y_m - was.y_m) > most_m || fabs(off.pitch_rad - was.pitch_rad) > most_rad ||
        fabs(off.roll_rad - was.roll_rad) > most_rad)
        return false;
    const struct vec3 at = {now.at.x, ground.y_m, now.at.z};
    const struct mat3 turn =
        rotation_matrix(rotation_of(now.heading_rad, ground.pitch_rad, ground.roll_rad));
    return !chassis->cratered || vehicle_shell_depth(&context->world->terrain, context->craters,
                                                     kind, VEHICLE_SHELL_ENDS, at, &turn) <= 0.0;
}

/* Returns true if the load and the motion along the ground are those of a vehicle that follows the
 * ground. before: the body when the sub-step began. */
static bool is_calm(const struct chassis *chassis, const struct rigid_body *before)
{
    const struct rigid_body *body = &chassis->body;
    const struct mat3 turn = rotation_matrix(body->turn);
    const struct vec3 ahead = {turn.m[0][0], turn.m[1][0], turn.m[2][0]};
    const struct vec3 right = {turn.m[0][2], turn.m[1][2], turn.m[2][2]};
    const double forward = vec3_dot(body->velocity, ahead);
    const double faster = vec3_length(body->velocity) - vec3_length(before->velocity);
    struct chassis_slope slope = {.gain_mps2 = faster / chassis->context->dt_s,
                                  .lateral_mps2 = -forward * body->spin.y};
    double heading;
    rotation_angles(body->turn, &heading, &slope.pitch_rad, &slope.roll_rad);
    if (forward < 0.0)
        slope.gain_mps2 = -slope.gain_mps2;
    if (fording_is_water(chassis->context, body->centre.x, body->centre.z))
        return false; /* what follows the ground cannot cross water */
    return chassis->level && chassis_holds(chassis->kind, chassis->friction, &slope) &&
           fabs(vec3_dot(body->velocity, right)) <
               maths_max(CALM_SLIP_MPS, CALM_SLIP * fabs(forward)) &&
           fabs(slope.lateral_mps2) <
               CALM_LATERAL * drivetrain_lateral(chassis->kind, chassis->friction);
}

/* --- the row -----------------------------------------------------------------------------------*/

/* Puts a row back to x, z if it or its nose has left the world. Returns true if so. */
static bool stop_at_edge(const struct step_context *context, uint32_t i, double x, double z)
{
    struct entities *m = context->m;
    double sine, cosine;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    double lead = m->row[i].vx * sine - m->row[i].vz * cosine < 0.0 ? -0.5 : 0.5;
    lead *= context->world->kinds[m->row[i].kind].length_m;
    if ((m->row[i].x == x && m->row[i].z == z) ||
        (world_holds(context->world, m->row[i].x, m->row[i].z) &&
         world_holds(context->world, m->row[i].x + sine * lead, m->row[i].z - cosine * lead)))
        return false;
    m->row[i].x = x;
    m->row[i].z = z;
    m->row[i].vx = m->row[i].vz = 0.0;
    return true;
}

/* Burns fuel for the desired speed. Returns false if there is none. */
static bool burn(const struct step_context *context, uint32_t i, const struct kind *kind,
                 const struct desired_motion *desired)
{
    double full = maths_max(kind->max_speed_mps, 1e-9);
    return kinematics_burn(context, i,
                           maths_max(kind->idle_share, fabs(desired->speed_mps) / full));
}

/* Returns true if a contact keeps row i from moving, and it does not want to. Its springs would
 * move it, and the collider would put it back. */
static bool stays_pinned(const struct step_context *context, uint32_t i,
                         const struct desired_motion *desired)
{
    const struct entities *m = context->m;
    bool turns = desired->driven ? desired->turn != (double)m->row[i].dodge
                                 : desired->heading_rad != m->row[i].heading;
    bool yaws =
        desired->driven && desired->turn != 0.0 && context->world->kinds[m->row[i].kind].tracked;
    return m->row[i].jolt_tick == ENTITY_PINNED && desired->speed_mps == 0.0 && !turns && !yaws &&
           desired->gear != GEAR_NEUTRAL && entities_still(m, i);
}

/* Notes the harm that the sub-step did. What leans too far in it is a wreck from the end of the
 * frame on, even if it comes back: at another rate a frame would have ended there. */
static void take_harm(const struct chassis *chassis, uint32_t i)
{
    struct entities *m = chassis->context->m;
    if (chassis->fall_j + chassis->strike_j > 0.0)
        m->row[i].harm_j += FALL_HARM * chassis->fall_j + chassis->strike_j;
    if (overturned(m->row[i].pitch, m->row[i].roll))
        m->row[i].harm_j = maths_max(m->row[i].harm_j, chassis->kind->resistance_j);
}

/* Moves row i for a sub-step, the time of the context. Returns true if something blocks it. */
static bool substep(const struct step_context *context, uint32_t i,
                    const struct desired_motion *desired)
{
    struct entities *m = context->m;
    struct chassis chassis;
    const struct stance from = stance_of(m, i);
    chassis_run_begin(&chassis, context, i, desired);
    if (!burn(context, i, chassis.kind, desired))
        chassis.most_mps = 0.0;
    const struct rigid_body before = chassis.body;
    chassis_run(&chassis);
    if (rests(&chassis, &before, &chassis.body))
        hold(context, i, &chassis.body);
    else
        rigid_body_put(context, i, &chassis.body);
    if (desired->driven)
        m->row[i].dodge = (float)chassis.drivetrain.wheel;
    take_harm(&chassis, i);
    bool blocked = stop_at_edge(context, i, from.at.x, from.at.z) || chassis.drowns;
    if (desired->driven || !is_calm(&chassis, &before) || !follows_ground(&chassis, i, &from))
        m->row[i].jolt_tick = (uint32_t)context->tick;
    return blocked || (desired->speed_mps != 0.0 && chassis.drivetrain.wanted_mps == 0.0);
}

bool chassis_move(const struct step_context *context, uint32_t i,
                  const struct desired_motion *desired)
{
    struct entities *m = context->m;
    const int count = (int)ceil(context->dt_s / CHASSIS_SUBSTEP_S - 1e-9);
    if (stays_pinned(context, i, desired)) {
        if (!kinematics_parked(m, i))
            (void)burn(context, i, &context->world->kinds[m->row[i].kind], desired);
        return false;
    }
    if (m->row[i].jolt_tick == ENTITY_PINNED)
        m->row[i].jolt_tick = (uint32_t)context->tick;
    if (count == 1)
        return substep(context, i, desired);
    struct step_context shorter = *context;
    struct desired_motion now = *desired;
    shorter.dt_s = context->dt_s / count;
    bool blocked = false, straight = desired->heading_rad == m->row[i].heading;
    for (int n = 0; n < count; n++) {
        if (straight) /* whoever wants no turn steers against none that its body makes */
            now.heading_rad = m->row[i].heading;
        blocked |= substep(&shorter, i, &now);
    }
    return blocked;
}
