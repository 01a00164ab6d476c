/* How far the vertices of a hull reach in a direction, four at a time where the processor has
 * vectors of four. Each reach has the bits of vec3_dot(). Pure; any thread. */
#ifndef JOLON_COLLIDER_GEOMETRY_VERTEX_REACH_H
#define JOLON_COLLIDER_GEOMETRY_VERTEX_REACH_H

#include "world/maths/maths.h"

#include <stdint.h>

/* Returns the first of count >= 1 vertices that reaches farthest in the direction. */
uint32_t vertex_reach_first(const struct vec3 *vertex, uint32_t count, struct vec3 direction);

/* The same; reach becomes how far each vertex reaches [count]. */
uint32_t vertex_reach_each(const struct vec3 *vertex, uint32_t count, struct vec3 direction,
                           double *reach);

/* Returns how far the vertices reach. */
double vertex_reach_most(const struct vec3 *vertex, uint32_t count, struct vec3 direction);

#endif
