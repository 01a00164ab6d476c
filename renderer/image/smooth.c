/* Edge smoothing after T. Lottes, FXAA (2009), on the processor: only the few pixels on edges cost
 * anything, where a software OpenGL would run the whole shader for all of them. Several times
 * cheaper than drawing every pixel from several samples. */
#include "renderer/image/smooth.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define CONTRAST_LEAST 14   /* of 255: less is no edge */
#define CONTRAST_SHARE 7    /* nor is less than a seventh of the brightest pixel around */
#define SPAN_MOST      8.0f /* pixels along an edge */

struct sample {
    float r, g, b;
};

static void fill_luma(const struct image *image, uint8_t *luma)
{
    size_t count = (size_t)image->width * image->height;
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = image->pixels + i * 4;
        luma[i] = (uint8_t)((77u * p[0] + 150u * p[1] + 29u * p[2]) >> 8);
    }
}

/* The colour between four pixels; x and y of a pixel's centre are whole numbers. */
static struct sample sample_at(const struct image *image, float x, float y)
{
    x = fminf(fmaxf(x, 0.0f), (float)(image->width - 1) - 0.001f);
    y = fminf(fmaxf(y, 0.0f), (float)(image->height - 1) - 0.001f);
    uint32_t column = (uint32_t)x, row = (uint32_t)y;
    float u = x - (float)column, v = y - (float)row;
    const uint8_t *p = image->pixels + ((size_t)row * image->width + column) * 4;
    const uint8_t *q = p + (size_t)image->width * 4;
    float mixed[3];
    for (uint32_t i = 0; i < 3; i++) {
        float top = (float)p[i] + ((float)p[i + 4] - (float)p[i]) * u;
        float low = (float)q[i] + ((float)q[i + 4] - (float)q[i]) * u;
        mixed[i] = top + (low - top) * v;
    }
    return (struct sample){mixed[0], mixed[1], mixed[2]};
}

static struct sample middle_of(struct sample a, struct sample b)
{
    return (struct sample){0.5f * (a.r + b.r), 0.5f * (a.g + b.g), 0.5f * (a.b + b.b)};
}

static float bright(struct sample s)
{
    return 0.299f * s.r + 0.587f * s.g + 0.114f * s.b;
}

/* The mean of two places to both sides, along the edge. */
static struct sample along(const struct image *image, float x, float y, float dx, float dy)
{
    return middle_of(sample_at(image, x - dx, y - dy), sample_at(image, x + dx, y + dy));
}

static void smooth_pixel(struct image *to, const struct image *from, uint32_t column, uint32_t row,
                         const uint8_t *luma)
{
    size_t width = from->width;
    const uint8_t *m = luma + (size_t)row * width + column;
    int32_t nw = m[-(ptrdiff_t)width - 1], ne = m[-(ptrdiff_t)width + 1];
    int32_t sw = m[width - 1], se = m[width + 1];
    int32_t least = nw < ne ? nw : ne, most = nw > ne ? nw : ne;
    least = least < sw ? least : sw;
    most = most > sw ? most : sw;
    least = least < se ? least : se;
    most = most > se ? most : se;
    least = least < *m ? least : *m;
    most = most > *m ? most : *m;
    if (most - least < CONTRAST_LEAST || (most - least) * CONTRAST_SHARE < most)
        return;
    float dx = (float)((sw + se) - (nw + ne)), dy = (float)((nw + sw) - (ne + se));
    float ease = fmaxf((float)(nw + ne + sw + se) / 32.0f, 2.0f);
    float shorter = fminf(fabsf(dx), fabsf(dy)) + ease;
    dx = fminf(fmaxf(dx / shorter, -SPAN_MOST), SPAN_MOST);
    dy = fminf(fmaxf(dy / shorter, -SPAN_MOST), SPAN_MOST);
    float x = (float)column, y = (float)row;
    struct sample close = along(from, x, y, dx / 6.0f, dy / 6.0f);
    struct sample wide = middle_of(close, along(from, x, y, 0.5f * dx, 0.5f * dy));
    float b = bright(wide);
    /* The wide mean left the edge: the close one did not. */
    struct sample best = b < (float)least || b > (float)most ? close : wide;
    uint8_t *out = to->pixels + ((size_t)row * width + column) * 4;
    out[0] = (uint8_t)(best.r + 0.5f);
    out[1] = (uint8_t)(best.g + 0.5f);
    out[2] = (uint8_t)(best.b + 0.5f);
}

void smooth_edges(struct image *to, const struct image *from, uint8_t *luma)
{
    memcpy(to->pixels, from->pixels, (size_t)from->width * from->height * 4);
    fill_luma(from, luma);
    for (uint32_t row = 1; row + 1 < from->height; row++)
        for (uint32_t column = 1; column + 1 < from->width; column++)
            smooth_pixel(to, from, column, row, luma);
}
