/* Corners and undersides of vehicles that hold their course, against the ground. */
#include "world/course_lift.h"

#include "world/entity/hull.h"
#include "world/maths/rotation.h"
#include "world/world.h"

#include <stddef.h>

/* How a body stands on a ground. */
struct stance {
    const struct terrain *terrain;
    const struct crater_index *craters;
    struct vec3 at;
    struct mat3 turn;
};

/* The same body on its ground, and on that ground without works and craters. */
struct stances {
    struct stance uneven, bare;
};

static struct stance stance_of(const struct terrain *terrain, const struct crater_index *craters,
                               struct vec3 at, double heading_rad, const struct rest_pose *pose)
{
    return (struct stance){
        terrain,
        craters,
        {at.x, pose->y_m, at.z},
        rotation_matrix(rotation_of(heading_rad, pose->pitch_rad, pose->roll_rad))};
}

/* Returns how deep a point of the body is in the ground, below 0 for a height over it [m]. */
static double depth_of(const struct stance *stance, struct vec3 point)
{
    const struct vec3 p = vec3_add(stance->at, rotation_apply(&stance->turn, point));
    return terrain_height(stance->terrain, stance->craters, p.x, p.z) - p.y;
}

/* Returns how much deeper a point is in the ground than it would be without works and craters: five
 * heights bear a vehicle, so its corners are in a ground that bends, and on a slope that it crosses
 * slantwise. */
static double deepened(const struct stances *stances, struct vec3 point)
{
    double deep = depth_of(&stances->uneven, point);
    return deep > 0.0 ? deep - maths_max(0.0, depth_of(&stances->bare, point)) : 0.0;
}

static double most_of_corners(const struct stances *stances, const struct world *world,
                              const struct kind *kind)
{
    double most = 0.0;
    for (uint32_t h = 0; h < kind->hull_count; h++) {
        const struct hull *hull = &world->hulls[kind->first_hull + h];
        for (uint32_t n = 0; n < hull->vertex_count; n++)
            most = maths_max(most, deepened(stances, world->hull_vertices[hull->first_vertex + n]));
    }
    return most;
}

/* Corners do not see what is narrower than the vehicle. */
static double most_of_underside(const struct stances *stances, const struct kind *kind)
{
    double most = 0.0;
    for (int i = 0; i <= COURSE_LIFT_ALONG; i++) {
        for (int k = 0; k <= COURSE_LIFT_ACROSS; k++) {
            const struct vec3 point = {kind->length_m * ((double)i / COURSE_LIFT_ALONG - 0.5), 0.0,
                                       kind->width_m * ((double)k / COURSE_LIFT_ACROSS - 0.5)};
            most = maths_max(most, deepened(stances, point));
        }
    }
    return most;
}

double course_lift(const struct world *world, const struct crater_index *craters, uint16_t kind,
                   double at_x, double at_z, double heading_rad, const struct rest_pose *pose)
{
    const struct kind *own = &world->kinds[kind];
    const double reach_m = maths_max(own->bound_m, 0.5 * (own->length_m + own->width_m));
    if (!terrain_uneven_near(&world->terrain, craters, at_x, at_z, reach_m))
        return 0.0;
    const struct vec3 at = {at_x, 0.0, at_z};
    struct terrain bare = world->terrain;
    bare.earthworks.count = 0;
    const struct rest_pose bare_pose = rest_pose_of(&bare, NULL, own, at_x, at_z, heading_rad);
    const struct stances stances = {stance_of(&world->terrain, craters, at, heading_rad, pose),
                                    stance_of(&bare, NULL, at, heading_rad, &bare_pose)};
    return maths_max(most_of_corners(&stances, world, own), most_of_underside(&stances, own));
}

struct rest_pose course_lift_pose(const struct world *world, const struct crater_index *craters,
                                  uint16_t kind, double at_x, double at_z, double heading_rad)
{
    struct rest_pose pose =
        rest_pose_of(&world->terrain, craters, &world->kinds[kind], at_x, at_z, heading_rad);
    pose.y_m += course_lift(world, craters, kind, at_x, at_z, heading_rad, &pose);
    return pose;
}
