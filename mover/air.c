/* Aircraft: helicopters hover (min_speed_mps 0), jets keep their speed; both keep their height
 * above the ground ahead of them. */
#include "mover/move.h"

#include "world/square.h"

#define LOOK_AHEAD_S   3.0
#define SIDE_DRAG_MPS2 6.0
#define BANK_LIMIT     1.0 /* [rad] */
#define BANK_RATE_RPS  1.5
#define EDGE_M         200.0 /* turns back this far before the world's edge */

static double ground_ahead(const struct move *move, uint32_t i)
{
    const struct entities *m = move->m;
    double here = pose_ground(move, m->x[i], m->z[i]);
    double ahead =
        pose_ground(move, m->x[i] + m->vx[i] * LOOK_AHEAD_S, m->z[i] + m->vz[i] * LOOK_AHEAD_S);
    return maths_max(here, ahead);
}

bool move_air(const struct move *move, uint32_t i, const struct wish *wish)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double full = maths_max(kind->max_speed_mps, 1e-9);
    double forward, rightward, sine, cosine;
    maths_sincos(m->heading[i], &sine, &cosine);
    pose_along(m, i, sine, cosine, &forward, &rightward);

    double before = m->heading[i];
    pose_steer(move, i, wish, kind->turn_rate_rps);
    if (m->heading[i] != before)
        maths_sincos(m->heading[i], &sine, &cosine);

    double wanted = wish->speed_mps;
    if (!wish->driven) /* a driver of what hovers flies backwards too */
        wanted = maths_clamp(wanted, kind->min_speed_mps, kind->max_speed_mps);
    double climb_limit = kind->climb_rate_mps, climb = wish->climb_mps;
    if (!wish->driven)
        climb = maths_clamp((ground_ahead(move, i) + wish->altitude_m - m->y[i]) * 0.8,
                            -climb_limit, climb_limit);
    if (!pose_burn(move, i, maths_clamp(fabs(wanted) / full, 0.2, 1.0))) {
        wanted = 0.0; /* it glides down */
        climb = -climb_limit;
    }
    double gain = kind->acceleration_mps2 * move->dt_s;
    double speed_before = forward;
    forward = pose_approach(forward, wanted, gain * (1.0 + wish->brake));
    rightward = pose_approach(rightward, 0.0, SIDE_DRAG_MPS2 * move->dt_s);

    m->vx[i] = forward * sine + rightward * cosine;
    m->vz[i] = -forward * cosine + rightward * sine;
    m->vy[i] = pose_approach(m->vy[i], climb, 2.0 * gain);
    pose_advance(&m->x[i], &m->vx[i], move->dt_s);
    pose_advance(&m->z[i], &m->vz[i], move->dt_s);
    m->y[i] += m->vy[i] * move->dt_s;
    bool blocked = m->x[i] < EDGE_M || m->z[i] < EDGE_M || m->x[i] > WORLD_SIDE_M - EDGE_M ||
                   m->z[i] > WORLD_SIDE_M - EDGE_M;

    /* Bank of a coordinated turn; a hovering body leans into its acceleration, a wing climbs. */
    double rate = maths_wrap_half(m->heading[i] - before) / move->dt_s;
    double bank = maths_clamp(maths_atan2(rate * forward, GRAVITY_MPS2), -BANK_LIMIT, BANK_LIMIT);
    double nose =
        kind->min_speed_mps > 0.0
            ? maths_atan2(m->vy[i], maths_max(forward, 1.0))
            : -0.12 * forward / full - 0.1 * (forward - speed_before) / maths_max(gain, 1e-9);
    m->roll[i] = pose_approach(m->roll[i], bank, BANK_RATE_RPS * move->dt_s);
    m->pitch[i] = pose_approach(m->pitch[i], nose, BANK_RATE_RPS * move->dt_s);
    return blocked;
}
