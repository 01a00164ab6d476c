/* Five heights under a body. */
#include "world/terrain/rest_pose.h"

#include "world/maths/maths.h"

struct rest_pose rest_pose_of(const struct terrain *terrain, const struct crater_index *craters,
                              const struct kind *kind, double x, double z, double heading_rad)
{
    double sine, cosine;
    double length = maths_max(kind->length_m * 0.5, KIND_STANCE_LEAST_M);
    double width = maths_max(kind->width_m * 0.5, KIND_STANCE_LEAST_M);
    maths_sincos(heading_rad, &sine, &cosine);
    double front = terrain_height(terrain, craters, x + sine * length, z - cosine * length);
    double back = terrain_height(terrain, craters, x - sine * length, z + cosine * length);
    double right = terrain_height(terrain, craters, x + cosine * width, z + sine * width);
    double left = terrain_height(terrain, craters, x - cosine * width, z - sine * width);
    const struct crater_footing footing = {x, z, length, width, sine, cosine};
    const double rise = front - back, run = 2.0 * length;
    return (struct rest_pose){
        .y_m = terrain_height(terrain, craters, x, z) + terrain_lift(terrain, craters, &footing),
        .pitch_rad = maths_atan2(rise, run),
        .roll_rad = maths_atan2((left - right) * run, 2.0 * width * sqrt(run * run + rise * rise))};
}

#define ALONG  8 /* parts in which the length and the width are looked at, even numbers */
#define ACROSS 6

static double work_at(const struct terrain *terrain, const struct crater_footing *footing,
                      double along, double across)
{
    double x, z;
    crater_footing_point(footing, along, across, &x, &z);
    return earthwork_offset(&terrain->earthworks, x, z);
}

bool rest_pose_bends(const struct terrain *terrain, const struct kind *kind, double x, double z,
                     double heading_rad, double *clear_y_m)
{
    struct crater_footing footing = {.x = x, .z = z};
    double bend = 0.0;
    if (terrain->earthworks.count == 0)
        return false;
    footing.half_length = maths_max(kind->length_m * 0.5, KIND_STANCE_LEAST_M);
    footing.half_width = maths_max(kind->width_m * 0.5, KIND_STANCE_LEAST_M);
    maths_sincos(heading_rad, &footing.sine, &footing.cosine);
    const double middle = work_at(terrain, &footing, 0.0, 0.0);
    const double pitch =
        0.5 * (work_at(terrain, &footing, 1.0, 0.0) - work_at(terrain, &footing, -1.0, 0.0));
    const double roll =
        0.5 * (work_at(terrain, &footing, 0.0, 1.0) - work_at(terrain, &footing, 0.0, -1.0));
    *clear_y_m = -HUGE_VAL;
    for (int i = -ALONG / 2; i <= ALONG / 2; i++) {
        for (int k = -ACROSS / 2; k <= ACROSS / 2; k++) {
            double along = 2.0 * i / ALONG, across = 2.0 * k / ACROSS, px, pz;
            crater_footing_point(&footing, along, across, &px, &pz);
            double work = earthwork_offset(&terrain->earthworks, px, pz);
            bend = maths_max(bend, fabs(work - middle - along * pitch - across * roll));
            *clear_y_m = maths_max(*clear_y_m, terrain_base_height(terrain, px, pz));
        }
    }
    return bend > REST_POSE_BEND_M;
}
