/* Moves wrecks that slide or fall. */
#include "mover/motion/wreck.h"

#include "mover/motion/kinematics.h"
#include "mover/motion/spin.h"
#include "world/world.h"

#define WRECK_FRICTION 0.6 /* share of the weight */

bool wreck_row(const struct step_context *context, uint32_t i, double ground)
{
    struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->kind[i]];
    bool falls = kind->domain == DOMAIN_AIR && m->y[i] > ground;
    bool turned = spin_row(context, i);
    if (!falls && !turned && m->vx[i] == 0.0 && m->vy[i] == 0.0 && m->vz[i] == 0.0 &&
        m->y[i] == ground)
        return false; /* at rest: the common case */
    if (!falls) {
        double speed = sqrt(m->vx[i] * m->vx[i] + m->vz[i] * m->vz[i]);
        double left = maths_max(0.0, speed - WRECK_FRICTION * GRAVITY_MPS2 * context->dt_s);
        double share = speed > 0.0 ? left / speed : 0.0;
        m->vx[i] *= share;
        m->vz[i] *= share;
    }
    kinematics_advance(&m->x[i], &m->vx[i], context->dt_s);
    kinematics_advance(&m->z[i], &m->vz[i], context->dt_s);
    if (!falls && kind->domain != DOMAIN_SEA)
        return true;
    ground = kinematics_ground(context, m->x[i], m->z[i]);
    if (falls) {
        m->vy[i] -= GRAVITY_MPS2 * context->dt_s;
        m->y[i] = maths_max(ground, m->y[i] + m->vy[i] * context->dt_s);
        return false;
    }
    m->y[i] = ground;
    m->vy[i] = 0.0;
    return false;
}

void wrecks_begin(struct wrecks *wrecks)
{
    *wrecks = (struct wrecks){.count = 0};
    for (int l = 0; l < LANE_COUNT; l++)
        wrecks->ground.patch[l] = &wrecks->idle;
}

bool wrecks_take(const struct step_context *context, struct wrecks *wrecks, uint32_t i)
{
    int l = wrecks->count++;
    wrecks->row[l] = i;
    wrecks->x.lane[l] = context->m->x[i];
    wrecks->z.lane[l] = context->m->z[i];
    wrecks->ground.patch[l] = &context->terrain_entries[i];
    return wrecks->count == LANE_COUNT;
}

void wrecks_find_ground(const struct step_context *context, struct wrecks *wrecks)
{
    kinematics_ground_lanes(context, &wrecks->ground, &wrecks->x, &wrecks->z, &wrecks->y);
}
