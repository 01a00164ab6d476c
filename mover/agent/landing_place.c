/* Slope, water, objects and vehicles under a helicopter. */
#include "mover/agent/landing_place.h"

#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define SLOPE_MOST 0.17 /* tangent of 10 degrees; from 20 degrees on it would crash */
#define GAP_M      2.0  /* to what stands around */
#define POINTS     4    /* of the ground around the middle */

/* Returns true if the ground is dry and nearly level within reach_m. */
static bool is_level(const struct step_context *context, double x, double z, double reach_m)
{
    static const double east[POINTS] = {1.0, 0.0, -1.0, 0.0}, south[POINTS] = {0.0, 1.0, 0.0, -1.0};
    double height[POINTS], most = 2.0 * reach_m * SLOPE_MOST;
    for (int n = 0; n < POINTS; n++) {
        double at_x = x + reach_m * east[n], at_z = z + reach_m * south[n];
        if (!world_holds(context->world, at_x, at_z) ||
            cover_is_water(terrain_cover(&context->world->terrain, at_x, at_z)))
            return false;
        height[n] = kinematics_ground(context, at_x, at_z);
    }
    double middle = kinematics_ground(context, x, z);
    return fabs(height[0] - height[2]) < most && fabs(height[1] - height[3]) < most &&
           fabs(0.5 * (height[0] + height[2]) - middle) < 0.5 * most &&
           fabs(0.5 * (height[1] + height[3]) - middle) < 0.5 * most;
}

/* Returns true if a fixed object stands within reach_m, whole or not. */
static bool has_objects(const struct step_context *context, double x, double z, double reach_m)
{
    const struct world *world = context->world;
    const struct gridsquares *squares = &world->terrain.squares;
    struct gridsquare_box box =
        gridsquare_box_of(squares, x - reach_m, z - reach_m, x + reach_m, z + reach_m);
    for (int32_t row = box.z0; row <= box.z1; row++)
        for (int32_t column = box.x0; column <= box.x1; column++) {
            const uint32_t *objects;
            uint32_t count = world_reach(world, gridsquare_index(squares, column, row), &objects);
            for (uint32_t n = 0; n < count; n++) {
                const struct fixed_object *object = &world->fixed[objects[n]];
                double dx = object->x - x, dz = object->z - z;
                double most = reach_m + (double)object->radius_m;
                if (dx * dx + dz * dz < most * most)
                    return true;
            }
        }
    return false;
}

/* Returns true if another vehicle is within reach_m, in the air or on the ground. */
static bool has_vehicles(const struct step_context *context, uint32_t i, double reach_m)
{
    const struct entities *m = context->m;
    const struct neighbour_index_entry *entry;
    struct neighbour_query query = neighbour_query_begin(context->neighbours, NEIGHBOUR_INDEX_ALL,
                                                         m->x[i], m->z[i], 2.0 * reach_m);
    while ((entry = neighbour_query_next(&query)) != NULL) {
        double most = reach_m + context->world->kinds[entry->kind].radius_m;
        if (entry->row != i && neighbour_index_within(entry, m->x[i], m->z[i], most * most))
            return true;
    }
    return false;
}

bool landing_place_is_clear(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    double reach_m = context->world->kinds[m->kind[i]].radius_m + GAP_M;
    return is_level(context, m->x[i], m->z[i], reach_m) &&
           !has_objects(context, m->x[i], m->z[i], reach_m) && !has_vehicles(context, i, reach_m);
}
