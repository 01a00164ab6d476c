/* Rays against polygon models, and the thesis's two rays (Osborne 1991, pp. 24-26). Pure; any
 * thread.
 */
#ifndef JOLON_COLLIDER_GEOMETRY_RAY_POLYGON_H
#define JOLON_COLLIDER_GEOMETRY_RAY_POLYGON_H

#include "world/maths/maths.h"
#include "world/maths/rotation.h"

#include <stdbool.h>
#include <stdint.h>

struct world;

/* A model in place. */
struct ray_polygon_model {
    const struct world *world;
    uint32_t model; /* index into world->models */
    double scale;
    struct mat3 turn;
    struct vec3 at;  /* [m, world] */
    double middle_m; /* height of its middle above that */
};

struct ray_polygon_hit {
    double distance_m;  /* from the ray's start */
    struct vec3 point;  /* [m, world] */
    struct vec3 normal; /* unit, world: the polygon's, out of the model */
    uint32_t triangle;  /* within the model */
};

/* Finds the nearest polygon that the ray from a point along a unit direction meets within most_m:
 * first its plane, from its first three corners, then Haines's test. From inside a model the ray
 * meets a polygon's back. Of equally near polygons the first of the model is taken. No ray slips
 * through between two polygons that share an edge. Returns false if there is none. */
bool ray_polygon_nearest(const struct ray_polygon_model *model, struct vec3 from,
                         struct vec3 direction, double most_m, struct ray_polygon_hit *hit);

/* Level 3 of the thesis. Ray 1 from the vehicle's centre to the object's, at the height of the
 * vehicle's middle, gives the point where it leaves the vehicle's sphere. Ray 2 from there back to
 * the centre tells by the polygons whether and where the objects touch. The hit is on a polygon of
 * the object; its distance is from the vehicle's centre. The .c file explains this reading of the
 * thesis. */
bool ray_polygon_collision(const struct ray_polygon_model *vehicle, double vehicle_radius_m,
                           const struct ray_polygon_model *object, double object_radius_m,
                           struct ray_polygon_hit *hit);

#endif
