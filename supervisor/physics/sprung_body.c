/* Shell, wheels and energy of a vehicle on its springs (docs/decisions/035-chassis.md). */
#include "supervisor/physics/sprung_body.h"

#include "supervisor/physics/measure.h"
#include "world/entity/kind.h"

#include <stddef.h>

#define GRAVITY_MPS2 9.80665
#define SHELL        12u
#define ASIDE_M      0.015 /* a point of the shell so far from the open is not deeper than this */
#define HALF_ROOT    0.70710678118654752
#define SLOPE_M      0.5  /* between the heights that give the slope under a wheel */
#define AIR_M        0.05 /* wheels and shell of a vehicle in the air are higher over the ground */
#define STEEPEST     2.0  /* the height over a wall falls so much faster than the way to it */
#define WHEEL        0.22 /* radius of a wheel over the height of its vehicle, or more */
#define TRACK_END    0.21 /* length of the end of a track over the length */
#define ROLL_BAR     0.75 /* the same of an axle's bar against roll */
#define TANDEM_M     1.2  /* between the rear axles of a truck, at most */

static double square_of(double value)
{
    return value * value;
}

/* --- shell and wheels --------------------------------------------------------------------------*/

/* Returns point i of the shell: underside, as high as the wheels can rise, ends and roof. */
static struct vec3 shell_point(const struct kind *kind, uint32_t i)
{
    const bool tracked = kind->tracked != 0;
    double length = kind->length_m * (i >= 4 ? 0.5 : tracked ? 0.22 : 0.15);
    double under = maths_max(kind->travel_m, tracked ? 0.0 : 0.75 * kind->step_m);
    double nose = maths_min(0.45 * kind->height_m, tracked ? kind->step_m : kind->height_m);
    double height = i < 4 ? under : i < 8 ? maths_max(nose, kind->travel_m) : kind->height_m;
    return (struct vec3){i & 1 ? length : -length, height,
                         i & 2 ? 0.5 * kind->width_m : -0.5 * kind->width_m};
}

static double sag_of(const struct kind *kind)
{
    return GRAVITY_MPS2 / square_of(TWO_PI * kind->heave_hz);
}

/* Returns how far in front of the middle an axle is [m]. */
static double axle_at(const struct kind *kind, uint32_t axle)
{
    uint32_t behind = kind->axles - 1u;
    double length = kind->length_m * (kind->tracked ? 0.58 : 0.68);
    if (kind->tracked || kind->axles == 2)
        return length * (0.5 - (double)axle / behind);
    double spread = maths_min(TANDEM_M, length / kind->axles) * (behind - 1u);
    double front = (length - 0.5 * spread) * behind / kind->axles;
    if (axle == 0)
        return front;
    return -front / behind + spread * (0.5 - (axle - 1.0) / maths_max(behind - 1.0, 1.0));
}

/* Returns how far the ground presses a wheel, along the body's upward axis [m]. Below 0: how high
 * it is over the ground, and more. */
static double squeeze_of(const struct surface *surface, const struct body_look *body,
                         struct vec3 wheel)
{
    const struct vec3 at = vec3_add(body->named.at, rigid_pose_out(&body->now.pose, wheel));
    const struct vec3 up = body->now.pose.up;
    double ground = surface_height(surface, at.x, at.z), half = 0.5 * SLOPE_M;
    if (at.y >= ground)
        return ground - at.y;
    double east =
        (surface_height(surface, at.x + half, at.z) - surface_height(surface, at.x - half, at.z)) /
        SLOPE_M;
    double south =
        (surface_height(surface, at.x, at.z + half) - surface_height(surface, at.x, at.z - half)) /
        SLOPE_M;
    return (ground - at.y) / maths_max(0.3, up.y - up.x * east - up.z * south);
}

/* Returns the energy in a spring over the mass [J/kg]. Its bump stop gives nothing back. */
static double spring_jpkg(const struct kind *kind, double squeeze_m)
{
    double share = 0.5 * square_of(TWO_PI * kind->heave_hz) / (2.0 * kind->axles);
    return share * square_of(maths_clamp(squeeze_m, 0.0, sag_of(kind) + kind->travel_m));
}

/* Returns how high a wheel is over the ground that its rim or the end of its track may touch. */
static double height_of(const struct surface *surface, const struct body_look *body,
                        struct vec3 wheel)
{
    const struct kind *kind = body->kind;
    double lowest = HUGE_VAL, half = maths_max(WHEEL * kind->height_m,
                                               kind->tracked ? TRACK_END * kind->length_m : 0.0);
    for (int n = -2; n <= 2; n++) {
        const struct vec3 place = {wheel.x + 0.5 * n * half, wheel.y, wheel.z};
        const struct vec3 at = vec3_add(body->named.at, rigid_pose_out(&body->now.pose, place));
        lowest = maths_min(lowest, at.y - surface_height(surface, at.x, at.z));
    }
    return lowest;
}

static void look_at_wheels(const struct surface *surface, struct body_look *body,
                           struct sprung_look *look)
{
    const struct kind *kind = body->kind;
    double bar = 0.5 * ROLL_BAR * square_of(TWO_PI * kind->heave_hz) / (2.0 * kind->axles);
    for (uint32_t axle = 0; axle < kind->axles; axle++) {
        double squeeze[2];
        for (int side = 0; side < 2; side++) {
            const struct vec3 wheel = {axle_at(kind, axle), -sag_of(kind),
                                       (side ? 0.5 : -0.5) * kind->track_m};
            squeeze[side] = squeeze_of(surface, body, wheel);
            look->spring_jpkg += spring_jpkg(kind, squeeze[side]);
            look->wheel_m = maths_min(look->wheel_m, height_of(surface, body, wheel));
        }
        look->spring_jpkg +=
            bar * square_of(maths_max(0.0, squeeze[0]) - maths_max(0.0, squeeze[1]));
    }
}

/* Returns how high a point is over the ground [m]. One in the ground beside a wall, such as the
 * edge where two craters meet, is no deeper than its way out to the side: ASIDE_M, if that is
 * enough. */
static double clear_of(const struct surface *surface, struct vec3 at)
{
    static const double way[8][2] = {
        {1.0, 0.0},  {HALF_ROOT, HALF_ROOT},   {0.0, 1.0},  {-HALF_ROOT, HALF_ROOT},
        {-1.0, 0.0}, {-HALF_ROOT, -HALF_ROOT}, {0.0, -1.0}, {HALF_ROOT, -HALF_ROOT}};
    double high = at.y - surface_height(surface, at.x, at.z);
    for (int i = 0; i < 8 && high < -ASIDE_M; i++) {
        if (at.y >= surface_height(surface, at.x + ASIDE_M * way[i][0], at.z + ASIDE_M * way[i][1]))
            return -ASIDE_M;
    }
    return high;
}

void sprung_body_look(const struct surface *surface, struct body_look *body)
{
    struct sprung_look *look = &body->now.springs;
    *look = (struct sprung_look){.wheel_m = HUGE_VAL, .shell_m = HUGE_VAL};
    for (uint32_t i = 0; i < SHELL; i++) {
        const struct vec3 own = rigid_pose_out(&body->now.pose, shell_point(body->kind, i));
        const struct vec3 at = vec3_add(body->named.at, own);
        look->shell_m = maths_min(look->shell_m, clear_of(surface, at));
    }
    look_at_wheels(surface, body, look);
}

/* --- motion ------------------------------------------------------------------------------------*/

/* Returns kinetic energy, height and springs of the body over its mass [J/kg]. */
static double energy_jpkg(const struct body_look *body, const struct motion_look *look)
{
    const struct kind *kind = body->kind;
    double length = square_of(kind->length_m), width = square_of(kind->width_m);
    double height = square_of(kind->height_m);
    const struct vec3 v = motion_look_centre_velocity(look, kind),
                      spin = rigid_pose_in(&look->pose, look->spin);
    double turning = ((height + width) * square_of(spin.x) + (length + width) * square_of(spin.y) +
                      (length + height) * square_of(spin.z)) /
                     24.0;
    double risen = look->pose.at.y + look->pose.up.y * kind->centre_height_m;
    return 0.5 * vec3_dot(v, v) + turning + GRAVITY_MPS2 * risen + look->springs.spring_jpkg;
}

/* Returns how high the lowest of wheels and shell is over the ground [m]. */
static double lowest_of(const struct motion_look *look)
{
    return maths_min(look->springs.wheel_m, look->springs.shell_m);
}

/* Returns how fast a point of the body is at most [m/s]. */
static double fastest_of(const struct motion_look *look, const struct kind *kind)
{
    const struct vec3 sides = {kind->length_m, kind->height_m, kind->width_m};
    return vec3_length(motion_look_centre_velocity(look, kind)) +
           vec3_length(look->spin) * 0.5 * vec3_length(sides);
}

/* Returns true if the body is in the air now and before, and too high to have touched the ground in
 * between: a fast one can come down on a wall and leave it within a frame. */
static bool stays_in_air(const struct body_look *body, double dt_s)
{
    double before = lowest_of(body->was), now = lowest_of(&body->now);
    double fastest =
        maths_max(fastest_of(body->was, body->kind), fastest_of(&body->now, body->kind));
    return before > AIR_M && now > AIR_M && before + now > STEEPEST * fastest * dt_s;
}

/* Returns true if the body goes with the ground, or rests. One that comes back from its springs
 * eases to the height and the angles of the ground without any spin; the climb in a bend of the
 * ground is then no work of its springs. */
static bool goes_with_ground(const struct motion_look *look)
{
    return look->spin.x == 0.0 && look->spin.y == 0.0 && look->spin.z == 0.0;
}

void sprung_body_measure(struct measures *measures, double dt_s, const struct body_look *body)
{
    const struct kind *kind = body->kind;
    if (body->buried_s <= 0.0)
        measure_take(measures, MEASURE_OF_SHELL_UNDERGROUND,
                     maths_max(0.0, -body->now.springs.shell_m), &body->named, NULL);
    if (!body->known || body->commanded || body->blasts > 0 || body->struck > 0 || body->hits > 0 ||
        body->touches || body->touched || !body->was->sprung)
        return;
    const struct vec3 before = motion_look_centre_velocity(body->was, kind);
    const struct vec3 after = motion_look_centre_velocity(&body->now, kind);
    struct vec3 push = vec3_scale(vec3_sub(after, before), 1.0 / dt_s);
    push.y += GRAVITY_MPS2;
    if (stays_in_air(body, dt_s))
        measure_take(measures, MEASURE_OF_FLOATING, vec3_length(push), &body->named, NULL);
    if (goes_with_ground(body->was) && goes_with_ground(&body->now))
        return;
    double engine = kind->power_w / kind->mass_kg * dt_s;
    measure_take(
        measures, MEASURE_OF_SPRUNG_ENERGY,
        maths_max(0.0, energy_jpkg(body, &body->now) - energy_jpkg(body, body->was) - engine),
        &body->named, NULL);
}
