/* The position, or the points of the body, against the ground. */
#include "collider/motion/ground_impact.h"

#include "world/body_points.h"
#include "world/entity/kind.h"
#include "world/entity/remote.h"
#include "world/world.h"

/* A path that is lowered by so many reaches of a body reaches the ground if any point of it may, on
 * slopes up to 60 degrees. */
#define LOWER 2.0

static bool reaches(const struct method_input *input, const struct path *path, double reach_m)
{
    struct path lowered = *path;
    double toi;
    lowered.at.y -= LOWER * reach_m;
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

static bool points_meet(const struct method_input *input, const struct body_motion *motion,
                        uint32_t row, const struct body_points *points, double *toi)
{
    const struct path *path = &input->path[row];
    struct mat3 from = rotation_matrix(body_motion_orientation(motion, row, path->since));
    struct mat3 to = rotation_matrix(body_motion_orientation(motion, row, 1.0));
    bool meets = false;
    for (uint32_t i = 0; i < points->count; i++) {
        const struct path point = path_of(path, rotation_apply(&from, points->point[i]),
                                          rotation_apply(&to, points->point[i]));
        double when;
        if (pair_filter_ground(input, &point, &when) && (!meets || when < *toi)) {
            *toi = when;
            meets = true;
        }
    }
    return meets;
}

double ground_impact_lower(const struct world *world, uint16_t kind)
{
    struct body_points points;
    body_points_of(world, kind, &points);
    return LOWER * points.reach_m;
}

bool ground_impact_row(const struct method_input *input, const struct body_motion *motion,
                       uint32_t row, double *toi)
{
    struct body_points points;
    if (remote_is(input->entities, row))
        return false; /* its owner knows where it touches down */
    if (input->entities->row[row].behaviour == BEHAVIOUR_FLIGHT)
        return pair_filter_ground(input, &input->path[row], toi);
    body_points_of(input->world, input->entities->row[row].kind, &points);
    return reaches(input, &input->path[row], points.reach_m) &&
           points_meet(input, motion, row, &points, toi);
}
