/* Point in polygon by Haines's crossings (Haines in Glassner 1989, as Osborne 1991, p. 26 and Fig.
 * 6 use it). Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_POINT_IN_POLYGON_H
#define JOLON_COLLIDER_GEOMETRY_POINT_IN_POLYGON_H

#include "world/maths/maths.h"

#include <stdbool.h>
#include <stdint.h>

/* Returns true if the point, which lies in the polygon's plane, is inside it. The polygon (count >=
 * 3 corners, any simple shape, either orientation) and the point are projected along the normal's
 * largest component (x before y before z if equal). A point on an edge is always on the same side
 * of it: it is in exactly one of two polygons that share the edge and the axis, to the last bit. */
bool point_in_polygon_inside(const struct vec3 *corner, uint32_t count, struct vec3 normal,
                             struct vec3 point);

#endif
