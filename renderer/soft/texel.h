/* Bilinear texture look-ups for eight pixels. Weights have eight bits and sum to 256; sums have
 * sixteen bits. Kernels only. */
#ifndef JOLON_RENDERER_SOFT_TEXEL_H
#define JOLON_RENDERER_SOFT_TEXEL_H

#include "renderer/scene/draw_list/texture.h"
#include "renderer/scene/terrain/terrain_tiles.h"
#include "renderer/soft/soft_texture.h"
#include "renderer/soft/simd8.h"

#define TEXEL_OVER (1.0f / 65280.0f) /* 256 * 255 */

/* The weights of the four texels around a point, in both halves of each lane. */
struct weights8 {
    v16s w00, w10, w01, w11;
};

SIMD8 v16s texel_twice(v8i w)
{
    return (v16s)(w | w << 16);
}

/* u and v: 0..255, the position between the first texel and the next. */
SIMD8 struct weights8 texel_weights(v8i u, v8i v)
{
    v8i w11 = (v8i)((v16s)u * (v16s)v >> 8), w10 = u - w11, w01 = v - w11;
    return (struct weights8){texel_twice(256 - u - w01), texel_twice(w10), texel_twice(w01),
                             texel_twice(w11)};
}

/* The four RGBA texels around each of eight points, in rows of width texels. */
struct quad8 {
    v8u t00, t10, t01, t11;
};

SIMD8 struct quad8 texel_quad(const uint8_t *texels, int32_t width, v8i x, v8i y)
{
    v8i at = (y * width + x) << 2;
    struct simd8_pairs top = simd8_gather_pairs(texels, at);
    struct simd8_pairs low = simd8_gather_pairs(texels + (ptrdiff_t)width * 4, at);
    return (struct quad8){top.low, top.high, low.low, low.high};
}

struct texels8 {
    v8f r, g, b, a;
};

/* Looks up a mip of a ground texture, of at least two texels a side. u, v: in 256ths of its texels,
 * 0 in the middle of the first. Channels are 0..65280. */
SIMD8 struct texels8 texel_four(const uint8_t *texture, uint32_t mip, v8f u, v8f v)
{
    int32_t side = (int32_t)tile_mip_side(mip);
    float most = 256.0f * (float)(side - 1) - 1.0f;
    v8i x = simd8_round(simd8_clamp(u, 0.0f, most)), y = simd8_round(simd8_clamp(v, 0.0f, most));
    v8i at = ((y >> 8 << (7 - mip)) + (x >> 8)) << 2;
    const uint8_t *first = texture + tile_mip_offset(mip);
    struct simd8_pairs top = simd8_gather_pairs(first, at);
    struct simd8_pairs low = simd8_gather_pairs(first + (ptrdiff_t)side * 4, at);
    v8i left = x & 255, up = y & 255;
    v16s right16 = texel_twice(left), low16 = texel_twice(up);
    v16s left16 = 256 - right16, top16 = 256 - low16;
    v8u even = simd8_u(0x00ff00ffu);
    v16s rb = ((v16s)(top.low & even) * top16 + (v16s)(low.low & even) * low16) >> 8;
    v16s ga = ((v16s)(top.low >> 8 & even) * top16 + (v16s)(low.low >> 8 & even) * low16) >> 8;
    v16s rb_right = ((v16s)(top.high & even) * top16 + (v16s)(low.high & even) * low16) >> 8;
    v16s ga_right =
        ((v16s)(top.high >> 8 & even) * top16 + (v16s)(low.high >> 8 & even) * low16) >> 8;
    v8u rb2 = (v8u)(rb * left16 + rb_right * right16),
        ga2 = (v8u)(ga * left16 + ga_right * right16);
    return (struct texels8){simd8_to_f((v8i)(rb2 & 0xffffu)), simd8_to_f((v8i)(ga2 & 0xffffu)),
                            simd8_to_f((v8i)(rb2 >> 16)), simd8_to_f((v8i)(ga2 >> 16))};
}

_Static_assert(TILE_TEXELS == 1u << 7, "the shift above is for this size");

/* A look-up in a repeating texture of two channels, of 2^power texels a side. Each texel is stored
 * with the one below it: red, green, then red and green of the next row (soft_texture.h). u, v: in
 * 256ths of a texel. Channels are 0..65280. */
struct pair8 {
    v8f red, green;
};

SIMD8 struct pair8 texel_pair(const uint8_t *texels, int32_t power, v8f u, v8f v)
{
    int32_t wrap = (256 << power) - 1;
    v8i x = simd8_round(u) & wrap, y = simd8_round(v) & wrap, row = y >> 8;
    v8i at = ((row << power) + row * SOFT_DETAIL_PAD + (x >> 8)) << 2;
    struct simd8_pairs columns = simd8_gather_pairs(texels, at);
    v8i left = x & 255, up = y & 255;
    v16s down = (v16s)((up << 16) - up + 256);
    v16s next = (v16s)(left | left << 16), here = 256 - next;
    v8u even = simd8_u(0x00ff00ffu);
    v16s red = (v16s)(columns.low & even) * here + (v16s)(columns.high & even) * next;
    v16s green = (v16s)(columns.low >> 8 & even) * here + (v16s)(columns.high >> 8 & even) * next;
    return (struct pair8){simd8_to_f(simd8_add_products(red >> 8, down)),
                          simd8_to_f(simd8_add_products(green >> 8, down))};
}

/* Looks up the cloud texture, of one channel: 0..1. u, v: in periods. */
SIMD8 v8f texel_cloud(const uint8_t *texels, v8f u, v8f v)
{
    int32_t side = (int32_t)TEXTURE_CLOUD_SIDE, wrap = 256 * side - 1;
    float scale = 256.0f * (float)side;
    v8i x = (simd8_floor(u * scale) - 128) & wrap, y = (simd8_floor(v * scale) - 128) & wrap;
    struct weights8 w = texel_weights(x & 255, y & 255);
    v8i at = (y >> 8) * (side + 2) + (x >> 8);
    v8u top = simd8_gather_bytes(texels, at), low = simd8_gather_bytes(texels + side + 2, at);
    v8u left = simd8_u(0xffffu);
    /* There is one texel in each half of a lane. */
    v16s t = (v16s)((top & 255u) | (top << 8 & 0xff0000u));
    v16s l = (v16s)((low & 255u) | (low << 8 & 0xff0000u));
    v16s w0 = (v16s)(((v8u)w.w00 & left) | ((v8u)w.w10 & ~left));
    v16s w1 = (v16s)(((v8u)w.w01 & left) | ((v8u)w.w11 & ~left));
    v8u sum = (v8u)(t * w0 + l * w1);
    return simd8_to_f((v8i)((sum & left) + (sum >> 16))) * TEXEL_OVER;
}

#endif
