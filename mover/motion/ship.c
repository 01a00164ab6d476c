/* Moves ships. */
#include "mover/motion/ship.h"

#include "mover/motion/kinematics.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define KEEL_DRAG_MPS2 2.0  /* brakes a sideways slide */
#define HULL_DRAG      0.35 /* share of the acceleration: braking when the screws stand still */

static bool navigable(const struct step_context *context, double x, double z)
{
    return x >= 0.0 && z >= 0.0 && x <= WORLD_SIDE_M && z <= WORLD_SIDE_M &&
           cover_is_water(terrain_cover(&context->world->terrain, x, z));
}

bool ship_move(const struct step_context *context, uint32_t i, const struct desired_motion *desired)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    double forward, rightward, sine, cosine;
    bool blocked = false;
    maths_sincos(m->heading[i], &sine, &cosine);
    kinematics_along(m, i, sine, cosine, &forward, &rightward);
    double before = m->heading[i];
    /* The effect of the rudder grows with the speed. */
    double bite = maths_clamp(fabs(forward) / maths_max(kind->max_speed_mps, 1e-9), 0.15, 1.0);
    kinematics_steer(context, i, desired, kind->turn_rate_rps * bite);
    if (m->heading[i] != before)
        maths_sincos(m->heading[i], &sine, &cosine);
    double wanted =
        maths_clamp(desired->speed_mps, -0.5 * kind->max_speed_mps, kind->max_speed_mps);
    if (!kinematics_burn(context, i, fabs(wanted) / maths_max(kind->max_speed_mps, 1e-9)))
        wanted = 0.0;
    double rate = kind->acceleration_mps2;
    if (desired->driven && fabs(wanted) < fabs(forward))
        rate = kinematics_slowing(kind, desired, forward, HULL_DRAG * rate);
    forward = kinematics_approach(forward, wanted, rate * context->dt_s);
    rightward = kinematics_approach(rightward, 0.0, KEEL_DRAG_MPS2 * context->dt_s);
    double vx = forward * sine + rightward * cosine;
    double vz = -forward * cosine + rightward * sine;
    double x = m->x[i] + vx * context->dt_s;
    double z = m->z[i] + vz * context->dt_s;
    double bow = (forward < 0.0 ? -0.5 : 0.5) * kind->length_m;
    if (!navigable(context, x + sine * bow, z - cosine * bow)) {
        blocked = true;
        x = m->x[i];
        z = m->z[i];
        vx = vz = 0.0;
    }
    m->vx[i] = vx;
    m->vy[i] = 0.0;
    m->vz[i] = vz;
    m->x[i] = x;
    m->z[i] = z;
    m->y[i] = kinematics_ground(context, x, z); /* the height of a post in water is the surface's */
    m->pitch[i] = 0.0;
    m->roll[i] = 0.0;
    return blocked;
}
