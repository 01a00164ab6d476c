/* Moves ships. */
#include "mover/motion/ship.h"

#include "mover/motion/kinematics.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define KEEL_DRAG_MPS2 2.0 /* brakes a sideways slide */
#define SHORE_DRAG     0.7 /* share of the weight: the friction of soil under a bow that is ashore */

/* Of the rudder and of the heading that an agent wants [s]; of the speed [s]. */
#define RUDDER_S  4.0 /* from amidships to hard over, and until the ship turns so */
#define HEADING_S 6.0
#define SPEED_S   2.0

#define HEEL_RAD     0.07 /* 4 degrees, at top speed and full rudder */
#define ASTERN_SHARE 0.7  /* of full thrust, with the screws astern */
#define TURN_DRAG    1.8  /* of full rudder, in multiples of the drag: 39 % of the speed is lost */
#define STILL_DRAG   0.05 /* share of the drag that grows with the speed, not with its square */
#define STOPPED_MPS  1e-3

static bool navigable(const struct step_context *context, double x, double z)
{
    return x >= 0.0 && z >= 0.0 && x <= WORLD_SIDE_M && z <= WORLD_SIDE_M &&
           cover_is_water(terrain_cover(&context->world->terrain, x, z));
}

/* Heading and speeds along and across it. */
struct course {
    double sine, cosine;       /* of the heading */
    double forward, rightward; /* [m/s] */
};

/* Returns true if the end of the hull that leads is on land, or beyond the world's edge. */
static bool is_aground(const struct step_context *context, const struct kind *kind,
                       const struct course *course, struct vec3 at)
{
    double bow = (course->forward < 0.0 ? -0.5 : 0.5) * kind->length_m;
    return !navigable(context, at.x + course->sine * bow, at.z - course->cosine * bow);
}

/* The shore stops the ship. The bow slides up the beach meanwhile. */
static void slide_ashore(struct course *course, double dt_s)
{
    const double step = SHORE_DRAG * GRAVITY_MPS2 * dt_s;
    course->forward = kinematics_approach(course->forward, 0.0, step);
    course->rightward = kinematics_approach(course->rightward, 0.0, step);
}

/* Returns the position after the frame. */
static struct vec3 find_ahead(const struct step_context *context, uint32_t i,
                              const struct course *course, struct vec3 *velocity)
{
    const struct entities *m = context->m;
    *velocity =
        (struct vec3){course->forward * course->sine + course->rightward * course->cosine, 0.0,
                      -course->forward * course->cosine + course->rightward * course->sine};
    return (struct vec3){m->x[i] + velocity->x * context->dt_s, m->y[i],
                         m->z[i] + velocity->z * context->dt_s};
}

/* --- rudder and screws -------------------------------------------------------------------------*/

/* The effect of the rudder, 0..1: it grows with the speed. The screws turn a ship that lies. */
static double rudder_effect(const struct kind *kind, double forward)
{
    return maths_clamp(fabs(forward) / maths_max(kind->max_speed_mps, 1e-9), 0.15, 1.0);
}

/* The rudder, -1..1, right above 0, as the heel shows it. */
static double rudder_of(double roll, double effect)
{
    return maths_clamp(-roll / (HEEL_RAD * effect * effect), -1.0, 1.0);
}

/* The rudder that the helmsman wants. */
static double helm(const struct kind *kind, const struct desired_motion *desired, double heading,
                   double effect)
{
    if (desired->driven)
        return desired->turn;
    double rate = desired->held ? desired->turn * kind->turn_rate_rps
                                : maths_wrap_half(desired->heading_rad - heading) / HEADING_S;
    return maths_clamp(rate / maths_max(kind->turn_rate_rps * effect, 1e-9), -1.0, 1.0);
}

/* Moves the rudder and turns. The ship heels out of its turn. Returns the rudder. */
static double steer(const struct step_context *context, uint32_t i,
                    const struct desired_motion *desired, struct course *course)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    double effect = rudder_effect(kind, course->forward);
    double wanted = helm(kind, desired, m->heading[i], effect);
    double rudder =
        kinematics_approach(rudder_of(m->roll[i], effect), wanted, context->dt_s / RUDDER_S);
    m->roll[i] = -rudder * HEEL_RAD * effect * effect;
    if (rudder != 0.0) {
        double turned = rudder * effect * kind->turn_rate_rps * context->dt_s;
        m->heading[i] = maths_wrap_turn(m->heading[i] + turned);
        maths_sincos(m->heading[i], &course->sine, &course->cosine);
    }
    return rudder;
}

/* Drag [m/s2] along the heading: full thrust at top speed; a turn adds to it. */
static double drag_of(const struct kind *kind, double forward, double rudder)
{
    double share = forward / maths_max(kind->max_speed_mps, 1e-9);
    double turning = 1.0 + TURN_DRAG * rudder * rudder;
    return kind->acceleration_mps2 *
           (STILL_DRAG * share + (1.0 - STILL_DRAG) * turning * share * fabs(share));
}

/* Returns the acceleration of the screws. A driver who takes the throttle back lets the ship run;
 * it slows by drag alone unless he brakes, with the screws astern. */
static double screws(const struct kind *kind, const struct desired_motion *desired, double wanted,
                     double forward, double drag)
{
    double full = kind->acceleration_mps2, back = ASTERN_SHARE * full;
    double need = (wanted - forward) / SPEED_S + drag;
    bool runs = desired->driven && wanted * forward >= 0.0 && fabs(wanted) < fabs(forward);
    double against = runs ? desired->brake * back : back;
    if (forward < 0.0)
        return maths_clamp(need, -back, runs ? desired->brake * full : full);
    return maths_clamp(need, -against, full);
}

static void sail(const struct step_context *context, uint32_t i,
                 const struct desired_motion *desired, struct course *course)
{
    const struct kind *kind = &context->world->kinds[context->m->kind[i]];
    double full = kind->max_speed_mps;
    double rudder = steer(context, i, desired, course);
    double drag = drag_of(kind, course->forward, rudder);
    double wanted = maths_clamp(desired->speed_mps, -0.5 * full, full), thrust = 0.0;
    if (kinematics_burn(context, i, fabs(wanted) / maths_max(full, 1e-9)))
        thrust = screws(kind, desired, wanted, course->forward, drag);
    course->forward += (thrust - drag) * context->dt_s;
    if (fabs(course->forward - wanted) < STOPPED_MPS)
        course->forward = wanted;
    course->rightward = kinematics_approach(course->rightward, 0.0, KEEL_DRAG_MPS2 * context->dt_s);
}

bool ship_move(const struct step_context *context, uint32_t i, const struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    struct course course;
    struct vec3 velocity;
    maths_sincos(m->heading[i], &course.sine, &course.cosine);
    kinematics_along(m, i, course.sine, course.cosine, &course.forward, &course.rightward);
    sail(context, i, desired, &course);
    struct vec3 at = find_ahead(context, i, &course, &velocity);
    bool blocked = is_aground(context, kind, &course, at);
    if (blocked) {
        slide_ashore(&course, context->dt_s);
        at = find_ahead(context, i, &course, &velocity);
    }
    if (!navigable(context, at.x, at.z)) {
        at = entities_position(m, i);
        velocity = (struct vec3){0.0, 0.0, 0.0};
    }
    at.y =
        kinematics_ground(context, at.x, at.z); /* a post in water has the height of its surface */
    entities_set_position(m, i, at);
    entities_set_velocity(m, i, velocity);
    m->pitch[i] = 0.0;
    return blocked;
}
