/* Fixed objects: trees, bushes, poles, buildings (Table 1), in gridsquare order. Each square also
 * has the list of all objects that overlap it, those of neighbouring squares included, so that none
 * near a border is found late (thesis row 37). Written once at creation, read-only to all. */
#ifndef JOLON_WORLD_TERRAIN_FIXED_H
#define JOLON_WORLD_TERRAIN_FIXED_H

#include "world/entity/kind.h"
#include "world/maths/maths.h"

#include <stdint.h>

struct fixed_object {
    double x, z;    /* [m] */
    float y;        /* [m] of the ground it stands on; centre of its bounding sphere */
    float radius_m; /* of the bounding sphere */
    float height_m; /* for drawing */
    uint16_t kind;
    uint16_t turn; /* heading, 65536 for a full turn, for drawing */
};

_Static_assert(sizeof(struct fixed_object) == 32, "shared layout");

/* Return its position [m, world], its heading [rad], and its size relative to its kind's, which is
 * kinds[object->kind] of the world. */
static inline struct vec3 fixed_position(const struct fixed_object *object)
{
    return (struct vec3){object->x, (double)object->y, object->z};
}

static inline double fixed_heading(const struct fixed_object *object)
{
    return (double)object->turn * (TWO_PI / 65536.0);
}

static inline double fixed_scale(const struct fixed_object *object, const struct kind *kind)
{
    return (double)object->radius_m / kind->radius_m;
}

#endif
