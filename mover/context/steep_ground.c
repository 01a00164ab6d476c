/* Slopes of the triangles between posts, and bounds of those of gridsquares. */
#include "mover/context/steep_ground.h"

#include "mover/query/ground_marks.h"
#include "world/terrain/square_bounds.h"
#include "world/terrain/terrain_cache.h"
#include "world/world.h"

#define PLACES 4 /* on a way */

double steep_ground_at(const struct step_context *context, uint32_t i, double x, double z)
{
    double east, south;
    terrain_cache_slopes(&context->world->terrain, &context->terrain_entries[i], x, z, &east,
                         &south);
    return sqrt(east * east + south * south);
}

double steep_ground_on_way(const struct step_context *context, uint32_t i, double east_m,
                           double south_m)
{
    const struct entities *m = context->m;
    double most = 0.0;
    for (int n = 1; n <= PLACES; n++) {
        double share = (double)n / PLACES;
        most = maths_max(most, steep_ground_at(context, i, m->row[i].x + share * east_m,
                                               m->row[i].z + share * south_m));
    }
    return most;
}

bool steep_ground_is_easy(const struct step_context *context, uint32_t i, double x, double z,
                          double most)
{
    const struct entities *m = context->m;
    struct gridsquare_box box = gridsquare_box_of(
        &context->world->terrain.squares, maths_min(m->row[i].x, x), maths_min(m->row[i].z, z),
        maths_max(m->row[i].x, x), maths_max(m->row[i].z, z));
    return square_bounds_within(context->slopes, box, square_bounds_below_slope(most)) &&
           !ground_marks_within(context->ground_marks, box, GROUND_MARKS_CRATER);
}
