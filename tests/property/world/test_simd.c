/* What moves eight at a time goes, to the bit, where each would go by itself: on slopes, over
 * craters and in debris, at shores and at the world's edge, with agents and drivers at the
 * controls. The oracle moves land vehicles by a model of its own, and aircraft one at a time.
 * SEED=n tries others. */
#include "mover/agent/agent.h"
#include "mover/motion/aircraft.h"
#include "mover/motion/chassis.h"
#include "mover/motion/chassis_shell.h"
#include "mover/motion/constant_course.h"
#include "mover/motion/drivetrain.h"
#include "mover/motion/fording.h"
#include "mover/motion/ground_vehicle.h"
#include "mover/motion/kinematics.h"
#include "mover/query/ground_marks.h"
#include "tests/support/steps.h"
#include "world/course_lift.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/terrain_cache.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#define ROUNDS  1500
#define CRATERS 40u

static const char scene[] = "world = { seed = 1; capacity = 64; };\n"
                            "objects = ( { kind = \"building\"; at = [25020.0, 25020.0]; },\n"
                            "            { kind = \"tree\"; at = [24990.0, 25060.0]; },\n"
                            "            { kind = \"building\"; at = [25125.0, 25000.0]; } );\n";

static const char course[] =
    "earthworks = ( { shape = \"ramp\"; at = [24950.0, 24950.0]; heading_deg = 30.0;\n"
    "                 length_m = 20.0; width_m = 12.0; height_m = 3.0; },\n"
    "               { shape = \"table\"; at = [25100.0, 25050.0]; length_m = 60.0; width_m = "
    "30.0;\n"
    "                 height_m = 4.0; grade_percent = 30.0; },\n"
    "               { shape = \"washboard\"; at = [25020.0, 25150.0]; length_m = 80.0;\n"
    "                 width_m = 20.0; height_m = 0.3; wave_m = 2.0; } );\n";

static struct fixture f;

/* --- the oracle --------------------------------------------------------------------------------*/

/* What rolling on dirt and the slope ahead take from the engine [m/s2]. */
static double held_back(const struct kind *kind, double climb_rad)
{
    double sine = climb_rad * (1.0 - climb_rad * climb_rad / 6.0);
    return GRAVITY_MPS2 * (sine + (kind->tracked ? 0.045 : 0.05));
}

static double power_of(const struct kind *kind)
{
    return kind->power_w * (kind->tracked ? 0.55 : 0.7) / kind->mass_kg;
}

static double slope_speed(const struct kind *kind, double climb_rad)
{
    if (climb_rad >= kind->max_slope_rad)
        return 0.0;
    return maths_min(power_of(kind) / maths_max(held_back(kind, climb_rad), 1e-3),
                     kind->max_speed_mps);
}

static double debris_speed(const struct kind *vehicle, const struct kind *object)
{
    double covered = vehicle->length_m * vehicle->width_m / (object->length_m * object->width_m);
    double pushed = object->mass_kg * (1.0 - object->debris_keep) * (covered < 1.0 ? covered : 1.0);
    return vehicle->mass_kg / (vehicle->mass_kg + pushed);
}

/* Of every object that fell. */
static double debris_share(const struct step_context *context, const struct kind *vehicle, double x,
                           double z)
{
    const struct world *world = context->world;
    double share = 1.0;
    for (uint32_t n = 0; n < world->counts.fixed; n++) {
        const struct fixed_object *object = &world->fixed[n];
        double dx = x - object->x, dz = z - object->z, radius = (double)object->radius_m;
        if (context->committed->fixed_damage[n] >= DAMAGE_HIGH &&
            dx * dx + dz * dz < radius * radius)
            share = maths_min(share, debris_speed(vehicle, &world->kinds[object->kind]));
    }
    return share;
}

static bool passable(const struct step_context *context, double x, double z)
{
    return x >= 0.0 && z >= 0.0 && x <= WORLD_SIDE_DEFAULT_M && z <= WORLD_SIDE_DEFAULT_M &&
           !cover_is_water(terrain_cover(&context->world->terrain, x, z));
}

static double powered(const struct step_context *context, const struct kind *kind, double pitch,
                      double forward, double wanted)
{
    bool braking = fabs(wanted) < fabs(forward) || wanted * forward < 0.0;
    double rate = kind->acceleration_mps2;
    double gain = power_of(kind) / maths_max(fabs(forward), 0.5) -
                  held_back(kind, wanted < 0.0 ? -pitch : pitch);
    gain /= drivetrain_gears(kind);
    gain = maths_min(maths_max(gain, 0.1), rate);
    if (braking)
        gain = maths_min(BRAKES * rate, 0.7 * GRAVITY_MPS2);
    if (fabs(pitch) > 0.4 && (!braking || fabs(wanted) > 0.8 * fabs(forward)))
        gain = maths_min(gain, 1.0);
    return kinematics_approach(forward, wanted * forward < 0.0 ? 0.0 : wanted,
                               gain * context->dt_s);
}

/* How fast it turns without sliding or leaning over, and on wheels in its tightest circle. */
static double turn_rate(const struct kind *kind, double forward, double after)
{
    double agility = maths_clamp(0.35 + (1.0 - 0.35) * fabs(forward) / 4.0, 0.0, 1.0);
    double speed = maths_max(fabs(forward), 1.0);
    double circle =
        maths_min(fabs(forward), fabs(after)) * (1.0 / maths_max(kind->least_turn_m, 0.1));
    double over = 0.8 * (0.5 * kind->track_m / maths_max(kind->centre_height_m, 0.01));
    double lateral = 0.75 * (GRAVITY_MPS2 * maths_min(0.65, over));
    double rate = maths_min(kind->turn_rate_rps * agility, lateral / speed);
    return kind->tracked ? rate : maths_min(rate, circle);
}

static double standing_height(const struct step_context *context, uint32_t i, double x, double z)
{
    const struct kind *kind = &context->world->kinds[context->m->row[i].kind];
    struct crater_footing footing = {.x = x,
                                     .z = z,
                                     .half_length = maths_max(kind->length_m * 0.5, 0.5),
                                     .half_width = maths_max(kind->width_m * 0.5, 0.5)};
    maths_sincos(context->m->row[i].heading, &footing.sine, &footing.cosine);
    return kinematics_ground(context, x, z) +
           terrain_lift(&context->world->terrain, context->craters, &footing);
}

static void stand_on_ground(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double half_length = maths_max(kind->length_m * 0.5, 0.5);
    double half_width = maths_max(kind->width_m * 0.5, 0.5);
    double sine, cosine, x = m->row[i].x, z = m->row[i].z;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    double length_x = sine * half_length, length_z = cosine * half_length;
    double width_x = cosine * half_width, width_z = sine * half_width;
    double front = kinematics_ground(context, x + length_x, z - length_z);
    double back = kinematics_ground(context, x - length_x, z + length_z);
    double right = kinematics_ground(context, x + width_x, z + width_z);
    double left = kinematics_ground(context, x - width_x, z - width_z);
    const double rise = front - back, run = 2.0 * half_length;
    m->row[i].pitch = maths_atan2(rise, run);
    m->row[i].roll =
        maths_atan2((left - right) * run, 2.0 * half_width * sqrt(run * run + rise * rise));
}

/* By how much craters differ under it, or how far earthworks bend under it [m]. */
static double crater_step(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double length = maths_max(kind->length_m * 0.5, 0.5), sine, cosine;
    double width = maths_max(kind->width_m * 0.5, 0.5), x = m->row[i].x, z = m->row[i].z;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    const double at[5][2] = {{x, z},
                             {x + sine * length, z - cosine * length},
                             {x - sine * length, z + cosine * length},
                             {x + cosine * width, z + sine * width},
                             {x - cosine * width, z - sine * width}};
    double low = INFINITY, high = -INFINITY;
    double offset[5];
    for (int p = 0; p < 5; p++) {
        double dug = crater_offset(context->craters, at[p][0], at[p][1]);
        low = maths_min(low, dug);
        high = maths_max(high, dug);
        offset[p] = earthwork_offset(&context->world->terrain.earthworks, at[p][0], at[p][1]);
    }
    double along = fabs(offset[1] + offset[2] - 2.0 * offset[0]);
    double across = fabs(offset[3] + offset[4] - 2.0 * offset[0]);
    return maths_max(high - low, maths_max(along, across));
}

static void speeds_of(const struct entities *m, uint32_t i, double *forward, double *rightward)
{
    double sine, cosine;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    kinematics_along(m, i, sine, cosine, forward, rightward);
}

/* How deep the shell of row i is with this pose at a place: its first points. */
static double shell_depth(const struct step_context *context, uint32_t i, uint32_t points,
                          struct vec3 at, double pitch, double roll)
{
    const struct entities *m = context->m;
    struct mat3 turn = rotation_matrix(rotation_of(m->row[i].heading, pitch, roll));
    return vehicle_shell_depth(&context->world->terrain, context->craters,
                               &context->world->kinds[m->row[i].kind], points, at, &turn);
}

static double climb_of(const struct entities *m, uint32_t i, double pitch)
{
    double sine, cosine;
    maths_sincos(m->row[i].heading, &sine, &cosine);
    return (m->row[i].vx * sine - m->row[i].vz * cosine) * pitch * (1.0 + pitch * pitch / 3.0);
}

/* Where a row was before the frame. */
struct row_before {
    double x, y, z, heading, pitch, roll;
};

/* Returns 0 if its shell is not in the ground where the ground bends or where works and craters may
 * be, and would not be in a frame; 1 if it would not be if it had kept its height, pitch and roll;
 * 2 if it was not where it was before. */
static int enters_ground(const struct step_context *context, uint32_t i,
                         const struct row_before *was)
{
    struct entities *m = context->m;
    struct terrain_cache_entry entry = {.held = 0};
    double bend = terrain_cache_bend(&context->world->terrain, &entry, m->row[i].x, m->row[i].z);
    struct vec3 at = {m->row[i].x, m->row[i].y, m->row[i].z};
    struct vec3 way = {m->row[i].vx * context->dt_s,
                       climb_of(m, i, m->row[i].pitch) * context->dt_s,
                       m->row[i].vz * context->dt_s};
    bool marked = ground_marks_at(context->ground_marks, was->x, was->z) & GROUND_MARKS_CRATER;
    const bool bends = bend > chassis_shell_bend(&context->world->kinds[m->row[i].kind]);
    const uint32_t points = bends ? VEHICLE_SHELL_SIDES : VEHICLE_SHELL_ENDS;
    const struct vec3 next = vec3_add(at, way);
    if ((!bends && !marked) ||
        (shell_depth(context, i, points, at, m->row[i].pitch, m->row[i].roll) <= 0.0 &&
         shell_depth(context, i, points, next, m->row[i].pitch, m->row[i].roll) <= 0.0))
        return 0;
    at.y = was->y + climb_of(m, i, was->pitch) * context->dt_s;
    if (shell_depth(context, i, points, at, was->pitch, was->roll) <= 0.0)
        return 1;
    double heading = m->row[i].heading;
    m->row[i].heading = was->heading;
    double depth = shell_depth(context, i, points, (struct vec3){was->x, was->y, was->z},
                               was->pitch, was->roll);
    m->row[i].heading = heading;
    return marked && depth <= 0.01 ? 2 : 0;
}

/* Returns true if one of the nine posts about a place is wet. */
static bool is_near_water(const struct step_context *context, double x, double z)
{
    struct terrain_cache_entry entry = {.held = 0};
    (void)terrain_cache_bend(&context->world->terrain, &entry, x, z);
    return entry.water != 0;
}

/* Returns true if craters and works lift the row faster than by 0.3 m/s. */
static bool jolts(const struct step_context *context, uint32_t i, const struct row_before *was)
{
    struct entities *m = context->m;
    const double heading = m->row[i].heading;
    double now = standing_height(context, i, m->row[i].x, m->row[i].z) -
                 kinematics_ground(context, m->row[i].x, m->row[i].z);
    m->row[i].heading = was->heading;
    double before =
        standing_height(context, i, was->x, was->z) - kinematics_ground(context, was->x, was->z);
    m->row[i].heading = heading;
    return now - before > 0.3 * context->dt_s;
}

static bool drive_one(const struct step_context *context, uint32_t i,
                      const struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    double forward, rightward, sine, cosine;
    bool blocked = false;
    speeds_of(m, i, &forward, &rightward);
    double heading = m->row[i].heading, pitch = m->row[i].pitch;
    double wanted = desired->speed_mps;
    double share = maths_max(fabs(wanted) / maths_max(kind->max_speed_mps, 1e-9), kind->idle_share);
    double frames = kinematics_parked(m, i) ? 0.0 : 1.0;
    if (desired->held)
        frames = (double)kinematics_burn_frames(context, i);
    if (!kinematics_burn(context, i, share * frames))
        wanted = 0.0;
    double limit = slope_speed(kind, wanted < 0.0 ? -pitch : pitch);
    if (fabs(wanted) > 0.0 && limit <= 0.0)
        blocked = true;
    limit = maths_min(limit,
                      debris_share(context, kind, m->row[i].x, m->row[i].z) * kind->max_speed_mps);
    wanted = maths_clamp(wanted, -limit, limit);
    double brakes = maths_min(BRAKES * kind->acceleration_mps2, 0.7 * GRAVITY_MPS2), fast = forward;
    forward = powered(context, kind, pitch, forward, wanted);
    kinematics_steer(context, i, desired, turn_rate(kind, fast, forward));
    maths_sincos(m->row[i].heading, &sine, &cosine);
    const double gain_mps2 =
        (forward - (m->row[i].vx * sine - m->row[i].vz * cosine)) / context->dt_s;
    rightward = kinematics_approach(rightward, 0.0, 0.7 * GRAVITY_MPS2 * context->dt_s);

    double vx = forward * sine + rightward * cosine;
    double vz = -forward * cosine + rightward * sine;
    double x = m->row[i].x + vx * context->dt_s, z = m->row[i].z + vz * context->dt_s;
    double lead = forward < 0.0 ? -kind->length_m * 0.5 : kind->length_m * 0.5;
    double slower = kinematics_approach(fast, 0.0, brakes * context->dt_s);
    double now = vx * sine - vz * cosine, way = kind->length_m * 0.5 + fast * fast / (2.0 * brakes);
    way = fast < 0.0 ? -way : way;
    if (is_near_water(context, x, z) && now * fast > 0.0 && fabs(now) > fabs(slower) &&
        cover_is_water(terrain_cover(&context->world->terrain, m->row[i].x + way * sine,
                                     m->row[i].z - way * cosine))) {
        double less_x = (slower - now) * sine, less_z = (now - slower) * cosine;
        vx += less_x, vz += less_z;
        x += less_x * context->dt_s, z += less_z * context->dt_s;
    }
    bool goes = x != m->row[i].x || z != m->row[i].z, wades = false;
    if (goes &&
        (!passable(context, x + sine * lead, z - cosine * lead) || !passable(context, x, z))) {
        blocked = true;
        wades = vx * vx + vz * vz >
                    0.7 * GRAVITY_MPS2 * context->dt_s * 0.7 * GRAVITY_MPS2 * context->dt_s &&
                fording_passable(context, kind, x, z) &&
                fording_passable(context, kind, x + sine * lead, z - cosine * lead);
        x = wades ? x : m->row[i].x, z = wades ? z : m->row[i].z;
        vx = wades ? vx : 0.0, vz = wades ? vz : 0.0;
    }
    const struct row_before was = {m->row[i].x, m->row[i].y, m->row[i].z,
                                   heading,     pitch,       m->row[i].roll};
    double y = standing_height(context, i, x, z), before = m->row[i].y, roll = m->row[i].roll;
    entities_set_velocity(m, i, (struct vec3){vx, (y - before) / context->dt_s, vz});
    entities_set_position(m, i, (struct vec3){x, y, z});
    stand_on_ground(context, i);
    int enters = enters_ground(context, i, &was);
    const struct chassis_slope slope = {m->row[i].pitch, m->row[i].roll, gain_mps2,
                                        forward * maths_wrap_half(m->row[i].heading - heading) /
                                            context->dt_s};
    if (forward * (pitch - m->row[i].pitch) > GRAVITY_MPS2 * context->dt_s ||
        crater_step(context, i) > CHASSIS_STEP_M ||
        y - kinematics_ground(context, x, z) > CHASSIS_LIFT_M || wades || enters != 0 ||
        jolts(context, i, &was)) {
        double climb = climb_of(m, i, pitch);
        chassis_disturb(context, i);
        m->row[i].vy = climb;
        m->row[i].y = before + climb * context->dt_s;
        m->row[i].pitch = pitch;
        m->row[i].roll = roll;
        m->row[i].spin_y = -maths_wrap_half(m->row[i].heading - heading) / context->dt_s;
        if (enters == 2) {
            m->row[i].x = was.x, m->row[i].y = was.y, m->row[i].z = was.z;
            m->row[i].heading = was.heading;
        }
    } else if (!chassis_holds(kind, ground_grip_at(context, x, z).friction, &slope)) {
        chassis_disturb(context, i);
        m->row[i].vy = climb_of(m, i, m->row[i].pitch);
        m->row[i].spin_y = -maths_wrap_half(m->row[i].heading - heading) / context->dt_s;
    }
    return blocked;
}

static double lift_of(const struct step_context *context, const struct entities *e, uint32_t i)
{
    const struct rest_pose pose = {e->row[i].y, e->row[i].pitch, e->row[i].roll};
    return course_lift(context->world, context->craters, e->row[i].kind, e->row[i].x, e->row[i].z,
                       e->row[i].heading, &pose);
}

static void hold_one(const struct step_context *context, uint32_t i)
{
    struct entities *m = context->m;
    double before = m->row[i].y;
    m->row[i].y = standing_height(context, i, m->row[i].x, m->row[i].z);
    stand_on_ground(context, i);
    m->row[i].y += lift_of(context, m, i);
    if (m->row[i].flags & ENTITY_FLAG_CHASSIS) {
        const struct entities *w = &context->committed->entities;
        const struct rest_pose ground = {m->row[i].y, m->row[i].pitch, m->row[i].roll};
        const struct rest_pose was =
            course_lift_pose(context->world, context->craters, m->row[i].kind, w->row[i].x,
                             w->row[i].z, w->row[i].heading);
        ground_vehicle_ease(context, i, &was, &ground);
        double left_m = lift_of(context, w, i) - GROUND_VEHICLE_EASE_MPS * context->dt_s;
        m->row[i].y += maths_max(0.0, lift_of(context, m, i) - maths_max(0.0, left_m));
    }
    m->row[i].vy = (m->row[i].y - before) / context->dt_s;
}

/* An aircraft that flies alone in its batch. tests/unit/mover/motion/test_airframe.c tests the
 * model.
 */
static bool fly_one(const struct step_context *context, uint32_t i,
                    const struct desired_motion *desired)
{
    struct aircraft alone;
    aircraft_begin(&alone, 1);
    aircraft_take(context, &alone, i, desired);
    aircraft_move(context, &alone);
    return alone.blocked.lane[0] != 0;
}

/* --- worlds, vehicles and desired motion -------------------------------------------------------*/

static double rough(double x, double z, const void *context)
{
    double height = *(const double *)context;
    return 100.0 + height * maths_sin(x * 0.021) * maths_cos(z * 0.017) +
           0.2 * height * maths_sin(x * 0.09 + z * 0.07);
}

/* Near the middle, where there are craters and debris; at the shore; at the edges. */
static double place(uint64_t *random)
{
    switch (fixture_random(random) % 4) {
    case 0:
        return fixture_uniform(random, 0.0, 8.0);
    case 1:
        return fixture_uniform(random, WORLD_SIDE_DEFAULT_M - 8.0, WORLD_SIDE_DEFAULT_M);
    default:
        return fixture_uniform(random, 24900.0, 25200.0);
    }
}

static double some(uint64_t *random, double often, double low, double high)
{
    return fixture_uniform(random, 0.0, 1.0) < often ? fixture_uniform(random, low, high) : 0.0;
}

static void draw_row(const struct entities *e, uint64_t *random, uint32_t i, bool flies)
{
    static const char *const land[] = {"tank", "truck", "jeep", "carrier"};
    static const char *const air[] = {"helicopter", "jet"};
    uint16_t kind = fixture_kind(&f, flies ? air[fixture_random(random) % 2]
                                           : land[fixture_random(random) % 4]);
    entities_clear(e, i);
    e->row[i].kind = kind;
    e->row[i].id = i + 1;
    e->row[i].state = ENTITY_ACTIVE;
    e->row[i].x = place(random);
    e->row[i].z = place(random);
    e->row[i].y = fixture_uniform(random, 90.0, 110.0);
    e->row[i].vx = some(random, 0.8, -20.0, 20.0);
    e->row[i].vz = some(random, 0.8, -20.0, 20.0);
    e->row[i].heading = some(random, 0.9, 0.0, TWO_PI);
    e->row[i].pitch = some(random, 0.8, -0.9, 0.9);
    e->row[i].fuel_l = some(random, 0.8, 0.0, 0.01);
}

static struct desired_motion draw_wish(const struct entities *e, uint64_t *random, uint32_t i)
{
    const struct kind *kind = &f.view.world.kinds[e->row[i].kind];
    double most = kind->max_speed_mps;
    struct desired_motion desired = {
        .heading_rad = e->row[i].heading + some(random, 0.7, -7.0, 7.0),
        .speed_mps = some(random, 0.8, -most, 1.2 * most),
        .altitude_m = some(random, 0.8, 0.0, 150.0),
    };
    if (fixture_random(random) % 3 == 0) {
        desired.driven = true;
        desired.gear = (enum gearing)(fixture_random(random) % GEAR_COUNT);
        desired.turn = some(random, 0.7, -1.0, 1.0);
        desired.brake = some(random, 0.5, 0.0, 1.0);
        desired.climb_mps = some(random, 0.5, -10.0, 10.0);
    }
    return desired;
}

/* Craters all over the middle and objects that fell, or neither. */
static void scar(uint64_t *random, bool cratered)
{
    struct mover *mover = &f.stepper.mover;
    struct state now = fixture_state(&f);
    now.head->crater_count = cratered ? CRATERS : 0;
    for (uint32_t n = 0; n < now.head->crater_count; n++)
        now.craters[n] = (struct crater){fixture_uniform(random, 24900.0, 25200.0),
                                         fixture_uniform(random, 24900.0, 25200.0),
                                         (float)fixture_uniform(random, 1.0, 12.0), 1.5f, 1};
    for (uint32_t n = 0; n < f.view.world.counts.fixed; n++)
        now.fixed_damage[n] = cratered && fixture_random(random) % 4 ? DAMAGE_HIGH : DAMAGE_LOW;
    crater_index_update(&mover->craters, 0);
    crater_index_update(&mover->craters, now.head->crater_count);
    mover->ground_marks.craters = UINT32_MAX; /* they are another world's */
    ground_marks_update(&mover->ground_marks, &f.view.world, &now);
}

/* --- the two beside each other -----------------------------------------------------------------*/

struct drawn {
    uint32_t moved, flown, blocked, steep, cratered, partial;
};

/* The mover's table, and the oracle's: a copy. */
struct both {
    const struct step_context *context;
    struct step_context alone;
    struct entities rows; /* of alone */
};

static void compare(const struct both *both, uint32_t i)
{
    const struct entities *one = &both->rows, *many = both->context->m;
#define X(type, name) assert_true(one->row[i].name == many->row[i].name);
    ENTITY_FIELDS(X)
#undef X
}

static void draw_rows(struct both *both, uint64_t *random, uint32_t used, bool flies,
                      struct desired_motion desired[LANE_COUNT])
{
    for (uint32_t i = 0; i < used; i++) {
        draw_row(both->context->m, random, i, flies);
        desired[i] = draw_wish(both->context->m, random, i);
        both->context->m->row[i].steer = (float)some(random, 0.7, -1.0, 1.0);
        both->context->m->row[i].throttle = (float)some(random, 0.8, -1.0, 1.0);
    }
    entities_copy(&both->rows, both->context->m, 0, used);
}

static void drive(struct both *both, uint64_t *random, struct ground_vehicle *land, uint32_t used,
                  struct drawn *drawn)
{
    struct desired_motion desired[LANE_COUNT];
    draw_rows(both, random, used, false, desired);
    for (uint32_t i = 0; i < used; i++) {
        bool held = fixture_random(random) % 2 != 0;
        desired[i].driven = false; /* who is driven is on his springs */
        bool full = held ? ground_vehicle_take_held(both->context, land, i)
                         : ground_vehicle_take(both->context, land, i, &desired[i]);
        if (held)
            agent_controls_motion(&both->alone, i, &desired[i]);
        assert_int_equal(full, i + 1 == LANE_COUNT);
    }
    ground_vehicle_move(both->context, land);
    for (uint32_t i = 0; i < used; i++) {
        bool blocked = drive_one(&both->alone, i, &desired[i]);
        compare(both, i);
        assert_int_equal(land->blocked.lane[i], blocked ? -1 : 0);
        drawn->blocked += blocked;
        drawn->steep += fabs(both->rows.row[i].pitch) > 0.45;
        drawn->cratered += land->pose.cratered.lane[i] != 0;
    }
    drawn->moved += used;
    drawn->partial += used < LANE_COUNT;
    land->count = 0;
}

static void pose(struct both *both, struct constant_course *hold, uint32_t used)
{
    for (uint32_t i = 0; i < used; i++)
        assert_int_equal(constant_course_take(both->context, hold, i), i + 1 == LANE_COUNT);
    constant_course_set_down(both->context, hold);
    for (uint32_t i = 0; i < used; i++) {
        hold_one(&both->alone, i);
        compare(both, i);
    }
    hold->count = 0;
}

static void fly(struct both *both, uint64_t *random, struct aircraft *air, uint32_t used,
                struct drawn *drawn)
{
    struct desired_motion desired[LANE_COUNT];
    draw_rows(both, random, used, true, desired);
    for (uint32_t i = 0; i < used; i++)
        assert_int_equal(aircraft_take(both->context, air, i, &desired[i]), i + 1 == LANE_COUNT);
    aircraft_move(both->context, air);
    for (uint32_t i = 0; i < used; i++) {
        bool blocked = fly_one(&both->alone, i, &desired[i]);
        compare(both, i);
        assert_int_equal(air->blocked.lane[i], blocked ? -1 : 0);
    }
    drawn->flown += used;
    air->count = 0;
}

/* Some rows, in order, into as many lanes as they fill; again with what the others left there. */
static void move_some(struct both *both, uint64_t *random, struct drawn *drawn)
{
    struct ground_vehicle land;
    struct constant_course hold;
    struct aircraft air;
    ground_vehicle_begin(&land, 1);
    constant_course_begin(&hold);
    aircraft_begin(&air, 1);
    for (int again = 0; again < 3; again++) {
        uint32_t used = 1 + (uint32_t)fixture_random(random) % LANE_COUNT;
        drive(both, random, &land, used, drawn);
        pose(both, &hold, used);
        fly(both, random, &air, used, drawn);
    }
}

/* Without earthworks and with some. */
static void lanes_go_where_one_would(const char *text, uint64_t seed)
{
    static const double heights[] = {0.0, 3.0, 15.0, 60.0};
    uint64_t random = fixture_seed(seed);
    struct drawn drawn = {0};
    struct serial_context serial_context;
    struct step_context context;
    struct both both = {.context = &context};
    fixture_open(&f, text);
    assert_true(f.view.world.counts.fixed == 3);
    void *memory = calloc(1, entities_bytes(64) + TABLE_ALIGN);
    assert_non_null(memory);
    entities_bind(&both.rows, 64, memory);
    for (int i = 0; i < ROUNDS; i++) {
        if (i % 300 == 0) {
            steps_cover(&f, COVER_GRASS, 0.0, 0.0, WORLD_SIDE_DEFAULT_M, WORLD_SIDE_DEFAULT_M);
            steps_cover(&f, COVER_LAKE, 25125.0, 24000.0, 26000.0, 25000.0);
            steps_ground(&f, rough, &heights[i / 300 % 4]);
        }
        if (i % 50 == 0)
            scar(&random, i % 100 == 0);
        steps_serial_context(&f, &context, &serial_context);
        both.alone = context;
        both.alone.m = &both.rows;
        move_some(&both, &random, &drawn);
    }
    free(memory);
    fixture_close(&f);
    print_message("%u drove: %u blocked, %u on steep ground, %u cratered; %u batches not full; "
                  "%u flew\n",
                  drawn.moved, drawn.blocked, drawn.steep, drawn.cratered, drawn.partial,
                  drawn.flown);
    assert_true(drawn.blocked > 500 && drawn.steep > 100 && drawn.cratered > 500 &&
                drawn.partial > 500);
}

static void test_lanes_go_where_one_would(void **state)
{
    (void)state;
    lanes_go_where_one_would(scene, 50);
}

static void test_lanes_go_so_over_earthworks(void **state)
{
    char text[2048];
    (void)state;
    snprintf(text, sizeof text, "%s%s", scene, course);
    lanes_go_where_one_would(text, 51);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lanes_go_where_one_would),
                                       cmocka_unit_test(test_lanes_go_so_over_earthworks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
