/* Points of a shell by the measures of its kind, and their depth in the ground. */
#include "world/vehicle_shell.h"

#include "world/entity/kind.h"
#include "world/terrain/terrain.h"

#define BELLY_TRACKS 0.22 /* half length of the underside over the length: on tracks */
#define BELLY_WHEELS 0.15 /* on wheels */
#define SIDE_TRACKS  0.29 /* the same of the outer wheels beside which the sides have points */
#define SIDE_WHEELS  0.34
#define SIDE_HEIGHT                                                                                \
    0.6 /* of the sides of tracks over the step that they climb: edges get under them */
#define CLEARANCE   0.75 /* of the underside on wheels, at least, over the step that they climb */
#define NOSE_HEIGHT 0.45 /* of the ends over the height */

double vehicle_shell_climbs(const struct kind *kind)
{
    const double bow = VEHICLE_SHELL_BOW_RISE * VEHICLE_SHELL_BOW * kind->length_m;
    return kind->tracked ? maths_min(kind->step_m, bow) : kind->step_m;
}

struct vec3 vehicle_shell_point(const struct kind *kind, uint32_t n)
{
    const double half = 0.5 * kind->length_m, nose = NOSE_HEIGHT * kind->height_m;
    const double climbs = vehicle_shell_climbs(kind);
    const double belly = kind->length_m * (kind->tracked ? BELLY_TRACKS : BELLY_WHEELS);
    const double side = kind->length_m * (kind->tracked ? SIDE_TRACKS : SIDE_WHEELS);
    const double under = maths_max(kind->travel_m, kind->tracked ? 0.0 : CLEARANCE * climbs);
    const double ends = maths_max(kind->travel_m, kind->tracked ? maths_min(nose, climbs) : nose);
    const struct vec3 corner[5] = {
        {belly, under, 0.0},
        {half, ends, 0.0},
        {side, maths_max(under, kind->tracked ? SIDE_HEIGHT * climbs : climbs), 0.0},
        {n & 2 ? half : belly, n & 2 ? ends : under, 0.0},
        {half, kind->height_m, 0.0}};
    const struct vec3 at = corner[n / 4];
    const double wide = n / 4 == VEHICLE_SHELL_MIDDLE / 4 ? 0.0 : 0.5 * kind->width_m;
    return (struct vec3){n & 1 ? at.x : -at.x, at.y, n & 2 ? wide : -wide};
}

double vehicle_shell_reach(const struct kind *kind)
{
    return 0.5 * (kind->length_m + kind->width_m) + kind->height_m;
}

double vehicle_shell_depth(const struct terrain *terrain, const struct crater_index *craters,
                           const struct kind *kind, uint32_t points, struct vec3 at,
                           const struct mat3 *turn)
{
    double deepest = -INFINITY;
    for (uint32_t n = 0; n < points; n++) {
        struct vec3 point = vec3_add(at, rotation_apply(turn, vehicle_shell_point(kind, n)));
        double ground = terrain_height(terrain, craters, point.x, point.z);
        deepest = maths_max(deepest, ground - point.y);
    }
    return deepest;
}
