/* A kind's box: its moments, and their inverse on world axes. */
#include "world/entity/mass_properties.h"

#include <stdbool.h>

static double square(double value)
{
    return value * value;
}

static double centre_of(const struct kind *kind)
{
    if (kind->domain == DOMAIN_LAND && kind->centre_height_m > 0.0)
        return kind->centre_height_m;
    return kind->domain == DOMAIN_LAND || kind->domain == DOMAIN_FIXED ? 0.5 * kind->height_m : 0.0;
}

struct mass_properties mass_properties_of(const struct kind *kind)
{
    double length2 = square(kind->length_m), height2 = square(kind->height_m);
    double width2 = square(kind->width_m), twelfth = kind->mass_kg / 12.0;
    return (struct mass_properties){
        .mass_kg = kind->mass_kg,
        .moment = {twelfth * (height2 + width2), twelfth * (length2 + width2),
                   twelfth * (length2 + height2)},
        .centre_m = centre_of(kind),
    };
}

struct mat3 mass_properties_inverse_world(const struct mass_properties *properties,
                                          const struct mat3 *turn)
{
    const double inverse[3] = {1.0 / properties->moment.x, 1.0 / properties->moment.y,
                               1.0 / properties->moment.z};
    struct mat3 world;
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column <= row; column++) {
            double sum = 0.0;
            for (int axis = 0; axis < 3; axis++)
                sum += turn->m[row][axis] * turn->m[column][axis] * inverse[axis];
            world.m[row][column] = world.m[column][row] = sum;
        }
    }
    return world;
}
