/* Triangle rasterisation: clipping at the near plane, setting up eight triangles at once, walking
 * the pixels of one. Kernels only.
 *
 * A pixel belongs to a triangle when its centre lies inside. A centre on an edge belongs to the
 * triangle below or to the right. The crossing of an edge with a row is always computed from the
 * edge's upper to its lower corner, so that two triangles that share an edge agree to the bit: no
 * pixel between them is missed or drawn twice. */
#ifndef JOLON_RENDERER_SOFT_TRIANGLE_RASTER_H
#define JOLON_RENDERER_SOFT_TRIANGLE_RASTER_H

#include "renderer/soft/soft_internal.h"
#include "renderer/soft/simd8.h"

#include <stdbool.h>

#define TRIANGLE_RASTER_FAR 1.0e8f /* [pixel] triangles with corners farther out are not drawn */

/* The corners of eight triangles in the picture [pixel]. */
struct corners8 {
    v8f x[3], y[3];
};

/* The edges of eight triangles. */
struct edges8 {
    v8f top_x, top_y, middle_x, middle_y, low_y;
    v8f long_slope, upper_slope, lower_slope;
    v8f area;       /* twice the area; positive when the corners turn clockwise in the picture */
    v8f over_area;  /* 1 / area */
    v8i first, end; /* rows, within the picture */
    v8f x0, y0;     /* the first corner, and the vectors from it to the others */
    v8f x1, y1, x2, y2;
};

struct plane8 {
    v8f top, x, y;
};

SIMD8 void triangle_raster_order(v8f *x, v8f *y, v8f *lower_x, v8f *lower_y)
{
    v8i wrong = *y > *lower_y;
    v8f swap_x = simd8_select(wrong, *lower_x, *x), swap_y = simd8_select(wrong, *lower_y, *y);
    *lower_x = simd8_select(wrong, *x, *lower_x);
    *lower_y = simd8_select(wrong, *y, *lower_y);
    *x = swap_x;
    *y = swap_y;
}

/* Returns the row or column whose centre is the first at or after a coordinate, within 0 ..
 * most. */
SIMD8 v8i triangle_raster_line(v8f at, float most)
{
    return simd8_ceil(simd8_clamp(at - 0.5f, 0.0f, most));
}

/* Returns by how many columns an edge moves in a row; 0 for a level edge. */
SIMD8 v8f triangle_raster_slope(v8f x, v8f y, v8f lower_x, v8f lower_y)
{
    v8f high = lower_y - y;
    return simd8_select(high > 0.0f, (lower_x - x) / simd8_select(high > 0.0f, high, simd8_f(1.0f)),
                        simd8_f(0.0f));
}

/* Returns twice the triangles' areas; positive when the corners turn clockwise in the picture. */
SIMD8 v8f triangle_raster_area(const struct corners8 *c)
{
    return (c->x[1] - c->x[0]) * (c->y[2] - c->y[0]) - (c->x[2] - c->x[0]) * (c->y[1] - c->y[0]);
}

/* Returns a mask of the triangles that may contain a pixel's centre: their area is not 0, they do
 * not lie wholly to one side of the picture, and no corner is NaN or infinite. */
SIMD8 v8i triangle_raster_shown(const struct corners8 *c, v8f area, uint32_t width, uint32_t height)
{
    float columns = (float)width, rows = (float)height;
    v8f left = simd8_min(simd8_min(c->x[0], c->x[1]), c->x[2]);
    v8f right = simd8_max(simd8_max(c->x[0], c->x[1]), c->x[2]);
    v8f top = simd8_min(simd8_min(c->y[0], c->y[1]), c->y[2]);
    v8f low = simd8_max(simd8_max(c->y[0], c->y[1]), c->y[2]);
    /* Comparisons with NaN are false. */
    v8i there = (area > 0.0f) | (area < 0.0f);
    v8i number = (left > -TRIANGLE_RASTER_FAR) & (right < TRIANGLE_RASTER_FAR) &
                 (top > -TRIANGLE_RASTER_FAR) & (low < TRIANGLE_RASTER_FAR);
    /* A triangle that lies between the centres of two columns or rows has no pixels. */
    v8i columns_held = triangle_raster_line(left, columns) < triangle_raster_line(right, columns);
    v8i rows_held = triangle_raster_line(top, rows) < triangle_raster_line(low, rows);
    return there & number & columns_held & rows_held;
}

/* Sets up eight triangles. Returns triangle_raster_shown(). */
SIMD8 v8i triangle_raster_set_up(struct edges8 *s, const struct corners8 *c, uint32_t width,
                                 uint32_t height)
{
    float rows = (float)height;
    s->x0 = c->x[0];
    s->y0 = c->y[0];
    s->x1 = c->x[1] - c->x[0];
    s->y1 = c->y[1] - c->y[0];
    s->x2 = c->x[2] - c->x[0];
    s->y2 = c->y[2] - c->y[0];
    s->area = triangle_raster_area(c);
    v8i there = (s->area > 0.0f) | (s->area < 0.0f);
    s->over_area = 1.0f / simd8_select(there, s->area, simd8_f(1.0f));

    v8f top_x = c->x[0], top_y = c->y[0], middle_x = c->x[1], middle_y = c->y[1];
    v8f low_x = c->x[2], low_y = c->y[2];
    triangle_raster_order(&top_x, &top_y, &middle_x, &middle_y);
    triangle_raster_order(&middle_x, &middle_y, &low_x, &low_y);
    triangle_raster_order(&top_x, &top_y, &middle_x, &middle_y);
    s->top_x = top_x;
    s->top_y = top_y;
    s->middle_x = middle_x;
    s->middle_y = middle_y;
    s->low_y = low_y;
    s->long_slope = triangle_raster_slope(top_x, top_y, low_x, low_y);
    s->upper_slope = triangle_raster_slope(top_x, top_y, middle_x, middle_y);
    s->lower_slope = triangle_raster_slope(middle_x, middle_y, low_x, low_y);
    s->first = triangle_raster_line(top_y, rows);
    s->end = triangle_raster_line(low_y, rows);
    return triangle_raster_shown(c, s->area, width, height);
}

/* Returns the plane through the values at the corners. */
SIMD8 struct plane8 triangle_raster_plane(const struct edges8 *s, v8f at0, v8f at1, v8f at2)
{
    v8f by1 = at1 - at0, by2 = at2 - at0;
    v8f x = (by1 * s->y2 - by2 * s->y1) * s->over_area;
    v8f y = (by2 * s->x1 - by1 * s->x2) * s->over_area;
    return (struct plane8){at0 + (s->top_x - s->x0) * x + (s->top_y - s->y0) * y, x, y};
}

/* Return one of the eight. */
SIMD8 struct triangle_edges triangle_raster_of(const struct edges8 *s, int lane)
{
    return (struct triangle_edges){s->top_x[lane],       s->top_y[lane],      s->middle_x[lane],
                                   s->middle_y[lane],    s->low_y[lane],      s->long_slope[lane],
                                   s->upper_slope[lane], s->lower_slope[lane]};
}

SIMD8 struct triangle_plane triangle_raster_plane_of(const struct plane8 *p, int lane)
{
    return (struct triangle_plane){p->top[lane], p->x[lane], p->y[lane]};
}

/* Returns the plane's value at the centres of eight pixels of a row, from column x on. */
SIMD8 v8f triangle_raster_value(const struct triangle_edges *s, const struct triangle_plane *p,
                                int32_t x, int32_t y)
{
    float row = p->top + ((float)y + 0.5f - s->top_y) * p->y;
    return row + (simd8_to_f(simd8_count() + x) + (0.5f - s->top_x)) * p->x;
}

/* Returns ceil(v - 0.5) within 0 .. most; 0 for NaN. */
SIMD8 int32_t triangle_raster_ceil(float v, float most)
{
    v -= 0.5f;
    v = v > 0.0f ? v : 0.0f;
    v = v < most ? v : most;
    int32_t whole = (int32_t)v;
    return whole + (v > (float)whole);
}

/* Draws eight pixels of a row. x, y: the first pixel, x a multiple of eight; at: its index in the
 * target's arrays; inside: the mask of the pixels that belong to the triangle. */
typedef void triangle_raster_pixels(void *context, int32_t x, int32_t y, size_t at, v8i inside);

/* Calls pixels, which should be inlined, for all of the triangle that lies in the band. The
 * crossings of its edges with eight rows are computed at once. */
SIMD8 void triangle_raster_walk(const struct triangle_edges *s, const struct soft_target *t,
                                triangle_raster_pixels *pixels, void *context)
{
    float rows = (float)SOFT_SIDE_MAX, columns = (float)t->width;
    int32_t y = triangle_raster_ceil(s->top_y, rows),
            middle = triangle_raster_ceil(s->middle_y, rows);
    int32_t end = triangle_raster_ceil(s->low_y, rows);
    y = y > t->first ? y : t->first;
    end = end < t->end ? end : t->end;
    /* True if the middle corner is to the right of the long edge. */
    bool right = s->middle_x > s->top_x + (s->middle_y - s->top_y) * s->long_slope;
    for (; y < end; y += LANES) {
        v8i number = simd8_count() + y;
        v8f down = simd8_to_f(number) + 0.5f;
        v8f x_long = s->top_x + (down - s->top_y) * s->long_slope;
        v8f x_short = simd8_select(number < middle, s->top_x + (down - s->top_y) * s->upper_slope,
                                   s->middle_x + (down - s->middle_y) * s->lower_slope);
        struct simd8_lanes first =
            simd8_lanes(triangle_raster_line(right ? x_long : x_short, columns));
        struct simd8_lanes last =
            simd8_lanes(triangle_raster_line(right ? x_short : x_long, columns));
        int32_t rows_left = end - y < LANES ? end - y : LANES;
        size_t row = (size_t)(y - t->first) * t->stride;
        for (int32_t i = 0; i < rows_left; i++, row += t->stride)
            for (int32_t x = first.lane[i] & -LANES; x < last.lane[i]; x += LANES)
                pixels(context, x, y + i, row + (size_t)x,
                       simd8_within(x, first.lane[i], last.lane[i]));
    }
}

/* --- the near plane --- */

#define TRIANGLE_RASTER_VALUES_MAX 12

/* A triangle's corner before projection: its distance along the view [m], and other values that are
 * linear along an edge (across, down, colours and the like). */
struct clip_corner {
    float ahead;
    float value[TRIANGLE_RASTER_VALUES_MAX];
};

/* Clips a triangle at the near plane. Returns the number of corners that are left: 0, 3 or 4, in
 * the same order of turning. */
SIMD8 uint32_t triangle_raster_clip(const struct clip_corner corner[3], uint32_t values,
                                    float near_m, struct clip_corner cut[4])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < 3; i++) {
        const struct clip_corner *a = &corner[i], *b = &corner[i < 2 ? i + 1 : 0];
        bool a_in = a->ahead >= near_m, b_in = b->ahead >= near_m;
        if (a_in)
            cut[count++] = *a;
        if (a_in == b_in)
            continue;
        /* This goes from the inner to the outer corner, so that both triangles of an edge agree. */
        const struct clip_corner *in = a_in ? a : b, *out = a_in ? b : a;
        float t = (near_m - in->ahead) / (out->ahead - in->ahead);
        struct clip_corner *at = &cut[count++];
        at->ahead = near_m;
        for (uint32_t v = 0; v < values; v++)
            at->value[v] = in->value[v] + (out->value[v] - in->value[v]) * t;
    }
    return count;
}

#endif
