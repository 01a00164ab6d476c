/* Rays against polygons, and level 3 of Osborne 1991.
 *
 * The plane of each polygon is that of its first three corners and gives the distance, as in the
 * thesis. The thesis then projects polygon and point along the polygon's dominant axis. Here they
 * are projected along the ray, onto the plane across the ray's dominant axis through its start. The
 * answer is the same, but a corner shared by two polygons has the same coordinates for both. So by
 * Haines's rule for edges a ray through an edge of a closed model meets exactly one of its
 * polygons.
 *
 * How level 3 is read. "A ray shot from the center of the moving object towards the center of the
 * object it collided with" gives the possible point of collision "on the surface of the sphere":
 * ray 1, on the vehicle's sphere. "Due to the possibility that the actual object was not
 * penetrated", that point "is used as the origin of the second ray", in a "form of backward ray
 * tracing", and "if no intersection is found once all of the polygons have been checked, then only
 * the spheres were penetrated and not the objects themselves". So ray 2 runs from the sphere back
 * to the vehicle's centre. It meets the vehicle's own skin first, unless that lies beyond the
 * sphere, whose radius is slightly smaller than the vehicle. An object that the vehicle touches has
 * a polygon on the rest of the ray, and the polygon nearest to the vehicle's centre is the point of
 * collision. The positions of standing objects are on the ground, where a ray would meet nothing,
 * so the rays run at the height of the vehicle's middle. As in the thesis, two cases are missed:
 * objects that touch beside the line of their centres, and an object that contains the whole
 * ray. */
#include "collider/geometry/ray_polygon.h"

#include "collider/geometry/point_in_polygon.h"
#include "world/model.h"
#include "world/world.h"

/* A ray in a model's axes and unscaled units; times along it are metres of the world. */
struct beam {
    struct vec3 from, along;
    struct vec3 across; /* the dominant axis */
};

static struct vec3 dominant(struct vec3 v)
{
    double x = fabs(v.x), y = fabs(v.y), z = fabs(v.z);
    if (x >= y && x >= z)
        return (struct vec3){1.0, 0.0, 0.0};
    return y >= z ? (struct vec3){0.0, 1.0, 0.0} : (struct vec3){0.0, 0.0, 1.0};
}

static struct beam beam_of(const struct ray_polygon_model *model, struct vec3 from,
                           struct vec3 direction)
{
    struct beam beam;
    double unscale = 1.0 / model->scale;
    beam.from = vec3_scale(rotation_back(&model->turn, vec3_sub(from, model->at)), unscale);
    beam.along = vec3_scale(rotation_back(&model->turn, direction), unscale);
    beam.across = dominant(beam.along);
    return beam;
}

static void corners_of(const struct world *world, const struct model *model, uint32_t triangle,
                       struct vec3 corner[3])
{
    const struct model_triangle *t = &world->model_triangles[model->first_triangle + triangle];
    for (int i = 0; i < 3; i++) {
        const struct model_vertex *v = &world->model_vertices[model->first_vertex + t->vertex[i]];
        corner[i] = (struct vec3){(double)v->x, (double)v->y, (double)v->z};
    }
}

static struct vec3 normal_of(const struct vec3 corner[3])
{
    struct vec3 u = vec3_sub(corner[1], corner[0]), v = vec3_sub(corner[2], corner[0]);
    return (struct vec3){u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

/* Returns true if the beam goes through the polygon, as seen along the beam. */
static bool goes_through(const struct beam *beam, const struct vec3 corner[3])
{
    struct vec3 seen[3];
    double speed = vec3_dot(beam->along, beam->across);
    for (int i = 0; i < 3; i++) {
        double time = vec3_dot(vec3_sub(corner[i], beam->from), beam->across) / speed;
        seen[i] = vec3_sub(corner[i], vec3_scale(beam->along, time));
    }
    return point_in_polygon_inside(seen, 3, beam->across, beam->from);
}

bool ray_polygon_nearest(const struct ray_polygon_model *model, struct vec3 from,
                         struct vec3 direction, double most_m, struct ray_polygon_hit *hit)
{
    const struct model *shape = &model->world->models[model->model];
    struct beam beam = beam_of(model, from, direction);
    struct vec3 corner[3], normal = {0.0, 0.0, 0.0};
    double nearest = INFINITY;
    for (uint32_t i = 0; i < model_solid_triangles(shape); i++) {
        corners_of(model->world, shape, i, corner);
        struct vec3 n = normal_of(corner);
        double speed = vec3_dot(n, beam.along);
        double distance = vec3_dot(n, vec3_sub(corner[0], beam.from)) / speed;
        /* For a beam along the plane this is 0 / 0 or infinite, so the test is false. */
        if (!(distance >= 0.0 && distance <= most_m && distance < nearest) ||
            !goes_through(&beam, corner))
            continue;
        nearest = distance;
        normal = n;
        hit->triangle = i;
    }
    if (nearest == INFINITY)
        return false;
    hit->distance_m = nearest;
    hit->point = vec3_add(from, vec3_scale(direction, nearest));
    hit->normal = rotation_apply(&model->turn, vec3_scale(normal, 1.0 / vec3_length(normal)));
    return true;
}

bool ray_polygon_collision(const struct ray_polygon_model *vehicle, double vehicle_radius_m,
                           const struct ray_polygon_model *object, double object_radius_m,
                           struct ray_polygon_hit *hit)
{
    struct vec3 towards = vec3_sub(object->at, vehicle->at);
    double distance = vec3_length(towards), skin_m = vehicle_radius_m;
    struct ray_polygon_hit skin;
    if (distance >= vehicle_radius_m + object_radius_m)
        return false;
    /* Equal centres have no direction between them: take the forward axis. */
    towards = distance > 0.0 ? vec3_scale(towards, 1.0 / distance)
                             : rotation_apply(&vehicle->turn, (struct vec3){1.0, 0.0, 0.0});
    struct vec3 centre = vec3_add(vehicle->at, (struct vec3){0.0, vehicle->middle_m, 0.0});
    struct vec3 on_sphere = vec3_add(centre, vec3_scale(towards, vehicle_radius_m));
    if (ray_polygon_nearest(vehicle, on_sphere, vec3_scale(towards, -1.0), vehicle_radius_m, &skin))
        skin_m -= skin.distance_m;
    return ray_polygon_nearest(object, centre, towards, skin_m, hit);
}
