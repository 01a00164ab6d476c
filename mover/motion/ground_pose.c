/* Finds the heights under eight bodies at once. */
#include "mover/motion/ground_pose.h"

#include "world/maths/cpu_dispatch.h"
#include "world/world.h"

#include <string.h>

enum { MIDDLE, FRONT, BACK, RIGHT, LEFT, POINTS };

void ground_pose_begin(struct ground_pose *pose)
{
    memset(pose, 0, sizeof *pose);
    for (int l = 0; l < LANE_COUNT; l++)
        pose->ground.patch[l] = &pose->idle, pose->kind[l] = KIND_NONE;
}

bool ground_pose_take(const struct step_context *context, struct ground_pose *pose, int l,
                      uint32_t i)
{
    const struct entities *m = context->m;
    pose->ground.patch[l] = &context->terrain_entries[i];
    __builtin_prefetch(&context->terrain_entries[i + GROUND_POSE_AHEAD]);
    pose->x.lane[l] = m->row[i].x;
    pose->z.lane[l] = m->row[i].z;
    if (pose->kind[l] == m->row[i].kind)
        return false;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    pose->kind[l] = m->row[i].kind;
    pose->half_length.lane[l] = maths_max(kind->length_m * 0.5, KIND_STANCE_LEAST_M);
    pose->half_width.lane[l] = maths_max(kind->width_m * 0.5, KIND_STANCE_LEAST_M);
    return true;
}

static inline void find_points(const struct ground_pose *pose, union simd_lanes x[POINTS],
                               union simd_lanes z[POINTS])
{
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 px = pose->x.f64x4[h], pz = pose->z.f64x4[h];
        f64x4 length_x = pose->sine.f64x4[h] * pose->half_length.f64x4[h];
        f64x4 length_z = pose->cosine.f64x4[h] * pose->half_length.f64x4[h];
        f64x4 width_x = pose->cosine.f64x4[h] * pose->half_width.f64x4[h];
        f64x4 width_z = pose->sine.f64x4[h] * pose->half_width.f64x4[h];
        x[MIDDLE].f64x4[h] = px, z[MIDDLE].f64x4[h] = pz;
        x[FRONT].f64x4[h] = px + length_x, z[FRONT].f64x4[h] = pz - length_z;
        x[BACK].f64x4[h] = px - length_x, z[BACK].f64x4[h] = pz + length_z;
        x[RIGHT].f64x4[h] = px + width_x, z[RIGHT].f64x4[h] = pz + width_z;
        x[LEFT].f64x4[h] = px - width_x, z[LEFT].f64x4[h] = pz - width_z;
    }
}

static void dig(const struct step_context *context, struct ground_pose *pose,
                const union simd_lanes x[POINTS], const union simd_lanes z[POINTS],
                union simd_lanes height[POINTS])
{
    for (int l = 0; l < LANE_COUNT; l++) {
        double low = 0.0, high = 0.0;
        for (int p = 0; pose->cratered.lane[l] && p < POINTS; p++) {
            double dug = crater_offset(context->craters, x[p].lane[l], z[p].lane[l]);
            height[p].lane[l] += dug;
            low = p == 0 ? dug : maths_min(low, dug);
            high = p == 0 ? dug : maths_max(high, dug);
        }
        pose->step.lane[l] = high - low;
    }
}

/* Earthworks are rough where they bend under a body. */
static void find_bends(const struct step_context *context, struct ground_pose *pose,
                       const union simd_lanes x[POINTS], const union simd_lanes z[POINTS])
{
    const struct earthworks *works = &context->world->terrain.earthworks;
    for (int l = 0; l < LANE_COUNT; l++) {
        double offset[POINTS];
        if (context->craters->count == 0) /* nothing was dug */
            pose->step.lane[l] = 0.0;
        for (int p = 0; pose->cratered.lane[l] && p < POINTS; p++)
            offset[p] = earthwork_offset(works, x[p].lane[l], z[p].lane[l]);
        if (!pose->cratered.lane[l])
            continue;
        double along = offset[FRONT] + offset[BACK] - 2.0 * offset[MIDDLE];
        double across = offset[RIGHT] + offset[LEFT] - 2.0 * offset[MIDDLE];
        pose->step.lane[l] = maths_max(pose->step.lane[l], maths_max(fabs(along), fabs(across)));
    }
}

static void lift(const struct step_context *context, struct ground_pose *pose)
{
    for (int l = 0; l < LANE_COUNT; l++) {
        const struct crater_footing footing = {.x = pose->x.lane[l],
                                               .z = pose->z.lane[l],
                                               .half_length = pose->half_length.lane[l],
                                               .half_width = pose->half_width.lane[l],
                                               .sine = pose->sine.lane[l],
                                               .cosine = pose->cosine.lane[l]};
        pose->lift.lane[l] = pose->cratered.lane[l] ? terrain_lift(&context->world->terrain,
                                                                   context->craters, &footing)
                                                    : 0.0;
        pose->y.lane[l] += pose->lift.lane[l];
    }
}

VECTOR_CLONES
void ground_pose_find(const struct step_context *context, struct ground_pose *pose)
{
    const struct terrain *terrain = &context->world->terrain;
    union simd_lanes x[POINTS], z[POINTS], height[POINTS], pitch_rise, pitch_run, roll_rise,
        roll_run;
    find_points(pose, x, z);
    for (int p = 0; p < POINTS; p++)
        terrain_cache_heights(terrain, &pose->ground, &x[p], &z[p], &height[p]);
    if (context->craters->count > 0)
        dig(context, pose, x, z, height);
    if (terrain->earthworks.count > 0)
        find_bends(context, pose, x, z);
    pose->y = height[MIDDLE];
    if (context->craters->count > 0 || terrain->earthworks.count > 0)
        lift(context, pose);
    for (int h = 0; h < LANE_FOURS; h++) {
        f64x4 rise = height[FRONT].f64x4[h] - height[BACK].f64x4[h];
        f64x4 run = 2.0 * pose->half_length.f64x4[h];
        pitch_rise.f64x4[h] = rise;
        pitch_run.f64x4[h] = run;
        roll_rise.f64x4[h] = (height[LEFT].f64x4[h] - height[RIGHT].f64x4[h]) * run;
        roll_run.f64x4[h] = run * run + rise * rise;
    }
    for (int l = 0; l < LANE_COUNT; l++)
        roll_run.lane[l] = sqrt(roll_run.lane[l]);
    for (int h = 0; h < LANE_FOURS; h++)
        roll_run.f64x4[h] *= 2.0 * pose->half_width.f64x4[h];
    maths_slopes_lanes(&pitch_rise, &pitch_run, &pose->pitch);
    maths_slopes_lanes(&roll_rise, &roll_run, &pose->roll);
}
