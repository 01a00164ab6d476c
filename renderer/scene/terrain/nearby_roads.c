/* Distances to roads. */
#include "renderer/scene/terrain/nearby_roads.h"

#include "world/maths/maths.h"
#include "world/world.h"

#include <math.h>
#include <stddef.h>

struct block {
    double x, z, step_m, reach_m;
    uint32_t columns, rows, stride;
    float *off;
};

static void near_segment(const struct block *block, double ax, double az, double dx, double dz)
{
    double squared = dx * dx + dz * dz, over = squared > 0.0 ? 1.0 / squared : 0.0;
    double r0 = ceil((fmin(az, az + dz) - block->reach_m - block->z) / block->step_m);
    double r1 = floor((fmax(az, az + dz) + block->reach_m - block->z) / block->step_m);
    double c0 = ceil((fmin(ax, ax + dx) - block->reach_m - block->x) / block->step_m);
    double c1 = floor((fmax(ax, ax + dx) + block->reach_m - block->x) / block->step_m);
    uint32_t top = (uint32_t)maths_max(r0, 0.0), first = (uint32_t)maths_max(c0, 0.0);
    for (uint32_t row = top; row < block->rows && row <= r1; row++)
        for (uint32_t column = first; column < block->columns && column <= c1; column++) {
            double x = block->x + column * block->step_m - ax;
            double z = block->z + row * block->step_m - az;
            double t = maths_clamp((x * dx + z * dz) * over, 0.0, 1.0);
            double off_x = x - t * dx, off_z = z - t * dz;
            float off = sqrtf((float)(off_x * off_x + off_z * off_z));
            float *nearest = &block->off[(size_t)row * block->stride + column];
            *nearest = off < *nearest ? off : *nearest;
        }
}

struct rectangle {
    double x0, z0, x1, z1;
};

/* Whether a stretch begins with point i, and its bounds touch the rectangle. */
static bool is_near(const struct world *world, uint32_t i, const struct rectangle *near)
{
    const struct road_point *a = &world->road_points[i], *b = a + 1;
    double ax = (double)a->x, az = (double)a->z, bx = (double)b->x, bz = (double)b->z;
    return a->road == b->road && (ax >= near->x0 || bx >= near->x0) &&
           (ax <= near->x1 || bx <= near->x1) && (az >= near->z0 || bz >= near->z0) &&
           (az <= near->z1 || bz <= near->z1);
}

void nearby_roads_find(struct nearby_roads *roads, const struct world *world, double x0, double z0,
                       double x1, double z1)
{
    const struct rectangle near = {x0, z0, x1, z1};
    roads->count = 0;
    roads->too_many = false;
    for (uint32_t i = 0; i + 1 < world->counts.road_points && !roads->too_many; i++) {
        if (!is_near(world, i, &near))
            continue;
        if (roads->count < NEARBY_ROADS_MAX)
            roads->stretches[roads->count++] = i;
        else
            roads->too_many = true;
    }
}

bool nearby_roads_distances(const struct nearby_roads *roads, const struct world *world, double x,
                            double z, double step_m, uint32_t columns, uint32_t rows,
                            uint32_t stride, double reach_m, float *off)
{
    struct block block = {x, z, step_m, reach_m, columns, rows, stride, off};
    const struct rectangle near = {x - reach_m, z - reach_m, x + step_m * columns + reach_m,
                                   z + step_m * rows + reach_m};
    uint32_t count = roads->too_many ? world->counts.road_points - 1 : roads->count;
    bool any = false;
    for (uint32_t n = 0; n < count; n++) {
        uint32_t i = roads->too_many ? n : roads->stretches[n];
        const struct road_point *a = &world->road_points[i], *b = a + 1;
        if (!is_near(world, i, &near))
            continue;
        if (!any)
            for (size_t texel = 0; texel < (size_t)rows * stride; texel++)
                off[texel] = 1e9f;
        any = true;
        near_segment(&block, (double)a->x, (double)a->z, (double)b->x - (double)a->x,
                     (double)b->z - (double)a->z);
    }
    return any;
}
