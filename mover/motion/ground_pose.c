/* Heights under eight bodies at once. */
#include "mover/motion/ground_pose.h"

#include "world/maths/cpu_dispatch.h"

#include <string.h>

#define LEAST_HALF_M 0.5 /* from the middle: nearer the slope of a post's edge says nothing */

/* Points under a body. */
enum { MIDDLE, FRONT, BACK, RIGHT, LEFT, POINTS };

void ground_pose_begin(struct ground_pose *stand)
{
    memset(stand, 0, sizeof *stand);
    for (int l = 0; l < LANE_COUNT; l++)
        stand->ground.patch[l] = &stand->idle, stand->kind[l] = KIND_NONE;
}

bool ground_pose_take(const struct step_context *move, struct ground_pose *stand, int l, uint32_t i)
{
    const struct entities *m = move->m;
    stand->ground.patch[l] = &move->patches[i];
    __builtin_prefetch(&move->patches[i + GROUND_POSE_AHEAD]);
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

static inline void find_points(const struct ground_pose *stand, union simd_lanes x[POINTS],
                               union simd_lanes z[POINTS])
{
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 px = stand->x.f64x4[h], pz = stand->z.f64x4[h];
        f64x4 length_x = stand->sine.f64x4[h] * stand->half_length.f64x4[h];
        f64x4 length_z = stand->cosine.f64x4[h] * stand->half_length.f64x4[h];
        f64x4 width_x = stand->cosine.f64x4[h] * stand->half_width.f64x4[h];
        f64x4 width_z = stand->sine.f64x4[h] * stand->half_width.f64x4[h];
        x[MIDDLE].f64x4[h] = px, z[MIDDLE].f64x4[h] = pz;
        x[FRONT].f64x4[h] = px + length_x, z[FRONT].f64x4[h] = pz - length_z;
        x[BACK].f64x4[h] = px - length_x, z[BACK].f64x4[h] = pz + length_z;
        x[RIGHT].f64x4[h] = px + width_x, z[RIGHT].f64x4[h] = pz + width_z;
        x[LEFT].f64x4[h] = px - width_x, z[LEFT].f64x4[h] = pz - width_z;
    }
}

static void dig(const struct step_context *move, const struct ground_pose *stand,
                const union simd_lanes x[POINTS], const union simd_lanes z[POINTS],
                union simd_lanes height[POINTS])
{
    for (int l = 0; l < LANE_COUNT; l++) {
        for (int p = 0; stand->scarred.lane[l] && p < POINTS; p++)
            height[p].lane[l] += crater_offset(move->craters, x[p].lane[l], z[p].lane[l]);
    }
}

VECTOR_CLONES
void ground_pose_pose(const struct step_context *move, struct ground_pose *stand)
{
    const struct terrain *terrain = &move->world->terrain;
    union simd_lanes x[POINTS], z[POINTS], height[POINTS], pitch_rise, pitch_run, roll_rise,
        roll_run;
    find_points(stand, x, z);
    for (int p = 0; p < POINTS; p++)
        terrain_cache_heights(terrain, &stand->ground, &x[p], &z[p], &height[p]);
    if (move->craters->count > 0)
        dig(move, stand, x, z, height);
    stand->y = height[MIDDLE];
    for (int h = 0; h < LANE_FOURS; h++) {
        pitch_rise.f64x4[h] = height[FRONT].f64x4[h] - height[BACK].f64x4[h];
        pitch_run.f64x4[h] = 2.0 * stand->half_length.f64x4[h];
        roll_rise.f64x4[h] = height[LEFT].f64x4[h] - height[RIGHT].f64x4[h];
        roll_run.f64x4[h] = 2.0 * stand->half_width.f64x4[h];
    }
    maths_slopes_lanes(&pitch_rise, &pitch_run, &stand->pitch);
    maths_slopes_lanes(&roll_rise, &roll_run, &stand->roll);
}
