/* Parts of motion shared by the domains. */
#include "mover/motion/kinematics.h"

#include "mover/query/ground_marks.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/terrain/terrain_cache.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define AIM_SHARE 0.35 /* of a sphere's radius: above the ground and well within the sphere */

double kinematics_ground(const struct step_context *context, double x, double z)
{
    return terrain_height(&context->world->terrain, context->craters, x, z);
}

void kinematics_ground_lanes(const struct step_context *context, struct terrain_cache *footing,
                             const union simd_lanes *x, const union simd_lanes *z,
                             union simd_lanes *ground)
{
    terrain_cache_find(&context->world->terrain, footing, x, z);
    terrain_cache_heights(&context->world->terrain, footing, x, z, ground);
    for (int l = 0; context->craters->count > 0 && l < LANE_COUNT; l++) {
        if (ground_marks_at(context->ground_marks, x->lane[l], z->lane[l]) & GROUND_MARKS_CRATER)
            ground->lane[l] += crater_offset(context->craters, x->lane[l], z->lane[l]);
    }
}

double kinematics_aim_height(const struct step_context *context, uint16_t kind)
{
    const struct kind *k = &context->world->kinds[kind];
    bool hulls = context->world->params->collision.shape == SHAPE_MODEL;
    return hulls ? 0.5 * (k->low_m + k->high_m) : AIM_SHARE * k->radius_m;
}

double kinematics_turn(double heading, double wanted, double rate_rps, double dt_s)
{
    double off = maths_wrap_half(wanted - heading);
    double most = rate_rps * dt_s;
    return maths_wrap_turn(heading + maths_clamp(off, -most, most));
}

void kinematics_tell(const struct step_context *context, uint32_t i, uint8_t trigger)
{
    context->m->row[i].trigger = trigger;
}

void kinematics_steer(const struct step_context *context, uint32_t i,
                      const struct desired_motion *desired, double rate_rps)
{
    double *heading = &context->m->row[i].heading;
    if (desired->driven)
        *heading = maths_wrap_turn(*heading + desired->turn * rate_rps * context->dt_s);
    else
        *heading = kinematics_turn(*heading, desired->heading_rad, rate_rps, context->dt_s);
}

void kinematics_along(const struct entities *m, uint32_t i, double sine, double cosine,
                      double *forward, double *rightward)
{
    *forward = m->row[i].vx * sine - m->row[i].vz * cosine;
    *rightward = m->row[i].vx * cosine + m->row[i].vz * sine;
}

double kinematics_approach(double value, double wanted, double step)
{
    return value + maths_clamp(wanted - value, -step, step);
}

void kinematics_advance(const struct step_context *context, double *metres, double *speed_mps)
{
    double to = *metres + *speed_mps * context->dt_s;
    *metres = world_clamp(context->world, to);
    if (to != *metres)
        *speed_mps = 0.0;
}

bool kinematics_burn(const struct step_context *context, uint32_t i, double share)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (!(kind->fuel_l > 0.0))
        return true;
    m->row[i].fuel_l = maths_max(0.0, m->row[i].fuel_l - kind->fuel_lps * share * context->dt_s);
    return m->row[i].fuel_l > 0.0;
}

void kinematics_cruise(const struct step_context *context, uint32_t i,
                       const struct cruise_changes *changes)
{
    struct entities *m = context->m;
    const double per_s = 1.0 / (context->dt_s * (double)changes->frames);
    m->row[i].cruise_tick = (uint32_t)context->tick - 1 + changes->frames;
    m->row[i].cruise_rps = changes->turned_rad * per_s;
    m->row[i].cruise_mps2 = changes->gain_mps2;
    m->row[i].cruise_climb_mps2 = (float)(changes->climbed_mps * per_s);
    m->row[i].cruise_pitch_rps = (float)(changes->pitched_rad * per_s);
    m->row[i].cruise_roll_rps = (float)(changes->rolled_rad * per_s);
}
