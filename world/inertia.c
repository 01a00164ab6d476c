/* A kind's box: its moments, and their inverse on world axes. */
#include "world/inertia.h"

#include <stdbool.h>

static double square(double value)
{
    return value * value;
}

struct inertia inertia_of(const struct kind *kind)
{
    double length2 = square(kind->length_m), height2 = square(kind->height_m);
    double width2 = square(kind->width_m), twelfth = kind->mass_kg / 12.0;
    bool stands = kind->domain == DOMAIN_LAND || kind->domain == DOMAIN_FIXED;
    return (struct inertia){
        .mass_kg = kind->mass_kg,
        .moment = {twelfth * (height2 + width2), twelfth * (length2 + width2),
                   twelfth * (length2 + height2)},
        .centre_m = stands ? 0.5 * kind->height_m : 0.0,
    };
}

struct mat3 inertia_inverse_world(const struct inertia *inertia, const struct mat3 *turn)
{
    const double inverse[3] = {1.0 / inertia->moment.x, 1.0 / inertia->moment.y,
                               1.0 / inertia->moment.z};
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
