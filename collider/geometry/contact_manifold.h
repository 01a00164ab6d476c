/* Contact manifold: where two convex bodies touch. Faces touch in a polygon, in which the nearest
 * points that GJK finds are arbitrary. Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_CONTACT_MANIFOLD_H
#define JOLON_COLLIDER_GEOMETRY_CONTACT_MANIFOLD_H

#include "collider/geometry/gjk.h"

#include <stdbool.h>
#include <stdint.h>

/* Vertices within this distance of the foremost belong to the manifold, and outlines may miss each
 * other by it [m]: faces that touch within the skin touch flat. */
#define CONTACT_MANIFOLD_SLACK_M 0.001

#define CONTACT_MANIFOLD_POINTS_MAX 256 /* of one body */
#define CONTACT_MANIFOLD_MAX        (2 * CONTACT_MANIFOLD_POINTS_MAX + 4)

/* A convex polygon across the normal, midway between the bodies; one or two corners for a point or
 * an edge. Coordinates like those of the bodies. */
struct contact_manifold {
    struct vec3 corner[CONTACT_MANIFOLD_MAX];
    uint32_t count;
    struct vec3 middle; /* centroid of the border; of a point or an edge the middle */
};

/* Computes the manifold of two bodies that touch, nearly touch or overlap along a unit normal from
 * a to b. Returns false if the foremost parts of the two lie beside each other. */
bool contact_manifold_between(const struct convex *a, const struct convex *b, struct vec3 normal,
                              struct contact_manifold *patch);

/* The same with the vertices within slack_m [m, >= 0] of the foremost ones of each body. */
bool contact_manifold_within(const struct convex *a, const struct convex *b, struct vec3 normal,
                             double slack_m, struct contact_manifold *patch);

#endif
