/* The position, or the vertices of the outer hull, against the ground. */
#include "collider/motion/ground_impact.h"

#include "world/body_points.h"
#include "world/entity/kind.h"
#include "world/entity/remote.h"
#include "world/world.h"

static bool reaches(const struct method_input *input, const struct path *path, uint32_t row)
{
    struct path lowered = *path;
    double toi;
    lowered.at.y -= ground_impact_lower(pair_filter_row_reach(input, row));
    return pair_filter_ground(input, &lowered, &toi);
}

/* Returns the path of a point of the body that is here before and there at the frame's end,
 * relative to the position. */
static struct path path_of(const struct path *path, struct vec3 before, struct vec3 after)
{
    double left = 1.0 - path->since;
    struct path point = *path;
    point.at = vec3_add(path->at, before);
    if (left > 0.0)
        point.along = vec3_add(path->along, vec3_scale(vec3_sub(after, before), 1.0 / left));
    return point;
}

static bool vertices_meet(const struct method_input *input, const struct body_motion *motion,
                          uint32_t row, double *toi)
{
    const struct path *path = &input->path[row];
    struct mat3 from = rotation_matrix(body_motion_orientation(motion, row, path->since));
    struct mat3 to = rotation_matrix(body_motion_orientation(motion, row, 1.0));
    struct body_points points;
    bool meets = false;
    body_points_of(input->world, input->entities->kind[row], &points);
    for (uint32_t i = 0; i < points.count; i++) {
        const struct path point = path_of(path, rotation_apply(&from, points.point[i]),
                                          rotation_apply(&to, points.point[i]));
        double when;
        if (pair_filter_ground(input, &point, &when) && (!meets || when < *toi)) {
            *toi = when;
            meets = true;
        }
    }
    return meets;
}

bool ground_impact_row(const struct method_input *input, const struct body_motion *motion,
                       uint32_t row, double *toi)
{
    if (remote_is(input->entities, row))
        return false; /* its owner knows where it touches down */
    if (!motion->models || input->entities->behaviour[row] == BEHAVIOUR_FLIGHT)
        return pair_filter_ground(input, &input->path[row], toi);
    return reaches(input, &input->path[row], row) && vertices_meet(input, motion, row, toi);
}
