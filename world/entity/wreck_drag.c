/* Drag areas are shares of the sides of the kind's box. */
#include "world/entity/wreck_drag.h"

#define SEA_DENSITY_KGPM3 1.225

/* Drag coefficients by the area of the box's end, top and side. A box has 1.05 (Hoerner,
 * Fluid-Dynamic Drag, 1965). An aircraft fills a small part of its box: one like an F-4 has about
 * 1, 90 and 30 m2, one like a UH-60 3, 30 and 25 m2. */
struct shape {
    double end, top, side;
};

static const struct shape blunt = {1.05, 1.05, 1.05};
static const struct shape winged = {0.03, 0.55, 0.5};
static const struct shape rotor_craft = {0.05, 0.15, 0.35};

static const struct shape *shape_of(const struct kind *kind)
{
    if (kind->domain != DOMAIN_AIR)
        return &blunt;
    return kind_hovers(kind) ? &rotor_craft : &winged;
}

struct vec3 wreck_drag_slow(const struct kind *kind, const struct mat3 *turn, struct vec3 velocity,
                            double dt_s)
{
    const struct shape *shape = shape_of(kind);
    const struct vec3 wind = rotation_back(turn, velocity); /* x forward, y up, z right */
    /* The projected area of a box times the speed [m3/s]. */
    double swept = shape->end * kind->width_m * kind->height_m * fabs(wind.x) +
                   shape->top * kind->length_m * kind->width_m * fabs(wind.y) +
                   shape->side * kind->length_m * kind->height_m * fabs(wind.z);
    double rate = 0.5 * SEA_DENSITY_KGPM3 * swept / kind->mass_kg;
    return vec3_scale(velocity, 1.0 / (1.0 + rate * dt_s));
}
