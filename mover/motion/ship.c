/* Moves ships. */
#include "mover/motion/ship.h"

#include "mover/motion/kinematics.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define KEEL_DRAG_MPS2 2.0  /* brakes a sideways slide */
#define HULL_DRAG      0.35 /* share of the acceleration: braking when the screws stand still */
#define SHORE_DRAG     0.7 /* share of the weight: the friction of soil under a bow that is ashore */

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

/* Steers, and sets the speed by screws and drag. */
static void sail(const struct step_context *context, uint32_t i,
                 const struct desired_motion *desired, struct course *course)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    double before = m->heading[i];
    /* The effect of the rudder grows with the speed. */
    double bite =
        maths_clamp(fabs(course->forward) / maths_max(kind->max_speed_mps, 1e-9), 0.15, 1.0);
    kinematics_steer(context, i, desired, kind->turn_rate_rps * bite);
    if (m->heading[i] != before)
        maths_sincos(m->heading[i], &course->sine, &course->cosine);
    double wanted =
        maths_clamp(desired->speed_mps, -0.5 * kind->max_speed_mps, kind->max_speed_mps);
    if (!kinematics_burn(context, i, fabs(wanted) / maths_max(kind->max_speed_mps, 1e-9)))
        wanted = 0.0;
    double rate = kind->acceleration_mps2;
    if (desired->driven && fabs(wanted) < fabs(course->forward))
        rate = kinematics_slowing(kind, desired, course->forward, HULL_DRAG * rate);
    course->forward = kinematics_approach(course->forward, wanted, rate * context->dt_s);
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
    m->roll[i] = 0.0;
    return blocked;
}
