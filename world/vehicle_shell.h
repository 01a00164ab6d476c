/* The shell of a land vehicle on its springs: the points that the ground may touch besides its
 * wheels (docs/decisions/035-chassis.md). The mover lets the ground act on them, and the collider
 * pushes none of them into it. Pure; any thread. */
#ifndef JOLON_WORLD_VEHICLE_SHELL_H
#define JOLON_WORLD_VEHICLE_SHELL_H

#include "world/maths/rotation.h"

#include <stdint.h>

struct crater_index;
struct kind;
struct terrain;

/* Four points each of the underside, of the ends, of the sides beside the outer wheels, in the
 * middle of underside and ends, and of the roof. */
#define VEHICLE_SHELL_POINTS 20u
#define VEHICLE_SHELL_ENDS   8u  /* the first points are those of the underside and of the ends */
#define VEHICLE_SHELL_SIDES  12u /* and those of the sides */
#define VEHICLE_SHELL_MIDDLE 12u /* the four of the middle, which have no left and right */

#define VEHICLE_SHELL_BOW      0.21 /* length of the end of a track over the vehicle's */
#define VEHICLE_SHELL_BOW_RISE 0.7  /* tangent of its slope */

/* Returns the height of the steps that wheels or tracks climb [m]. Higher ones stand against the
 * shell. */
double vehicle_shell_climbs(const struct kind *kind);

/* Returns point n of the shell of a kind [m, body axes]. */
struct vec3 vehicle_shell_point(const struct kind *kind, uint32_t n);

/* Returns a distance from the position that no point of shell and wheels passes [m]. */
double vehicle_shell_reach(const struct kind *kind);

/* Returns how deep the deepest of the first points is in the ground [m], below 0 for a height over
 * it. craters: those that may be under the body, or NULL; at: the position. */
double vehicle_shell_depth(const struct terrain *terrain, const struct crater_index *craters,
                           const struct kind *kind, uint32_t points, struct vec3 at,
                           const struct mat3 *turn);

#endif
