/* The places of the vehicles in a formation. */
#include "world/entity/formation.h"

#define WEDGE_SHARE 0.7071067811865476 /* at 45 degrees to the leader's tail */

void formation_place(enum formation_shape shape, double spacing_m, uint32_t member, double *ahead_m,
                     double *right_m)
{
    double rank = (double)member, pair = (double)((member + 1) / 2);
    double side = member % 2 == 1 ? 1.0 : -1.0; /* odd members to the right */
    double slant = WEDGE_SHARE * spacing_m;
    switch (shape) {
    case FORMATION_LINE:
        *ahead_m = 0.0;
        *right_m = side * pair * spacing_m;
        break;
    case FORMATION_WEDGE:
        *ahead_m = -pair * slant;
        *right_m = side * pair * slant;
        break;
    case FORMATION_ECHELON_LEFT:
        *ahead_m = -rank * slant;
        *right_m = -rank * slant;
        break;
    case FORMATION_ECHELON_RIGHT:
        *ahead_m = -rank * slant;
        *right_m = rank * slant;
        break;
    default:
        *ahead_m = -rank * spacing_m;
        *right_m = 0.0;
        break;
    }
}
