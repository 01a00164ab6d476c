/* Twelve numbers at a time become the columns of four vertices. */
#include "collider/geometry/vertex_reach.h"

#include "world/maths/cpu_dispatch.h"
#include "world/maths/simd.h"

#include <stddef.h>

/* Four numbers that lie anywhere. They are read as one vector: a vector that is read from what was
 * written in parts waits until those are in the cache. */
typedef double four_anywhere
    __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double)), may_alias));

_Static_assert(sizeof(struct vec3) == 3 * sizeof(double), "vertices lie without gaps");

/* How far four vertices reach in a direction, each of whose parts is in every lane of a vector. */
#define REACH_OF_FOUR(vertex, x, y, z, reach)                                                      \
    do {                                                                                           \
        const four_anywhere *in = (const four_anywhere *)(vertex);                                 \
        f64x4 xyz_x = in[0], yz_xy = in[1], z_xyz = in[2];                                         \
        f64x4 xy = __builtin_shufflevector(xyz_x, yz_xy, 0, 1, 6, 7);                              \
        f64x4 zx = __builtin_shufflevector(xyz_x, z_xyz, 2, 3, 4, 5);                              \
        f64x4 yz = __builtin_shufflevector(yz_xy, z_xyz, 0, 1, 6, 7);                              \
        (reach) = __builtin_shufflevector(xy, zx, 0, 5, 2, 7) * (x) +                              \
                  __builtin_shufflevector(xy, yz, 1, 4, 3, 6) * (y) +                              \
                  __builtin_shufflevector(zx, yz, 0, 5, 2, 7) * (z);                               \
    } while (0)

/* The same of hulls with fewer than four vertices. */
static uint32_t find_among_few(const struct vec3 *vertex, uint32_t count, struct vec3 direction,
                               double *each)
{
    double most = -INFINITY;
    uint32_t first = 0;
    for (uint32_t i = 0; i < count; i++) {
        double reach = vec3_dot(vertex[i], direction);
        if (each)
            each[i] = reach;
        if (reach > most) {
            most = reach;
            first = i;
        }
    }
    return first;
}

/* Of each lane and another one the one that reaches farther leads, or the lower number of two that
 * reach as far. */
#define LEAD(reach, number, i, j, k, l)                                                            \
    do {                                                                                           \
        f64x4 other = __builtin_shufflevector(reach, reach, i, j, k, l);                           \
        f64x4 other_number = __builtin_shufflevector(number, number, i, j, k, l);                  \
        four_masks leads = (other > (reach)) | ((other == (reach)) & (other_number < (number)));   \
        (reach) = SIMD_CHOOSE(leads, other, reach);                                                \
        (number) = SIMD_CHOOSE(leads, other_number, number);                                       \
    } while (0)

/* The last four overlap those before them, so that all are whole fours. */
static uint32_t find_first(const struct vec3 *vertex, uint32_t count, struct vec3 direction,
                           double *each)
{
    if (count < 4)
        return find_among_few(vertex, count, direction, each);
    const f64x4 x = SIMD_EVERY(direction.x), y = SIMD_EVERY(direction.y);
    const f64x4 z = SIMD_EVERY(direction.z), lane = {0.0, 1.0, 2.0, 3.0};
    f64x4 most = SIMD_EVERY(-INFINITY), first = SIMD_EVERY(0.0);
    for (uint32_t i = 0; i < count; i += 4) {
        uint32_t from = i + 4 <= count ? i : count - 4;
        f64x4 reach, number = lane + SIMD_EVERY((double)from);
        REACH_OF_FOUR(vertex + from, x, y, z, reach);
        if (each)
            *(four_anywhere *)(each + from) = reach;
        four_masks leads = reach > most;
        most = SIMD_CHOOSE(leads, reach, most);
        first = SIMD_CHOOSE(leads, number, first);
    }
    LEAD(most, first, 2, 3, 0, 1);
    LEAD(most, first, 1, 0, 3, 2);
    return (uint32_t)first[0];
}

VECTOR_CLONES uint32_t vertex_reach_first(const struct vec3 *vertex, uint32_t count,
                                          struct vec3 direction)
{
    return find_first(vertex, count, direction, NULL);
}

VECTOR_CLONES uint32_t vertex_reach_each(const struct vec3 *vertex, uint32_t count,
                                         struct vec3 direction, double *reach)
{
    return find_first(vertex, count, direction, reach);
}

VECTOR_CLONES double vertex_reach_most(const struct vec3 *vertex, uint32_t count,
                                       struct vec3 direction)
{
    if (count < 4)
        return vec3_dot(vertex[find_among_few(vertex, count, direction, NULL)], direction);
    const f64x4 x = SIMD_EVERY(direction.x), y = SIMD_EVERY(direction.y);
    const f64x4 z = SIMD_EVERY(direction.z);
    f64x4 lanes = SIMD_EVERY(-INFINITY);
    for (uint32_t i = 0; i < count; i += 4) {
        f64x4 reach;
        REACH_OF_FOUR(vertex + (i + 4 <= count ? i : count - 4), x, y, z, reach);
        lanes = SIMD_MAX(lanes, reach);
    }
    return maths_max(maths_max(lanes[0], lanes[1]), maths_max(lanes[2], lanes[3]));
}
