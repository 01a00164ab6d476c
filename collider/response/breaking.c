/* What breaking costs a vehicle, in closed form. */
#include "collider/response/breaking.h"

#include "world/maths/maths.h"

struct breaking breaking_of(const struct breaking_input *input)
{
    double striker = input->striker_kg, both = striker + input->debris_kg;
    double energy = 0.5 * striker * input->closing_mps * input->closing_mps;
    double left = energy - input->strength_j;
    if (left < 0.0)
        return (struct breaking){.breaks = false};
    double through = maths_min(input->closing_mps, sqrt(2.0 * left / striker));
    double common = through * (striker / both);
    return (struct breaking){
        .breaks = true,
        .speed_mps = common,
        .impulse_ns = striker * (input->closing_mps - common),
        .lost_j = input->strength_j + left * (input->debris_kg / both),
    };
}

static double rod_kg(const struct kind *object, double height_m)
{
    double off = maths_clamp(height_m / object->height_m, 0.0, 1.0) - 0.5;
    return object->mass_kg / (1.0 + 12.0 * off * off);
}

static double wall_kg(const struct kind *object, const struct kind *striker)
{
    double walls_m2 = 2.0 * (object->length_m + object->width_m) * object->height_m;
    double struck_m2 = striker->width_m * maths_min(striker->height_m, object->height_m);
    return object->mass_kg * maths_min(1.0, struck_m2 / walls_m2);
}

double breaking_debris_kg(const struct kind *object, const struct kind *striker, double height_m)
{
    switch (object->object_class) {
    case OBJECT_BUSH:
        return object->mass_kg;
    case OBJECT_TREE:
    case OBJECT_POLE:
        return rod_kg(object, height_m);
    default:
        return wall_kg(object, striker);
    }
}
