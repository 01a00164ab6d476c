/* Motion without a will: vehicles told to hold their course; and setting bodies on the ground. */
#include "mover/motion/constant_course.h"

#include "mover/query/ground_marks.h"

bool constant_course_row(const struct step_context *move, uint32_t i)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    kinematics_advance(&m->x[i], &m->vx[i], move->dt_s);
    kinematics_advance(&m->z[i], &m->vz[i], move->dt_s);
    if (kind->domain == DOMAIN_LAND)
        return true;
    if (kind->domain == DOMAIN_AIR) {
        m->y[i] += m->vy[i] * move->dt_s;
        return false;
    }
    double y = kinematics_ground(move, m->x[i], m->z[i]);
    m->vy[i] = (y - m->y[i]) / move->dt_s;
    m->y[i] = y;
    return false;
}

void constant_course_begin(struct constant_course *hold)
{
    *hold = (struct constant_course){.count = 0};
    ground_pose_begin(&hold->stand);
}

bool constant_course_take(const struct step_context *move, struct constant_course *hold, uint32_t i)
{
    int l = hold->count++;
    hold->row[l] = i;
    hold->heading.lane[l] = move->m->heading[i];
    ground_pose_take(move, &hold->stand, l, i);
    return hold->count == LANE_COUNT;
}

void constant_course_pose(const struct step_context *move, struct constant_course *hold)
{
    struct entities *m = move->m;
    struct ground_pose *stand = &hold->stand;
    union lane_masks debris; /* stops nobody who holds */
    maths_sincos_lanes(&hold->heading, &stand->sine, &stand->cosine);
    ground_marks_find(move->scars, &stand->x, &stand->z, &stand->scarred, &debris);
    for (int h = 0; h < LANE_FOURS; h++)
        stand->scarred.f64x4[h] |=
            stand->half_length.f64x4[h] + stand->half_width.f64x4[h] > GROUND_MARKS_NEAR_M;
    terrain_cache_find(&move->world->terrain, &stand->ground, &stand->x, &stand->z);
    ground_pose_pose(move, stand);
    for (int l = 0; l < hold->count; l++) {
        uint32_t i = hold->row[l];
        double y = stand->y.lane[l];
        m->vy[i] = m->state[i] == ENTITY_WRECK ? 0.0 : (y - m->y[i]) / move->dt_s;
        m->y[i] = y;
        m->pitch[i] = stand->pitch.lane[l];
        m->roll[i] = stand->roll.lane[l];
    }
}
