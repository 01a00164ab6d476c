/* Shell, wheels and energy of a vehicle on its springs (docs/decisions/035-chassis.md). */
#include "supervisor/physics/sprung_body.h"

#include "supervisor/physics/measure.h"
#include "world/entity/kind.h"

#include <stddef.h>

#define GRAVITY_MPS2 9.80665
#define SHELL        20u
#define ASIDE_M      0.015 /* a point of the shell so far from the open is not deeper than this */
#define HALF_ROOT    0.70710678118654752
#define SLOPE_M      0.5  /* between the heights that give the slope under a wheel */
#define AIR_M        0.05 /* wheels and shell of a vehicle in the air are higher over the ground */
#define LEANS_MOST   0.3  /* cosine: the least of a wheel's axis and the normal of the ground */
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

/* Returns how far in front of the middle the outer axles are, and how high tracks climb [m]. */
static double outer_axle(const struct kind *kind)
{
    return kind->length_m * (kind->tracked ? 0.29 : 0.34);
}

static double climbs(const struct kind *kind)
{
    double bow = 0.7 * TRACK_END * kind->length_m;
    return kind->tracked ? maths_min(kind->step_m, bow) : kind->step_m;
}

/* Returns point i of the shell: four of the underside, as high as the wheels can rise, of the ends,
 * of the sides beside the outer axles, of the middle of underside and ends, and of the roof. */
static struct vec3 shell_point(const struct kind *kind, uint32_t i)
{
    const bool tracked = kind->tracked != 0;
    const double belly = kind->length_m * (tracked ? 0.22 : 0.15), half = 0.5 * kind->length_m;
    double under = maths_max(kind->travel_m, tracked ? 0.0 : 0.75 * kind->step_m);
    double nose = maths_min(0.45 * kind->height_m, tracked ? kind->step_m : kind->height_m);
    double side = maths_max(under, climbs(kind) * (tracked ? 0.6 : 1.0));
    nose = maths_max(nose, kind->travel_m);
    const double x[] = {belly, half, outer_axle(kind), i & 2 ? half : belly, half};
    const double y[] = {under, nose, side, i & 2 ? nose : under, kind->height_m};
    double wide = i / 4 == 3 ? 0.0 : 0.5 * kind->width_m;
    return (struct vec3){i & 1 ? x[i / 4] : -x[i / 4], y[i / 4], i & 2 ? wide : -wide};
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

/* How the ground presses a wheel. */
struct press {
    double squeeze_m; /* along the body's upward axis; below 0: how high it is over the ground */
    double leans;     /* cosine of that axis and the normal of the ground */
};

static struct press press_of(const struct surface *surface, const struct body_look *body,
                             struct vec3 wheel)
{
    const struct vec3 at = vec3_add(body->named.at, rigid_pose_out(&body->now.pose, wheel));
    const struct vec3 up = body->now.pose.up;
    double ground = surface_height(surface, at.x, at.z), half = 0.5 * SLOPE_M;
    if (at.y >= ground)
        return (struct press){ground - at.y, 1.0};
    double east =
        (surface_height(surface, at.x + half, at.z) - surface_height(surface, at.x - half, at.z)) /
        SLOPE_M;
    double south =
        (surface_height(surface, at.x, at.z + half) - surface_height(surface, at.x, at.z - half)) /
        SLOPE_M;
    double along = up.y - up.x * east - up.z * south;
    return (struct press){(ground - at.y) / maths_max(LEANS_MOST, along),
                          along / sqrt(1.0 + east * east + south * south)};
}

/* Returns the energy that a spring can give back over the mass [J/kg]: its force acts along the
 * normal of the ground. Its bump stop gives nothing back, and a wheel that leans too much bears
 * nothing. */
static double spring_jpkg(const struct kind *kind, const struct press *press)
{
    double share = 0.5 * square_of(TWO_PI * kind->heave_hz) / (2.0 * kind->axles);
    return maths_max(0.0, press->leans) * share *
           square_of(maths_clamp(press->squeeze_m, 0.0, sag_of(kind) + kind->travel_m));
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

/* What the springs of an axle may hold over the mass [J/kg]: edges touch a wheel at any place of
 * its rim. */
struct held {
    double least, most;
};

static void add_axle(const struct surface *surface, const struct body_look *body, uint32_t axle,
                     struct held *held)
{
    const struct kind *kind = body->kind;
    double bar = 0.5 * ROLL_BAR * square_of(TWO_PI * kind->heave_hz) / (2.0 * kind->axles);
    double low[2], high[2];
    for (int side = 0; side < 2; side++) {
        double least = HUGE_VAL, most = 0.0;
        low[side] = HUGE_VAL, high[side] = 0.0;
        for (int n = -2; n <= 2; n++) {
            const struct vec3 wheel = {axle_at(kind, axle) + 0.5 * n * WHEEL * kind->height_m,
                                       -sag_of(kind), (side ? 0.5 : -0.5) * kind->track_m};
            const struct press press = press_of(surface, body, wheel);
            least = maths_min(least, spring_jpkg(kind, &press));
            most = maths_max(most, spring_jpkg(kind, &press));
            low[side] = maths_min(low[side], maths_max(0.0, press.squeeze_m));
            high[side] = maths_max(high[side], press.squeeze_m);
        }
        held->least += least;
        held->most += most;
    }
    double apart = maths_max(0.0, maths_max(low[0] - high[1], low[1] - high[0]));
    double most = maths_max(high[0] - low[1], high[1] - low[0]);
    held->least += bar * square_of(apart);
    held->most += bar * square_of(maths_max(0.0, most));
}

static void look_at_wheels(const struct surface *surface, struct body_look *body,
                           struct sprung_look *look)
{
    const struct kind *kind = body->kind;
    struct held held = {0.0, 0.0};
    for (uint32_t axle = 0; axle < kind->axles; axle++) {
        add_axle(surface, body, axle, &held);
        for (int side = 0; side < 2; side++) {
            const struct vec3 wheel = {axle_at(kind, axle), -sag_of(kind),
                                       (side ? 0.5 : -0.5) * kind->track_m};
            look->wheel_m = maths_min(look->wheel_m, height_of(surface, body, wheel));
        }
    }
    look->spring_jpkg = held.least;
    look->spring_most_jpkg = held.most;
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

/* Returns how high the fronts of the outer wheels are over the ground, at the height of the step
 * that they climb: walls stand against them [m]. */
static double rims_over(const struct surface *surface, const struct body_look *body)
{
    const struct kind *kind = body->kind;
    double lowest = HUGE_VAL;
    double front = maths_min(axle_at(kind, 0) + WHEEL * kind->height_m, 0.5 * kind->length_m);
    for (uint32_t i = 0; i < 4; i++) {
        const struct vec3 rim = {i & 1 ? front : -front, kind->step_m - sag_of(kind),
                                 i & 2 ? 0.5 * kind->track_m : -0.5 * kind->track_m};
        const struct vec3 at = vec3_add(body->named.at, rigid_pose_out(&body->now.pose, rim));
        lowest = maths_min(lowest, at.y - surface_height(surface, at.x, at.z));
    }
    return lowest;
}

void sprung_body_look(const struct surface *surface, struct body_look *body)
{
    struct sprung_look *look = &body->now.springs;
    *look =
        (struct sprung_look){.wheel_m = HUGE_VAL,
                             .shell_m = HUGE_VAL,
                             .water_m = surface_ford(surface, body->named.at.x, body->named.at.z)};
    for (uint32_t i = 0; i < SHELL; i++) {
        const struct vec3 own = rigid_pose_out(&body->now.pose, shell_point(body->kind, i));
        const struct vec3 at = vec3_add(body->named.at, own);
        look->shell_m = maths_min(look->shell_m, clear_of(surface, at));
    }
    look_at_wheels(surface, body, look);
    look->rim_m = rims_over(surface, body);
}

/* --- motion ------------------------------------------------------------------------------------*/

/* Returns kinetic energy and height of the body over its mass [J/kg]. */
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
    return 0.5 * vec3_dot(v, v) + turning + GRAVITY_MPS2 * risen;
}

/* Returns how high the lowest of wheels and shell is over the ground or the water of a ford [m]. */
static double lowest_of(const struct motion_look *look)
{
    const struct sprung_look *springs = &look->springs;
    return maths_min(springs->wheel_m, maths_min(springs->shell_m, springs->rim_m)) -
           springs->water_m;
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
        body->presses > 0 || body->touches || body->touched || !body->was->sprung)
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
    double given = body->now.springs.spring_jpkg - body->was->springs.spring_most_jpkg;
    double gained = energy_jpkg(body, &body->now) - energy_jpkg(body, body->was) + given;
    measure_take(measures, MEASURE_OF_SPRUNG_ENERGY, maths_max(0.0, gained - engine), &body->named,
                 NULL);
}
