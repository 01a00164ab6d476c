/* Bilinear enlargement in fixed point. */
#include "renderer/image/upscale.h"

#include <stddef.h>
#include <string.h>

#define ONE  256u        /* the weights of two pixels sum to this */
#define EVEN 0x00ff00ffu /* every other channel of a pixel */

/* A position between two pixels of a row. */
struct position {
    uint32_t first, next, share;
};

/* Returns where the middle of output pixel i lies in an input row of count pixels; an output pixel
 * is step / 65536 input pixels wide. */
static struct position source_position(uint32_t i, uint32_t count, int64_t step)
{
    int64_t at = (int64_t)i * step + step / 2 - 32768;
    if (at < 0)
        at = 0;
    uint32_t first = (uint32_t)(at >> 16);
    if (first + 1 >= count)
        return (struct position){count - 1, count - 1, 0};
    return (struct position){first, first + 1, (uint32_t)(at >> 8) & 255u};
}

/* Interpolates two channels at a time. */
static uint32_t mix(uint32_t a, uint32_t b, uint32_t share)
{
    uint32_t even = ((a & EVEN) * (ONE - share) + (b & EVEN) * share) >> 8 & EVEN;
    uint32_t odd = ((a >> 8 & EVEN) * (ONE - share) + (b >> 8 & EVEN) * share) & ~EVEN;
    return even | odd;
}

/* Interpolates between two rows of the smaller picture and repeats the last pixel at the end. */
static void blend_rows(uint32_t *row, const struct image *from, struct position v)
{
    const uint8_t *upper = from->pixels + (size_t)v.first * from->width * 4;
    const uint8_t *lower = from->pixels + (size_t)v.next * from->width * 4;
    for (uint32_t i = 0; i < from->width; i++) {
        uint32_t a, b;
        memcpy(&a, upper + (size_t)i * 4, sizeof a);
        memcpy(&b, lower + (size_t)i * 4, sizeof b);
        row[i] = mix(a, b, v.share);
    }
    row[from->width] = row[from->width - 1];
}

void image_upscale(struct image *to, const struct image *from)
{
    uint32_t row[UPSCALE_SIDE_MAX + 1], at[UPSCALE_SIDE_MAX];
    int64_t step_x = ((int64_t)from->width << 16) / to->width;
    int64_t step_y = ((int64_t)from->height << 16) / to->height;
    for (uint32_t x = 0; x < to->width; x++) {
        struct position u = source_position(x, from->width, step_x);
        at[x] = u.first * ONE + u.share;
    }
    for (uint32_t y = 0; y < to->height; y++) {
        uint8_t *out = to->pixels + (size_t)y * to->width * 4;
        blend_rows(row, from, source_position(y, from->height, step_y));
        for (uint32_t x = 0; x < to->width; x++) {
            const uint32_t *pair = &row[at[x] / ONE];
            uint32_t word = mix(pair[0], pair[1], at[x] % ONE);
            memcpy(out + (size_t)x * 4, &word, sizeof word);
        }
    }
}
