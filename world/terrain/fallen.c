/* Where the debris of fixed objects lies. */
#include "world/terrain/fallen.h"

#include "world/entity/debris.h"

#include <stddef.h>

/* Half the width of a trunk on the ground over that of its model. */
#define BRANCHES 0.25

bool fallen_is_trunk(const struct kind *kind)
{
    return kind->object_class == OBJECT_TREE || kind->object_class == OBJECT_POLE;
}

uint8_t fallen_towards(const struct kind *kind, double x, double z)
{
    if (!fallen_is_trunk(kind))
        return DAMAGE_HIGH;
    double steps = maths_wrap_turn(maths_heading(x, z)) * (FALLEN_STEPS / TWO_PI);
    return (uint8_t)(FALLEN_FIRST + (uint32_t)(steps + 0.5) % FALLEN_STEPS);
}

struct debris_area fallen_area(const struct fixed_object *object, const struct kind *kind,
                               uint8_t stored)
{
    if (stored < FALLEN_FIRST)
        return (struct debris_area){
            .x = object->x, .z = object->z, .along_z = -1.0, .radius_m = (double)object->radius_m};
    double sine, cosine, half = 0.5 * (double)object->height_m;
    maths_sincos(fallen_heading(stored), &sine, &cosine);
    return (struct debris_area){.x = object->x + half * sine,
                                .z = object->z - half * cosine,
                                .along_x = sine,
                                .along_z = -cosine,
                                .half_length_m = half,
                                .radius_m = BRANCHES * kind->width_m * fixed_scale(object, kind)};
}

struct debris_area debris_area(const struct debris *debris)
{
    double sine, cosine;
    maths_sincos((double)debris->heading_rad, &sine, &cosine);
    return (struct debris_area){.x = debris->x,
                                .z = debris->z,
                                .along_x = sine,
                                .along_z = -cosine,
                                .half_length_m = (double)debris->half_length_m,
                                .radius_m = (double)debris->radius_m};
}

struct vec3 debris_area_nearest(const struct debris_area *area, double x, double z)
{
    double along = (x - area->x) * area->along_x + (z - area->z) * area->along_z;
    along = maths_clamp(along, -area->half_length_m, area->half_length_m);
    return (struct vec3){area->x + along * area->along_x, 0.0, area->z + along * area->along_z};
}

bool debris_area_holds(const struct debris_area *area, double x, double z)
{
    struct vec3 near = debris_area_nearest(area, x, z);
    double dx = x - near.x, dz = z - near.z;
    return dx * dx + dz * dz < area->radius_m * area->radius_m;
}

const struct debris *debris_find(const struct debris *list, uint32_t count, uint32_t object)
{
    for (uint32_t i = 0; i < count; i++) {
        if (list[i].object == object)
            return &list[i];
    }
    return NULL;
}
