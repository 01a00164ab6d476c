/* The colours of sky and air for eight pixels or corners at a time. All kernels use this one model,
 * so that distant ground fades into the colour that the sky has there. Kernels only. */
#ifndef JOLON_RENDERER_SOFT_ATMOSPHERE_H
#define JOLON_RENDERER_SOFT_ATMOSPHERE_H

#include "renderer/scene/frame/light.h"
#include "renderer/soft/soft_internal.h"
#include "renderer/soft/simd8.h"

struct colour8 {
    v8f r, g, b;
};

/* The haze and fog between the eye and a point. */
struct atmosphere8 {
    struct colour8 colour;
    v8f opacity;
};

SIMD8 struct colour8 colour_of(float r, float g, float b)
{
    return (struct colour8){simd8_f(r), simd8_f(g), simd8_f(b)};
}

SIMD8 struct colour8 colour_mix(struct colour8 a, struct colour8 b, v8f t)
{
    return (struct colour8){simd8_mix(a.r, b.r, t), simd8_mix(a.g, b.g, t), simd8_mix(a.b, b.b, t)};
}

SIMD8 struct colour8 colour_scale(struct colour8 a, v8f by)
{
    return (struct colour8){a.r * by, a.g * by, a.b * by};
}

SIMD8 struct colour8 colour_add(struct colour8 a, struct colour8 b)
{
    return (struct colour8){a.r + b.r, a.g + b.g, a.b + b.b};
}

/* Returns the sky's colour at the horizon in the directions (x, z), of any length. */
SIMD8 struct colour8 atmosphere_horizon(const struct soft_frame *frame, v8f x, v8f z)
{
    float level = sqrtf(frame->sun[0] * frame->sun[0] + frame->sun[2] * frame->sun[2]);
    float sun_x = frame->sun[0] / level, sun_z = frame->sun[2] / level;
    v8f towards = (x * sun_x + z * sun_z) / simd8_sqrt(x * x + z * z + 1e-12f);
    v8f glow = 0.5f + 0.5f * towards;
    return colour_mix(colour_of(HORIZON_COOL), colour_of(HORIZON_WARM), glow * glow * glow);
}

/* Returns the fog's colour, which is half the horizon's. */
SIMD8 struct colour8 atmosphere_white(struct colour8 horizon)
{
    return colour_mix(colour_of(FOG_WHITE), horizon, simd8_f(0.5f));
}

/* Returns the sky's colour without sun and clouds in unit directions. */
SIMD8 struct colour8 atmosphere_sky(const struct soft_frame *frame, const v8f direction[3])
{
    v8f high = simd8_max(direction[1], simd8_f(0.0f));
    struct colour8 c =
        colour_mix(colour_of(SKY_MID), colour_of(SKY_DEEP), 1.0f - simd8_exp_minus(2.6f * high));
    return colour_mix(c, atmosphere_horizon(frame, direction[0], direction[2]),
                      simd8_exp_minus(9.0f * high));
}

/* Returns the air between the eye and points [m from the eye]. */
SIMD8 struct atmosphere8 atmosphere_at(const struct soft_frame *frame, const v8f place[3])
{
    v8f far = simd8_sqrt(simd8_dot3(place, place));
    v8f rise = simd8_clamp(place[1] * frame->fog_fall, -80.0f, 80.0f);
    v8i level = simd8_abs(rise) < 1e-3f;
    v8f layer = (1.0f - simd8_exp2(rise * -1.44269504f)) / simd8_select(level, simd8_f(1.0f), rise);
    v8f fog = frame->fog * simd8_select(level, simd8_f(1.0f), layer) * far;
    v8f all = fog + frame->haze * far;
    struct colour8 horizon = atmosphere_horizon(frame, place[0], place[2]);
    return (struct atmosphere8){
        colour_mix(horizon, atmosphere_white(horizon), fog / simd8_max(all, simd8_f(1e-6f))),
        1.0f - simd8_exp_minus(all)};
}

/* Returns the fog between the eye and the sky in unit directions: all the fog above the eye, along
 * the slanted path. */
SIMD8 struct atmosphere8 atmosphere_before_sky(const struct soft_frame *frame,
                                               const v8f direction[3])
{
    v8f up = frame->fog_fall * simd8_max(direction[1], simd8_f(1e-4f));
    return (struct atmosphere8){
        atmosphere_white(atmosphere_horizon(frame, direction[0], direction[2])),
        frame->fog / (frame->fog + up)};
}

SIMD8 struct colour8 atmosphere_over(struct colour8 c, const struct atmosphere8 *air)
{
    return colour_mix(c, air->colour, air->opacity);
}

#endif
