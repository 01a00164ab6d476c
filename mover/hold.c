/* Motions without a will: vehicles told to hold their course, and wrecks. */
#include "mover/move.h"

#define WRECK_FRICTION 0.6 /* of the weight */

static void pose_by_heading(const struct move *move, uint32_t i)
{
    double sine, cosine;
    maths_sincos(move->m->heading[i], &sine, &cosine);
    pose_on_ground(move, i, sine, cosine);
}

/* Keeps heading and speed and reacts to nothing, save that what ran into it may have set it
 * turning; a land vehicle's height is the ground's, a ship's the water's. */
void move_hold(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    pose_advance(&m->x[i], &m->vx[i], move->dt_s);
    pose_advance(&m->z[i], &m->vz[i], move->dt_s);
    if (kind->domain == DOMAIN_AIR) {
        m->y[i] += m->vy[i] * move->dt_s;
        return;
    }
    double y = pose_ground(move, m->x[i], m->z[i]);
    m->vy[i] = (y - m->y[i]) / move->dt_s;
    m->y[i] = y;
    if (kind->domain == DOMAIN_LAND)
        pose_by_heading(move, i);
}

void move_wreck(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double ground = pose_ground(move, m->x[i], m->z[i]);
    bool falls = kind->domain == DOMAIN_AIR && m->y[i] > ground;
    bool turned = spin_row(move, i);
    if (!falls && !turned && m->vx[i] == 0.0 && m->vy[i] == 0.0 && m->vz[i] == 0.0 &&
        m->y[i] == ground)
        return; /* at rest: the common case */
    if (!falls) {
        double speed = sqrt(m->vx[i] * m->vx[i] + m->vz[i] * m->vz[i]);
        double left = maths_max(0.0, speed - WRECK_FRICTION * GRAVITY_MPS2 * move->dt_s);
        double share = speed > 0.0 ? left / speed : 0.0;
        m->vx[i] *= share;
        m->vz[i] *= share;
    }
    pose_advance(&m->x[i], &m->vx[i], move->dt_s);
    pose_advance(&m->z[i], &m->vz[i], move->dt_s);
    ground = pose_ground(move, m->x[i], m->z[i]);
    if (falls) {
        m->vy[i] -= GRAVITY_MPS2 * move->dt_s;
        m->y[i] = maths_max(ground, m->y[i] + m->vy[i] * move->dt_s);
        return;
    }
    m->y[i] = ground;
    m->vy[i] = 0.0;
    if (kind->domain != DOMAIN_SEA)
        pose_by_heading(move, i);
}
