/* Drag areas are shares of the sides of the kind's box. */
#include "world/entity/wreck_drag.h"

#include "world/entity/mass_properties.h"

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

/* A side of a box that turns at w about the axis through its middle along the side: at r from the
 * axis it goes through the air at w r. Returns the torque over w^2 [N m s2]: one half of the side
 * faces the air, and of the opposite side the other half. */
static double swept_torque(double c, double along_m, double across_m)
{
    double square = across_m * across_m;
    return SEA_DENSITY_KGPM3 * c * along_m * square * square / 64.0;
}

static double slowed(double rate_rps, double torque, double moment, double dt_s)
{
    return rate_rps / (1.0 + torque / moment * fabs(rate_rps) * dt_s);
}

struct vec3 wreck_drag_slow_spin(const struct kind *kind, const struct mat3 *turn, struct vec3 spin,
                                 double dt_s)
{
    const struct shape *shape = shape_of(kind);
    const struct vec3 moment = mass_properties_of(kind).moment;
    double length = kind->length_m, height = kind->height_m, width = kind->width_m;
    const struct vec3 torque = {
        swept_torque(shape->top, length, width) + swept_torque(shape->side, length, height),
        swept_torque(shape->side, height, length) + swept_torque(shape->end, height, width),
        swept_torque(shape->top, width, length) + swept_torque(shape->end, width, height)};
    struct vec3 rate = rotation_back(turn, spin);
    rate.x = slowed(rate.x, torque.x, moment.x, dt_s);
    rate.y = slowed(rate.y, torque.y, moment.y, dt_s);
    rate.z = slowed(rate.z, torque.z, moment.z, dt_s);
    return rotation_apply(turn, rate);
}
