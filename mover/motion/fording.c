/* Depths by the distance to the shore. */
#include "mover/motion/fording.h"

#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define BED_SLOPE 0.05 /* tangent: so steeply the ground falls from the shore */

bool fording_is_water(const struct step_context *context, double x, double z)
{
    return cover_is_water(terrain_cover(&context->world->terrain, x, z));
}

/* Returns true if the point is dry, or so near to the shore that the kind can ford there. The world
 * does not know the ground under water: it falls evenly from the shore. */
static bool is_shallow(const struct step_context *context, const struct kind *kind, double x,
                       double z)
{
    static const double ways[8][2] = {{1.0, 0.0},   {-1.0, 0.0},   {0.0, 1.0},    {0.0, -1.0},
                                      {0.71, 0.71}, {0.71, -0.71}, {-0.71, 0.71}, {-0.71, -0.71}};
    double reach = kind->ford_m / BED_SLOPE;
    if (!fording_is_water(context, x, z))
        return true;
    for (int n = 0; n < 8; n++) {
        if (!fording_is_water(context, x + reach * ways[n][0], z + reach * ways[n][1]))
            return true;
    }
    return false;
}

bool fording_passable(const struct step_context *context, const struct kind *kind, double x,
                      double z)
{
    return x >= 0.0 && z >= 0.0 && x <= WORLD_SIDE_M && z <= WORLD_SIDE_M &&
           is_shallow(context, kind, x, z);
}
