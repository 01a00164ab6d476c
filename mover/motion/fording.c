/* Depths by the distance to the shore. */
#include "mover/motion/fording.h"

#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define BED_SLOPE 0.05 /* tangent: so steeply the ground falls from the shore */

bool fording_is_water(const struct step_context *context, double x, double z)
{
    const struct terrain *terrain = &context->world->terrain;
    return cover_is_water(terrain_cover(terrain, x, z)) || terrain_water_depth(terrain, x, z) > 0.0;
}

/* Returns true if the point is dry, or so shallow that the kind can ford there. The depth of fords
 * is known. The world does not know the ground under lakes and the sea: it falls evenly from the
 * shore. */
static bool is_shallow(const struct step_context *context, const struct kind *kind, double x,
                       double z)
{
    static const double ways[8][2] = {{1.0, 0.0},   {-1.0, 0.0},   {0.0, 1.0},    {0.0, -1.0},
                                      {0.71, 0.71}, {0.71, -0.71}, {-0.71, 0.71}, {-0.71, -0.71}};
    double reach = kind->ford_m / BED_SLOPE;
    double depth = terrain_water_depth(&context->world->terrain, x, z);
    if (depth > 0.0 || !fording_is_water(context, x, z))
        return depth <= kind->ford_m;
    for (int n = 0; n < 8; n++) {
        if (!fording_is_water(context, x + reach * ways[n][0], z + reach * ways[n][1]))
            return true;
    }
    return false;
}

bool fording_passable(const struct step_context *context, const struct kind *kind, double x,
                      double z)
{
    return world_holds(context->world, x, z) && is_shallow(context, kind, x, z);
}
