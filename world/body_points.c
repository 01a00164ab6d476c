/* Vertices of a kind's outer hull, or corners of its box, and their height over the ground. */
#include "world/body_points.h"

#include "world/entity/hull.h"
#include "world/entity/mass_properties.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/world.h"

static void take_hull(const struct world *world, const struct kind *kind,
                      struct body_points *points)
{
    const struct hull *hull = &world->hulls[kind->outer_hull];
    points->point = world->hull_vertices + hull->first_vertex;
    points->count = hull->vertex_count;
    points->reach_m = kind->bound_m;
}

static void take_box(const struct kind *kind, struct body_points *points)
{
    const struct vec3 half = {0.5 * kind->length_m, 0.5 * kind->height_m, 0.5 * kind->width_m};
    bool stands = kind->domain == DOMAIN_LAND || kind->domain == DOMAIN_FIXED;
    double centre = stands ? half.y : 0.0;
    for (unsigned i = 0; i < BODY_POINTS_BOX; i++) {
        points->box[i] =
            (struct vec3){i & 1u ? half.x : -half.x, centre + (i & 2u ? half.y : -half.y),
                          i & 4u ? half.z : -half.z};
    }
    points->point = points->box;
    points->count = BODY_POINTS_BOX;
    points->reach_m = centre + vec3_length(half);
}

void body_points_of(const struct world *world, uint16_t kind, struct body_points *points)
{
    if (world->params->collision.shape == SHAPE_MODEL)
        take_hull(world, &world->kinds[kind], points);
    else
        take_box(&world->kinds[kind], points);
}

double body_points_clearance(const struct world *world, const struct crater_index *craters,
                             const struct body_points *points, struct vec3 at, struct quat turn)
{
    struct mat3 axes = rotation_matrix(turn);
    double lowest = INFINITY;
    for (uint32_t i = 0; i < points->count; i++) {
        struct vec3 p = vec3_add(at, rotation_apply(&axes, points->point[i]));
        lowest = maths_min(lowest, p.y - terrain_height(&world->terrain, craters, p.x, p.z));
    }
    return lowest;
}
