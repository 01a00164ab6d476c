/* Places on a spiral; and slope, water, objects and vehicles under a helicopter. */
#include "mover/agent/landing_place.h"

#include "mover/motion/kinematics.h"
#include "world/state.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define SLOPE_MOST 0.17 /* tangent of 10 degrees; from 20 degrees on it would crash */
#define GAP_M      2.0  /* to what stands around */
#define POINTS     4    /* of the ground around the middle */
#define PLACES     64u  /* of a turn: ids that differ by this many share their first place */
#define TURNS      4u   /* of places from which it chooses */
#define ROOM_M     40.0 /* of the spiral: places are about 70 m apart */
#define GOLDEN_RAD 2.39996322972865332 /* between two places of the spiral */

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

/* How much room row i needs around its middle [m]. */
static double reach_of(const struct step_context *context, uint32_t i)
{
    return context->world->kinds[context->m->row[i].kind].radius_m + GAP_M;
}

/* Returns true if a vehicle other than row i is within reach_m of a point, on the ground or, of the
 * rows before `before`, in the air. */
static bool has_vehicles(const struct step_context *context, uint32_t i, double x, double z,
                         uint32_t before)
{
    const struct entities *w = &context->committed->entities;
    const struct neighbour_index_entry *entry;
    const double reach_m = reach_of(context, i);
    struct neighbour_query query =
        neighbour_query_begin(context->neighbours, NEIGHBOUR_INDEX_ALL, x, z, 2.0 * reach_m);
    while ((entry = neighbour_query_next(&query)) != NULL) {
        const struct kind *kind = &context->world->kinds[entry->kind];
        double most = reach_m + kind->radius_m;
        bool flies = kind->domain == DOMAIN_AIR && w->row[entry->row].state == ENTITY_ACTIVE &&
                     !(w->row[entry->row].flags & ENTITY_FLAG_LANDED);
        if (entry->row != i && (!flies || entry->row < before) &&
            neighbour_index_within(entry, x, z, most * most))
            return true;
    }
    return false;
}

/* Returns a place of the spiral about a point. */
static struct vec3 place_at(const struct world *world, double x, double z, uint32_t number)
{
    double sine, cosine, away = ROOM_M * sqrt((double)number);
    maths_sincos(GOLDEN_RAD * (double)number, &sine, &cosine);
    return (struct vec3){world_clamp(world, x + away * sine), 0.0,
                         world_clamp(world, z - away * cosine)};
}

void landing_place_find(const struct step_context *context, uint32_t i, double *x, double *z)
{
    const uint32_t number = context->m->row[i].id % PLACES;
    struct vec3 place = place_at(context->world, *x, *z, number);
    for (uint32_t turn = 1; turn < TURNS && has_vehicles(context, i, place.x, place.z, i); turn++)
        place = place_at(context->world, *x, *z, number + turn * PLACES);
    *x = place.x;
    *z = place.z;
}

bool landing_place_is_clear(const struct step_context *context, uint32_t i)
{
    const struct entities *m = context->m;
    double x = m->row[i].x, z = m->row[i].z, reach_m = reach_of(context, i);
    return is_level(context, x, z, reach_m) && !has_objects(context, x, z, reach_m) &&
           !has_vehicles(context, i, x, z, UINT32_MAX);
}
