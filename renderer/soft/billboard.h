/* Billboards (pictures that stand in space or lie on the ground): the pixels that each covers.
 * Kernels only. */
#ifndef JOLON_RENDERER_SOFT_BILLBOARD_H
#define JOLON_RENDERER_SOFT_BILLBOARD_H

#include "renderer/soft/soft_plants.h"
#include "renderer/soft/triangle_raster.h"
#include "renderer/soft/simd8.h"

/* Returns a value of the billboard at eight columns of a row. */
SIMD8 v8f billboard_value(const float value[3], v8f x, float y)
{
    return value[0] + y * value[2] + x * value[1];
}

/* Narrows the range of columns to those where a value that grows by a step a column is at least 0,
 * and a column beyond. */
SIMD8 void billboard_bound(float at, float step, float *left, float *right)
{
    float bound = -at / step;
    if (step > 0.0f)
        *left = bound - 1.0f > *left ? bound - 1.0f : *left;
    else if (step < 0.0f)
        *right = bound + 2.0f < *right ? bound + 2.0f : *right;
    else if (at < 0.0f)
        *right = *left;
}

/* Finds the columns first .. end - 1 of a row that the billboard may cover. */
SIMD8 void billboard_range(const struct soft_billboard *b, int32_t y, int32_t *first, int32_t *end)
{
    float side = (float)(1u << b->level), left = b->left, right = b->right, row = (float)y;
    float depth = side * (b->depth[0] + row * b->depth[2]);
    float across = b->across[0] + row * b->across[2], down = b->down[0] + row * b->down[2];
    billboard_bound(across, b->across[1], &left, &right);
    billboard_bound(depth - across, side * b->depth[1] - b->across[1], &left, &right);
    billboard_bound(down, b->down[1], &left, &right);
    billboard_bound(depth - down, side * b->depth[1] - b->down[1], &left, &right);
    *first = right > left ? (int32_t)left : 0;
    *end = right > left ? (int32_t)right : 0;
}

/* Eight pixels of a billboard. */
struct billboard8 {
    v8f depth, column, row; /* texels */
    v8i seen;
};

/* Finds the texels of eight pixels, and which pixels lie in the picture and nearer than the depth
 * that is stored. */
SIMD8 struct billboard8 billboard_pixels(const struct soft_billboard *b, const float *there,
                                         int32_t x, int32_t y, v8i inside)
{
    struct billboard8 p;
    float row = (float)y, side = (float)(1u << b->level);
    v8f column = simd8_to_f(simd8_count() + x);
    p.depth = billboard_value(b->depth, column, row);
    p.seen = inside & (p.depth > simd8_load_f(there));
    p.column = p.row = simd8_f(0.0f);
    if (simd8_bits(p.seen) == 0)
        return p;
    v8f far = 1.0f / simd8_select(p.seen, p.depth, simd8_f(1.0f));
    p.column = billboard_value(b->across, column, row) * far;
    p.row = billboard_value(b->down, column, row) * far;
    p.seen &= (p.column >= 0.0f) & (p.row >= 0.0f) & (p.column < side) & (p.row < side);
    p.column = simd8_select(p.seen, p.column, simd8_f(0.0f));
    p.row = simd8_select(p.seen, p.row, simd8_f(0.0f));
    return p;
}

SIMD8 v8i billboard_texel(const struct soft_billboard *b, v8f column, v8f row)
{
    return (simd8_to_i(row) << b->level) + simd8_to_i(column);
}

#endif
