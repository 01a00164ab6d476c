/* Where two convex bodies touch: faces on faces touch along a whole patch, of which the nearest
 * points that GJK finds are any two. Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_CONTACT_MANIFOLD_H
#define JOLON_COLLIDER_GEOMETRY_CONTACT_MANIFOLD_H

#include "collider/geometry/gjk.h"

#include <stdbool.h>
#include <stdint.h>

/* Vertices within this of the foremost take part, and may miss each other by it [m]: faces that
 * touch within the skin touch flat. */
#define CONTACT_MANIFOLD_SLACK_M 0.001

#define CONTACT_MANIFOLD_POINTS_MAX 256 /* of one body */
#define CONTACT_MANIFOLD_MAX        (2 * CONTACT_MANIFOLD_POINTS_MAX + 4)

/* A convex polygon across the normal, midway between the bodies; one or two corners for a point or
 * an edge. Positions like those of the bodies. */
struct contact_manifold {
    struct vec3 corner[CONTACT_MANIFOLD_MAX];
    uint32_t count;
    struct vec3 middle; /* of its border: of a point or an edge likewise */
};

/* The patch of bodies that touch, nearly, or overlap along a unit normal from a to b. False when
 * what is foremost of one is beside what is foremost of the other. */
bool contact_manifold_between(const struct convex *a, const struct convex *b, struct vec3 normal,
                              struct contact_manifold *patch);

#endif
