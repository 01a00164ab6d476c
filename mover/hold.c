/* Motion without a will: vehicles told to hold their course; and setting bodies on the ground. */
#include "mover/hold.h"

#include "mover/scars.h"

bool hold_row(const struct move *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    pose_advance(&m->x[i], &m->vx[i], move->dt_s);
    pose_advance(&m->z[i], &m->vz[i], move->dt_s);
    if (kind->domain == DOMAIN_LAND)
        return true;
    if (kind->domain == DOMAIN_AIR) {
        m->y[i] += m->vy[i] * move->dt_s;
        return false;
    }
    double y = pose_ground(move, m->x[i], m->z[i]);
    m->vy[i] = (y - m->y[i]) / move->dt_s;
    m->y[i] = y;
    return false;
}

void hold_begin(struct hold *hold)
{
    *hold = (struct hold){.count = 0};
    stand_begin(&hold->stand);
}

bool hold_take(const struct move *move, struct hold *hold, uint32_t i)
{
    int l = hold->count++;
    hold->row[l] = i;
    hold->heading.lane[l] = move->m->heading[i];
    stand_take(move, &hold->stand, l, i);
    return hold->count == LANE_COUNT;
}

void hold_pose(const struct move *move, struct hold *hold)
{
    struct entities *m = move->m;
    struct stand *stand = &hold->stand;
    union lane_masks debris; /* stops nobody who holds */
    maths_sincos_lanes(&hold->heading, &stand->sine, &stand->cosine);
    scars_find(move->scars, &stand->x, &stand->z, &stand->scarred, &debris);
    for (int h = 0; h < LANE_FOURS; h++)
        stand->scarred.four[h] |=
            stand->half_length.four[h] + stand->half_width.four[h] > SCARS_NEAR_M;
    footing_find(&move->world->terrain, &stand->ground, &stand->x, &stand->z);
    stand_pose(move, stand);
    for (int l = 0; l < hold->count; l++) {
        uint32_t i = hold->row[l];
        double y = stand->y.lane[l];
        m->vy[i] = m->state[i] == ENTITY_WRECK ? 0.0 : (y - m->y[i]) / move->dt_s;
        m->y[i] = y;
        m->pitch[i] = stand->pitch.lane[l];
        m->roll[i] = stand->roll.lane[l];
    }
}
