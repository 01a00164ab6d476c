/* Bilinear enlargement in fixed point. */
#include "renderer/image/upscale.h"

#include <stddef.h>
#include <string.h>

#define ONE  256u        /* shares of a mixture */
#define EVEN 0x00ff00ffu /* every other channel of a pixel */

/* A place between two pixels of a row. */
struct between {
    uint32_t first, next, share;
};

/* Where in a row of count pixels the middle of pixel i lies, of a row whose pixels are step / 65536
 * of one wide. */
static struct between place(uint32_t i, uint32_t count, int64_t step)
{
    int64_t at = (int64_t)i * step + step / 2 - 32768;
    if (at < 0)
        at = 0;
    uint32_t first = (uint32_t)(at >> 16);
    if (first + 1 >= count)
        return (struct between){count - 1, count - 1, 0};
    return (struct between){first, first + 1, (uint32_t)(at >> 8) & 255u};
}

/* Two channels at a time. */
static uint32_t mix(uint32_t a, uint32_t b, uint32_t share)
{
    uint32_t even = ((a & EVEN) * (ONE - share) + (b & EVEN) * share) >> 8 & EVEN;
    uint32_t odd = ((a >> 8 & EVEN) * (ONE - share) + (b >> 8 & EVEN) * share) & ~EVEN;
    return even | odd;
}

/* A row of the smaller picture between two of its own, and its last pixel once more. */
static void blend_rows(uint32_t *row, const struct image *from, struct between v)
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
        struct between u = place(x, from->width, step_x);
        at[x] = u.first * ONE + u.share;
    }
    for (uint32_t y = 0; y < to->height; y++) {
        uint8_t *out = to->pixels + (size_t)y * to->width * 4;
        blend_rows(row, from, place(y, from->height, step_y));
        for (uint32_t x = 0; x < to->width; x++) {
            const uint32_t *pair = &row[at[x] / ONE];
            uint32_t word = mix(pair[0], pair[1], at[x] % ONE);
            memcpy(out + (size_t)x * 4, &word, sizeof word);
        }
    }
}
