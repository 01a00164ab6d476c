/* Distances to roads. */
#include "renderer/scene/terrain/nearby_roads.h"

#include "world/maths/maths.h"
#include "world/road_index.h"
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

bool nearby_roads_distances(const struct road_index *roads, double x, double z, double step_m,
                            uint32_t columns, uint32_t rows, uint32_t stride, double reach_m,
                            float *off)
{
    const struct block block = {x, z, step_m, reach_m, columns, rows, stride, off};
    uint32_t stretch;
    bool any = false;
    if (roads == NULL)
        return false;
    struct road_walk walk =
        road_index_walk(roads, x - reach_m, z - reach_m, x + step_m * columns + reach_m,
                        z + step_m * rows + reach_m);
    while (road_walk_next(&walk, &stretch)) {
        const struct road_point *a = &roads->points[stretch], *b = a + 1;
        for (size_t texel = 0; !any && texel < (size_t)rows * stride; texel++)
            off[texel] = 1e9f;
        any = true;
        near_segment(&block, a->x, a->z, b->x - a->x, b->z - a->z);
    }
    return any;
}
