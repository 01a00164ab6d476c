/* Triangles into pixels: clipping at the near plane, setting up eight triangles at once, walking
 * one. Kernels only.
 *
 * A pixel belongs to a triangle when its centre lies inside; a centre on an edge belongs to the
 * triangle below or to the right of it. Where an edge crosses a row is worked out from its upper to
 * its lower corner, so that two triangles that share an edge agree to the bit: no pixel between
 * them is missed, or drawn twice. */
#ifndef JOLON_RENDERER_SPAN_H
#define JOLON_RENDERER_SPAN_H

#include "renderer/soft/soft.h"
#include "renderer/soft/vec.h"

#include <stdbool.h>

#define SPAN_FAR 1.0e8f /* [pixel] from the picture's corner: corners further off are not drawn */

/* Eight triangles in the picture [pixel]. */
struct corners8 {
    v8f x[3], y[3];
};

/* Of eight triangles. */
struct span8 {
    v8f top_x, top_y, middle_x, middle_y, low_y;
    v8f long_slope, upper_slope, lower_slope;
    v8f area;       /* twice; positive when the corners turn clockwise in the picture */
    v8f over_area;  /* 1 / area */
    v8i first, end; /* rows, within the picture */
    v8f x0, y0;     /* the first corner, and from it to the others */
    v8f x1, y1, x2, y2;
};

struct plane8 {
    v8f top, x, y;
};

VEC void span_order(v8f *x, v8f *y, v8f *lower_x, v8f *lower_y)
{
    v8i wrong = *y > *lower_y;
    v8f swap_x = vec_select(wrong, *lower_x, *x), swap_y = vec_select(wrong, *lower_y, *y);
    *lower_x = vec_select(wrong, *x, *lower_x);
    *lower_y = vec_select(wrong, *y, *lower_y);
    *x = swap_x;
    *y = swap_y;
}

/* The row or column whose centre is the first at or after a place, within 0 .. most. */
VEC v8i span_line(v8f at, float most)
{
    return vec_ceil(vec_clamp(at - 0.5f, 0.0f, most));
}

/* How far to the side an edge goes in a row; nothing where it crosses no row's centre. */
VEC v8f span_slope(v8f x, v8f y, v8f lower_x, v8f lower_y)
{
    v8f high = lower_y - y;
    return vec_select(high > 0.0f, (lower_x - x) / vec_select(high > 0.0f, high, vec_f(1.0f)),
                      vec_f(0.0f));
}

/* Twice the triangles' areas; positive when the corners turn clockwise in the picture. */
VEC v8f span_area(const struct corners8 *c)
{
    return (c->x[1] - c->x[0]) * (c->y[2] - c->y[0]) - (c->x[2] - c->x[0]) * (c->y[1] - c->y[0]);
}

/* The mask of the triangles that may hold a pixel's centre of a picture of this size: not of no
 * area, not wholly to a side, not of corners that are no numbers. */
VEC v8i span_shown(const struct corners8 *c, v8f area, uint32_t width, uint32_t height)
{
    float columns = (float)width, rows = (float)height;
    v8f left = vec_min(vec_min(c->x[0], c->x[1]), c->x[2]);
    v8f right = vec_max(vec_max(c->x[0], c->x[1]), c->x[2]);
    v8f top = vec_min(vec_min(c->y[0], c->y[1]), c->y[2]);
    v8f low = vec_max(vec_max(c->y[0], c->y[1]), c->y[2]);
    /* No comparison holds for what is no number. */
    v8i there = (area > 0.0f) | (area < 0.0f);
    v8i number = (left > -SPAN_FAR) & (right < SPAN_FAR) & (top > -SPAN_FAR) & (low < SPAN_FAR);
    /* Between two centres of columns, or of rows, there is nothing to draw. */
    v8i columns_held = span_line(left, columns) < span_line(right, columns);
    v8i rows_held = span_line(top, rows) < span_line(low, rows);
    return there & number & columns_held & rows_held;
}

/* Sets eight triangles up. Returns span_shown(). */
VEC v8i span_set_up(struct span8 *s, const struct corners8 *c, uint32_t width, uint32_t height)
{
    float rows = (float)height;
    s->x0 = c->x[0];
    s->y0 = c->y[0];
    s->x1 = c->x[1] - c->x[0];
    s->y1 = c->y[1] - c->y[0];
    s->x2 = c->x[2] - c->x[0];
    s->y2 = c->y[2] - c->y[0];
    s->area = span_area(c);
    v8i there = (s->area > 0.0f) | (s->area < 0.0f);
    s->over_area = 1.0f / vec_select(there, s->area, vec_f(1.0f));

    v8f top_x = c->x[0], top_y = c->y[0], middle_x = c->x[1], middle_y = c->y[1];
    v8f low_x = c->x[2], low_y = c->y[2];
    span_order(&top_x, &top_y, &middle_x, &middle_y);
    span_order(&middle_x, &middle_y, &low_x, &low_y);
    span_order(&top_x, &top_y, &middle_x, &middle_y);
    s->top_x = top_x;
    s->top_y = top_y;
    s->middle_x = middle_x;
    s->middle_y = middle_y;
    s->low_y = low_y;
    s->long_slope = span_slope(top_x, top_y, low_x, low_y);
    s->upper_slope = span_slope(top_x, top_y, middle_x, middle_y);
    s->lower_slope = span_slope(middle_x, middle_y, low_x, low_y);
    s->first = span_line(top_y, rows);
    s->end = span_line(low_y, rows);
    return span_shown(c, s->area, width, height);
}

/* The plane through the values at the corners. */
VEC struct plane8 span_plane(const struct span8 *s, v8f at0, v8f at1, v8f at2)
{
    v8f by1 = at1 - at0, by2 = at2 - at0;
    v8f x = (by1 * s->y2 - by2 * s->y1) * s->over_area;
    v8f y = (by2 * s->x1 - by1 * s->x2) * s->over_area;
    return (struct plane8){at0 + (s->top_x - s->x0) * x + (s->top_y - s->y0) * y, x, y};
}

/* One of the eight. */
VEC struct span span_of(const struct span8 *s, int lane)
{
    return (struct span){s->top_x[lane],       s->top_y[lane],      s->middle_x[lane],
                         s->middle_y[lane],    s->low_y[lane],      s->long_slope[lane],
                         s->upper_slope[lane], s->lower_slope[lane]};
}

VEC struct span_plane span_plane_of(const struct plane8 *p, int lane)
{
    return (struct span_plane){p->top[lane], p->x[lane], p->y[lane]};
}

/* The plane's value at the centres of eight pixels of a row from x on. */
VEC v8f span_value(const struct span *s, const struct span_plane *p, int32_t x, int32_t y)
{
    float row = p->top + ((float)y + 0.5f - s->top_y) * p->y;
    return row + (vec_to_f(vec_count() + x) + (0.5f - s->top_x)) * p->x;
}

/* ceil(v - 0.5) within 0 .. most; 0 for what is no number. */
VEC int32_t span_ceil(float v, float most)
{
    v -= 0.5f;
    v = v > 0.0f ? v : 0.0f;
    v = v < most ? v : most;
    int32_t whole = (int32_t)v;
    return whole + (v > (float)whole);
}

/* Draws eight pixels of a row: x and y of the first, x a multiple of eight; its place in the
 * target's arrays; which of the eight are inside. */
typedef void span_pixels(void *context, int32_t x, int32_t y, size_t at, v8i inside);

/* Calls pixels, which should be inlined, for all of the triangle that lies in the band. Where its
 * edges cross the rows is worked out for eight rows at once. */
VEC void span_walk(const struct span *s, const struct soft_target *t, span_pixels *pixels,
                   void *context)
{
    float rows = (float)SOFT_SIDE_MAX, columns = (float)t->width;
    int32_t y = span_ceil(s->top_y, rows), middle = span_ceil(s->middle_y, rows);
    int32_t end = span_ceil(s->low_y, rows);
    y = y > t->first ? y : t->first;
    end = end < t->end ? end : t->end;
    /* Is the middle corner to the right of the long edge? */
    bool right = s->middle_x > s->top_x + (s->middle_y - s->top_y) * s->long_slope;
    for (; y < end; y += LANES) {
        v8i number = vec_count() + y;
        v8f down = vec_to_f(number) + 0.5f;
        v8f x_long = s->top_x + (down - s->top_y) * s->long_slope;
        v8f x_short = vec_select(number < middle, s->top_x + (down - s->top_y) * s->upper_slope,
                                 s->middle_x + (down - s->middle_y) * s->lower_slope);
        struct vec_lanes first = vec_lanes(span_line(right ? x_long : x_short, columns));
        struct vec_lanes last = vec_lanes(span_line(right ? x_short : x_long, columns));
        int32_t rows_left = end - y < LANES ? end - y : LANES;
        size_t row = (size_t)(y - t->first) * t->stride;
        for (int32_t i = 0; i < rows_left; i++, row += t->stride)
            for (int32_t x = first.lane[i] & -LANES; x < last.lane[i]; x += LANES) {
                v8i column = vec_count() + x;
                pixels(context, x, y + i, row + (size_t)x,
                       (column >= first.lane[i]) & (column < last.lane[i]));
            }
    }
}

/* --- the near plane --- */

#define SPAN_VALUES_MAX 12

/* A triangle's corner before it is projected: where along the view, and its other values, which
 * are mixed evenly along an edge: x and y across and down, colours and the like. */
struct clip_corner {
    float ahead;
    float value[SPAN_VALUES_MAX];
};

/* Cuts away what is nearer than near_m. Returns how many corners are left: 0, 3 or 4, in the
 * same sense of turn. */
VEC uint32_t span_clip(const struct clip_corner corner[3], uint32_t values, float near_m,
                       struct clip_corner cut[4])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < 3; i++) {
        const struct clip_corner *a = &corner[i], *b = &corner[i < 2 ? i + 1 : 0];
        bool a_in = a->ahead >= near_m, b_in = b->ahead >= near_m;
        if (a_in)
            cut[count++] = *a;
        if (a_in == b_in)
            continue;
        /* From the inner to the outer corner, whichever triangle asks. */
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
