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
    return (struct rest_pose){.y_m = terrain_height(terrain, craters, x, z) +
                                     terrain_lift(terrain, craters, &footing),
                              .pitch_rad = maths_atan2(front - back, 2.0 * length),
                              .roll_rad = maths_atan2(left - right, 2.0 * width)};
}
