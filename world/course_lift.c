/* Corners and undersides of vehicles that hold their course, against the ground. */
#include "world/course_lift.h"

#include "world/entity/hull.h"
#include "world/maths/rotation.h"
#include "world/world.h"

struct stance {
    const struct world *world;
    const struct crater_index *craters;
    struct vec3 at;
    struct mat3 turn;
};

/* Returns how deep a point of the body is in the ground, below 0 for a height over it [m]. */
static double depth_of(const struct stance *stance, struct vec3 point)
{
    const struct vec3 p = vec3_add(stance->at, rotation_apply(&stance->turn, point));
    return terrain_height(&stance->world->terrain, stance->craters, p.x, p.z) - p.y;
}

static double deepest_corner(const struct stance *stance, const struct kind *kind)
{
    const struct world *world = stance->world;
    double deepest = 0.0;
    for (uint32_t h = 0; h < kind->hull_count; h++) {
        const struct hull *hull = &world->hulls[kind->first_hull + h];
        for (uint32_t n = 0; n < hull->vertex_count; n++)
            deepest =
                maths_max(deepest, depth_of(stance, world->hull_vertices[hull->first_vertex + n]));
    }
    return deepest;
}

/* Corners do not see what is narrower than the vehicle. */
static double deepest_underside(const struct stance *stance, const struct kind *kind)
{
    double deepest = 0.0;
    for (int i = 0; i <= COURSE_LIFT_ALONG; i++) {
        for (int k = 0; k <= COURSE_LIFT_ACROSS; k++) {
            const struct vec3 point = {kind->length_m * ((double)i / COURSE_LIFT_ALONG - 0.5), 0.0,
                                       kind->width_m * ((double)k / COURSE_LIFT_ACROSS - 0.5)};
            deepest = maths_max(deepest, depth_of(stance, point));
        }
    }
    return deepest;
}

double course_lift(const struct world *world, const struct crater_index *craters, uint16_t kind,
                   double at_x, double at_z, double heading_rad, const struct rest_pose *pose)
{
    const struct kind *own = &world->kinds[kind];
    const double reach_m = maths_max(own->bound_m, 0.5 * (own->length_m + own->width_m));
    if (!terrain_uneven_near(&world->terrain, craters, at_x, at_z, reach_m))
        return 0.0;
    const struct stance stance = {
        world,
        craters,
        {at_x, pose->y_m, at_z},
        rotation_matrix(rotation_of(heading_rad, pose->pitch_rad, pose->roll_rad))};
    return maths_max(deepest_corner(&stance, own), deepest_underside(&stance, own));
}

struct rest_pose course_lift_pose(const struct world *world, const struct crater_index *craters,
                                  uint16_t kind, double at_x, double at_z, double heading_rad)
{
    struct rest_pose pose =
        rest_pose_of(&world->terrain, craters, &world->kinds[kind], at_x, at_z, heading_rad);
    pose.y_m += course_lift(world, craters, kind, at_x, at_z, heading_rad, &pose);
    return pose;
}
