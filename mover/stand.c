/* Heights under eight bodies at once. */
#include "mover/stand.h"

#include "world/clones.h"

#include <string.h>

#define LEAST_HALF_M 0.5 /* from the middle: nearer the slope of a post's edge says nothing */

/* Points under a body. */
enum { MIDDLE, FRONT, BACK, RIGHT, LEFT, POINTS };

void stand_begin(struct stand *stand)
{
    memset(stand, 0, sizeof *stand);
    for (int l = 0; l < LANE_COUNT; l++)
        stand->ground.patch[l] = &stand->idle, stand->kind[l] = KIND_NONE;
}

bool stand_take(const struct move *move, struct stand *stand, int l, uint32_t i)
{
    const struct entities *m = move->m;
    stand->ground.patch[l] = &move->patches[i];
    __builtin_prefetch(&move->patches[i + STAND_AHEAD]);
    stand->x.lane[l] = m->x[i];
    stand->z.lane[l] = m->z[i];
    if (stand->kind[l] == m->kind[i])
        return false;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    stand->kind[l] = m->kind[i];
    stand->half_length.lane[l] = maths_max(kind->length_m * 0.5, LEAST_HALF_M);
    stand->half_width.lane[l] = maths_max(kind->width_m * 0.5, LEAST_HALF_M);
    return true;
}

static inline void find_points(const struct stand *stand, union lanes x[POINTS],
                               union lanes z[POINTS])
{
    for (int h = 0; h < LANE_FOURS; h++) {
        four px = stand->x.four[h], pz = stand->z.four[h];
        four length_x = stand->sine.four[h] * stand->half_length.four[h];
        four length_z = stand->cosine.four[h] * stand->half_length.four[h];
        four width_x = stand->cosine.four[h] * stand->half_width.four[h];
        four width_z = stand->sine.four[h] * stand->half_width.four[h];
        x[MIDDLE].four[h] = px, z[MIDDLE].four[h] = pz;
        x[FRONT].four[h] = px + length_x, z[FRONT].four[h] = pz - length_z;
        x[BACK].four[h] = px - length_x, z[BACK].four[h] = pz + length_z;
        x[RIGHT].four[h] = px + width_x, z[RIGHT].four[h] = pz + width_z;
        x[LEFT].four[h] = px - width_x, z[LEFT].four[h] = pz - width_z;
    }
}

static void dig(const struct move *move, const struct stand *stand, const union lanes x[POINTS],
                const union lanes z[POINTS], union lanes height[POINTS])
{
    for (int l = 0; l < LANE_COUNT; l++) {
        for (int p = 0; stand->scarred.lane[l] && p < POINTS; p++)
            height[p].lane[l] += crater_offset(move->craters, x[p].lane[l], z[p].lane[l]);
    }
}

VECTOR_CLONES
void stand_pose(const struct move *move, struct stand *stand)
{
    const struct terrain *terrain = &move->world->terrain;
    union lanes x[POINTS], z[POINTS], height[POINTS], pitch_rise, pitch_run, roll_rise, roll_run;
    find_points(stand, x, z);
    for (int p = 0; p < POINTS; p++)
        footing_heights(terrain, &stand->ground, &x[p], &z[p], &height[p]);
    if (move->craters->count > 0)
        dig(move, stand, x, z, height);
    stand->y = height[MIDDLE];
    for (int h = 0; h < LANE_FOURS; h++) {
        pitch_rise.four[h] = height[FRONT].four[h] - height[BACK].four[h];
        pitch_run.four[h] = 2.0 * stand->half_length.four[h];
        roll_rise.four[h] = height[LEFT].four[h] - height[RIGHT].four[h];
        roll_run.four[h] = 2.0 * stand->half_width.four[h];
    }
    maths_slopes_lanes(&pitch_rise, &pitch_run, &stand->pitch);
    maths_slopes_lanes(&roll_rise, &roll_run, &stand->roll);
}
