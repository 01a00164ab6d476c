/* Damage and dents of one impact. */
#include "collider/response/deformation.h"

#include "world/maths/maths.h"

static double deformation_length(const struct kind *kind)
{
    return DEFORMATION_LENGTH * maths_min(kind->length_m, maths_min(kind->width_m, kind->height_m));
}

struct deformation deformation_of(const struct kind *kind, double joules)
{
    struct deformation deformation = {0.0, 0.0, 0.0};
    double gives = 1.0 - kind->rigidity;
    if (!(joules > 0.0))
        return deformation;
    deformation.harm_j = joules * (kind->rigidity + gives * kind->moldability);
    double depth = gives * deformation_length(kind) * maths_min(1.0, joules / kind->resistance_j);
    if (depth >= DEFORMATION_DENT_LEAST_M) {
        deformation.plastic_m = kind->moldability * depth;
        deformation.elastic_m = depth - deformation.plastic_m;
    }
    return deformation;
}
