/* Sets places on the ground. */
#include "world/terrain/ground_clamp.h"

#include <math.h>

bool ground_clamp(const struct terrain *terrain, const struct crater_index *craters,
                  double within_m, struct vec3 *at)
{
    double ground = terrain_height(terrain, craters, at->x, at->z);
    if (!(fabs(at->y - ground) <= within_m))
        return false;
    at->y = ground;
    return true;
}
