/* What fixed objects leave on the ground when they fall, and the coding of fixed_damage. An entry
 * of fixed_damage is an enum damage, or FALLEN_FIRST and above: a tree or a pole with DAMAGE_HIGH
 * that fell in a known direction. Damage of DAMAGE_HIGH and above means in both codes that the
 * object has fallen; at DAMAGE_DESTROYED its debris is scattered too. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_FALLEN_H
#define JOLON_WORLD_TERRAIN_FALLEN_H

#include "world/entity/entity.h"
#include "world/terrain/fixed.h"

#include <stdbool.h>

struct debris;

#define FALLEN_FIRST 16u
#define FALLEN_STEPS 240u /* directions: every 1.5 degrees */

static inline enum damage fallen_damage(uint8_t stored)
{
    return stored >= FALLEN_FIRST ? DAMAGE_HIGH : (enum damage)stored;
}

/* Returns the direction in which it fell [rad, clockwise from north]. stored: FALLEN_FIRST or
 * above. */
static inline double fallen_heading(uint8_t stored)
{
    return (double)(stored - FALLEN_FIRST) * (TWO_PI / FALLEN_STEPS);
}

/* Returns true for what falls over in one piece: trees and poles. */
bool fallen_is_trunk(const struct kind *kind);

/* Returns the entry of fixed_damage for an object of the kind that falls in a direction on the map;
 * DAMAGE_HIGH for a kind that collapses where it stands. */
uint8_t fallen_towards(const struct kind *kind, double x, double z);

/* A place on the map: all that is within radius_m of a line. */
struct debris_area {
    double x, z;             /* [m] the line's middle */
    double along_x, along_z; /* its direction, unit */
    double half_length_m;    /* 0: a disc */
    double radius_m;
};

/* Returns where the debris of a fallen object lies if nobody pushes it: a trunk in the direction of
 * its fall from its foot, all else around its place. */
struct debris_area fallen_area(const struct fixed_object *object, const struct kind *kind,
                               uint8_t stored);

/* Returns where debris in the list lies. */
struct debris_area debris_area(const struct debris *debris);

/* Returns the point of the area's line that is nearest to a point. */
struct vec3 debris_area_nearest(const struct debris_area *area, double x, double z);
bool debris_area_holds(const struct debris_area *area, double x, double z);

/* Returns the object's entry in the list, or NULL. */
const struct debris *debris_find(const struct debris *list, uint32_t count, uint32_t object);

#endif
