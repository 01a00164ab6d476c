/* Converts two rows at a time, in blocks of constant length, which the compiler vectorises. */
#include "renderer/image/yuv.h"

#include <string.h>

#define BLOCK 32u /* pixels */

/* BT.709's coefficients times 219/255 and 224/255, in 256ths. Those of Cb and of Cr sum to 0, so
 * that grey has no colour. */
#define LUMA(r, g, b) (47u * (r) + 157u * (g) + 16u * (b))
#define LUMA_AT       (16u * 256u + 128u) /* black, plus half a unit for rounding */
#define BLUE(r, g, b) (-26 * (r)-86 * (g) + 112 * (b))
#define RED(r, g, b)  (112 * (r)-102 * (g)-10 * (b))
#define COLOUR_AT     (4 * (128 * 256 + 128)) /* for the sum of four pixels */

/* Converts BLOCK pixels of two rows. A pixel is read as one number; red is its lowest byte. */
static void convert(uint8_t *restrict y0, uint8_t *restrict y1, uint8_t *restrict blue,
                    uint8_t *restrict red, const uint32_t *restrict upper,
                    const uint32_t *restrict lower)
{
    uint16_t r[BLOCK], g[BLOCK], b[BLOCK];
    for (uint32_t i = 0; i < BLOCK; i++) {
        uint32_t p = upper[i], q = lower[i];
        uint32_t pr = p & 255, pg = p >> 8 & 255, pb = p >> 16 & 255;
        uint32_t qr = q & 255, qg = q >> 8 & 255, qb = q >> 16 & 255;
        y0[i] = (uint8_t)((LUMA(pr, pg, pb) + LUMA_AT) >> 8);
        y1[i] = (uint8_t)((LUMA(qr, qg, qb) + LUMA_AT) >> 8);
        r[i] = (uint16_t)(pr + qr);
        g[i] = (uint16_t)(pg + qg);
        b[i] = (uint16_t)(pb + qb);
    }
    for (uint32_t i = 0; i < BLOCK / 2; i++) {
        int32_t sr = r[2 * i] + r[2 * i + 1], sg = g[2 * i] + g[2 * i + 1];
        int32_t sb = b[2 * i] + b[2 * i + 1];
        blue[i] = (uint8_t)((BLUE(sr, sg, sb) + COLOUR_AT) >> 10);
        red[i] = (uint8_t)((RED(sr, sg, sb) + COLOUR_AT) >> 10);
    }
}

/* Output positions for two rows. */
struct row_pair {
    uint8_t *upper, *lower, *blue, *red;
};

/* Converts the end of two rows, which is shorter than a block. */
static void convert_tail(const struct row_pair *to, const uint32_t *upper, const uint32_t *lower,
                         uint32_t count)
{
    uint32_t pixels[2][BLOCK] = {{0}};
    uint8_t y[2][BLOCK], colour[2][BLOCK / 2];
    memcpy(pixels[0], upper, count * sizeof *upper);
    memcpy(pixels[1], lower, count * sizeof *lower);
    convert(y[0], y[1], colour[0], colour[1], pixels[0], pixels[1]);
    memcpy(to->upper, y[0], count);
    memcpy(to->lower, y[1], count);
    memcpy(to->blue, colour[0], count / 2);
    memcpy(to->red, colour[1], count / 2);
}

void yuv_of_image(const struct yuv *yuv, const struct image *image)
{
    const uint32_t width = image->width & ~1u;
    const uint32_t *upper = (const void *)image->pixels;
    for (uint32_t y = 0; y + 1 < image->height; y += 2, upper += (size_t)2 * image->width) {
        const uint32_t *lower = upper + image->width;
        struct row_pair to = {.upper = yuv->plane[0] + (ptrdiff_t)y * yuv->stride[0],
                              .lower = yuv->plane[0] + (ptrdiff_t)(y + 1) * yuv->stride[0],
                              .blue = yuv->plane[1] + (ptrdiff_t)(y / 2) * yuv->stride[1],
                              .red = yuv->plane[2] + (ptrdiff_t)(y / 2) * yuv->stride[2]};
        uint32_t x = 0;
        for (; x + BLOCK <= width; x += BLOCK) {
            convert(to.upper, to.lower, to.blue, to.red, upper + x, lower + x);
            to = (struct row_pair){to.upper + BLOCK, to.lower + BLOCK, to.blue + BLOCK / 2,
                                   to.red + BLOCK / 2};
        }
        if (x < width)
            convert_tail(&to, upper + x, lower + x, width - x);
    }
}
