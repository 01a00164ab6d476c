/* Parts of motion that the domains share. */
#include "mover/move.h"

#include "world/square.h"

/* Of a sphere's radius: clear of the ground, well within it. */
#define AIM_SHARE 0.35

double pose_ground(const struct move *move, double x, double z)
{
    return terrain_height(&move->world->terrain, move->craters, x, z);
}

double pose_aim_height(const struct move *move, uint16_t kind)
{
    const struct kind *k = &move->world->kinds[kind];
    bool hulls = move->world->params->collision.shape == SHAPE_MODEL;
    return hulls ? 0.5 * (k->low_m + k->high_m) : AIM_SHARE * k->radius_m;
}

double pose_turn(double heading, double wanted, double rate_rps, double dt_s)
{
    double off = maths_wrap_half(wanted - heading);
    double most = rate_rps * dt_s;
    return maths_wrap_turn(heading + maths_clamp(off, -most, most));
}

void pose_on_ground(const struct move *move, uint32_t i, double sine, double cosine)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double half_length = maths_max(kind->length_m * 0.5, 0.5);
    double half_width = maths_max(kind->width_m * 0.5, 0.5);
    double front = pose_ground(move, m->x[i] + sine * half_length, m->z[i] - cosine * half_length);
    double back = pose_ground(move, m->x[i] - sine * half_length, m->z[i] + cosine * half_length);
    double right = pose_ground(move, m->x[i] + cosine * half_width, m->z[i] + sine * half_width);
    double left = pose_ground(move, m->x[i] - cosine * half_width, m->z[i] - sine * half_width);
    m->pitch[i] = maths_atan2(front - back, 2.0 * half_length);
    m->roll[i] = maths_atan2(left - right, 2.0 * half_width);
}

void pose_speeds(const struct entities *m, uint32_t i, double *forward, double *rightward)
{
    double sine, cosine;
    maths_sincos(m->heading[i], &sine, &cosine);
    *forward = m->vx[i] * sine - m->vz[i] * cosine;
    *rightward = m->vx[i] * cosine + m->vz[i] * sine;
}

double pose_approach(double value, double wanted, double step)
{
    return value + maths_clamp(wanted - value, -step, step);
}

void pose_advance(double *metres, double *speed_mps, double dt_s)
{
    double to = *metres + *speed_mps * dt_s;
    *metres = maths_clamp(to, 0.0, WORLD_SIDE_M);
    if (to != *metres)
        *speed_mps = 0.0;
}

bool pose_burn(const struct move *move, uint32_t i, double share)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    if (!(kind->fuel_l > 0.0))
        return true;
    m->fuel_l[i] = maths_max(0.0, m->fuel_l[i] - kind->fuel_lps * share * move->dt_s);
    return m->fuel_l[i] > 0.0;
}
