/* The deformation of a body, for eight of its corners at a time: dents move the surface, collapsed
 * parts sink into a heap, a broken part is bent over. It matches gl_deform.c. Kernels only. */
#ifndef JOLON_RENDERER_SOFT_BODY_DEFORM_H
#define JOLON_RENDERER_SOFT_BODY_DEFORM_H

#include "renderer/scene/scene.h"
#include "renderer/soft/simd8.h"
#include "world/maths/maths.h"

#include <stdbool.h>

/* The deformation of one body. */
struct body_deform {
    const struct draw_list_body *body;
    const struct draw_list_dent *dents;
    uint32_t dent_count;
    float cosine, sine; /* of the angle by which the broken part is bent */
    bool collapsed, broken;
};

SIMD8 struct body_deform body_deform_of(const struct draw_list_body *body,
                                        const struct draw_list_dent *dents)
{
    double sine, cosine;
    maths_sincos((double)body->broken[2], &sine, &cosine);
    return (struct body_deform){.body = body,
                                .dents = dents + (uint32_t)(body->dents[0] + 0.5f),
                                .dent_count = (uint32_t)(body->dents[1] + 0.5f),
                                .cosine = (float)cosine,
                                .sine = (float)sine,
                                .collapsed = body->collapse[2] > 0.0f,
                                .broken = body->broken[2] > 0.0f};
}

SIMD8 bool body_deform_any(const struct body_deform *form)
{
    return form->dent_count > 0 || form->collapsed || form->broken;
}

SIMD8 void body_deform_dent(const struct body_deform *form, v8f v[3])
{
    v8f from[3] = {v[0], v[1], v[2]};
    for (uint32_t i = 0; i < form->dent_count; i++) {
        const struct draw_list_dent *dent = &form->dents[i];
        v8f off[3] = {from[0] - dent->point[0], from[1] - dent->point[1], from[2] - dent->point[2]};
        float over = 1.0f / (dent->reach_m * dent->reach_m);
        v8f weight = simd8_max(1.0f - simd8_dot3(off, off) * over, simd8_f(0.0f));
        weight = weight * weight * dent->depth_m;
        for (uint32_t axis = 0; axis < 3; axis++)
            v[axis] += dent->direction[axis] * weight;
    }
}

SIMD8 v8f body_deform_hash(v8i x, v8i y, int32_t seed)
{
    v8u h = (v8u)x * 0x8da6b343u ^ (v8u)y * 0xd8163841u ^ (uint32_t)seed * 0xcb1ab31fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return simd8_to_f((v8i)((h ^ h >> 15) >> 8)) * 0x1.0p-24f;
}

SIMD8 v8f body_deform_noise(v8f x, v8f y, float seed)
{
    v8i ix = simd8_floor(x), iy = simd8_floor(y);
    v8f u = simd8_smoothstep(0.0f, 1.0f, x - simd8_to_f(ix));
    v8f v = simd8_smoothstep(0.0f, 1.0f, y - simd8_to_f(iy));
    int32_t n = (int32_t)seed;
    v8f north = simd8_mix(body_deform_hash(ix, iy, n), body_deform_hash(ix + 1, iy, n), u);
    v8f south = simd8_mix(body_deform_hash(ix, iy + 1, n), body_deform_hash(ix + 1, iy + 1, n), u);
    return simd8_mix(north, south, v);
}

/* Returns how far the body has collapsed at corners: 0 standing .. 1 in a heap. */
SIMD8 v8f body_deform_collapsed(const struct body_deform *form, const v8f v[3])
{
    const float *collapse = form->body->collapse;
    v8f ragged = 0.5f * body_deform_noise(v[0] * 0.3f, v[2] * 0.3f, form->body->noise_seed) - 0.25f;
    return simd8_smoothstep(1.0f, 1.22f,
                            v[0] * collapse[0] + v[2] * collapse[1] + collapse[2] + ragged);
}

SIMD8 void body_deform_collapse(const struct body_deform *form, v8f v[3])
{
    float noise_seed = form->body->noise_seed;
    v8f down = body_deform_collapsed(form, v), zero = simd8_f(0.0f);
    v8f heap = 0.06f + 0.20f * body_deform_noise(v[0] * 0.45f, v[2] * 0.45f, noise_seed + 64.0f) +
               0.20f * body_deform_noise(v[0] * 1.3f, v[2] * 1.3f, noise_seed + 320.0f);
    v8f aside_x =
        body_deform_noise(v[0] * 1.1f + v[1], v[2] * 1.1f + v[1], noise_seed + 128.0f) - 0.5f;
    v8f aside_z =
        body_deform_noise(v[0] * 1.1f - v[1], v[2] * 1.1f - v[1], noise_seed + 192.0f) - 0.5f;
    v8f high = simd8_max(v[1], zero) * 0.015f;
    v[0] += (v[0] * high + 2.2f * aside_x) * down;
    v[2] += (v[2] * high + 2.2f * aside_z) * down;
    v[1] *= simd8_select(v[1] > 0.0f, simd8_mix(simd8_f(1.0f), heap, down), simd8_f(1.0f));
}

SIMD8 void body_deform_break(const struct body_deform *form, v8f v[3])
{
    const float *at = form->body->broken;
    v8f x = v[0] - at[0], y = v[1] - at[1];
    v8i above = y > 0.0f;
    v[0] = simd8_select(above, at[0] + form->cosine * x + form->sine * y, v[0]);
    v[1] = simd8_select(above, at[1] + form->cosine * y - form->sine * x, v[1]);
}

/* Moves corners [m, body axes] by all deformations. */
SIMD8 void body_deform_corners(const struct body_deform *form, v8f v[3])
{
    body_deform_dent(form, v);
    if (form->collapsed)
        body_deform_collapse(form, v);
    if (form->broken)
        body_deform_break(form, v);
}

/* Returns how much paint the dents have removed at corners, 0 .. 1. */
SIMD8 v8f body_deform_bare(const struct body_deform *form, const v8f v[3])
{
    v8f off[3] = {v[0], v[1], v[2]};
    body_deform_dent(form, off);
    for (uint32_t axis = 0; axis < 3; axis++)
        off[axis] -= v[axis];
    return simd8_min(simd8_sqrt(simd8_dot3(off, off)) * 4.0f, simd8_f(1.0f));
}

#endif
