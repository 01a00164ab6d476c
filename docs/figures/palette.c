/* Median cut after P. Heckbert, "Color image quantization for frame buffer display" (1982), over
 * colours of five bits a channel; then R. Floyd and L. Steinberg's diffusion of the errors. */
#include "docs/figures/palette.h"

#include <stdlib.h>
#include <string.h>

#define BITS           5
#define LEVELS         (1 << BITS)
#define CELLS          (LEVELS * LEVELS * LEVELS)
#define DIFFUSED       3 /* quarters of an error that are diffused; all of it gives more noise */
#define UNKNOWN        UINT16_MAX
#define LIGHT(r, g, b) (2 * (r) + 4 * (g) + (b)) /* weights of the channels for the eye, about */

/* The picture's pixels in a cell of the colour cube. */
struct cell {
    uint32_t count;
    uint64_t sum[3];
};

/* A box of cells. */
struct cut {
    int32_t low[3], high[3]; /* inclusive */
    uint64_t count;
};

struct work {
    struct cell cells[CELLS];
    struct cut cuts[PALETTE_COLOURS];
    uint16_t nearest[CELLS];
};

static uint32_t cell_at(int32_t r, int32_t g, int32_t b)
{
    return (uint32_t)((r * LEVELS + g) * LEVELS + b);
}

static void count_cells(struct work *work, const struct image *image)
{
    size_t count = (size_t)image->width * image->height;
    for (size_t i = 0; i < count; i++) {
        const uint8_t *p = image->pixels + i * 4;
        struct cell *cell = &work->cells[cell_at(p[0] >> 3, p[1] >> 3, p[2] >> 3)];
        cell->count++;
        for (uint32_t channel = 0; channel < 3; channel++)
            cell->sum[channel] += p[channel];
    }
}

/* Shrinks a box to the cells with pixels, and counts those. */
static void shrink(const struct work *work, struct cut *cut)
{
    struct cut tight = {{LEVELS, LEVELS, LEVELS}, {-1, -1, -1}, 0};
    int32_t at[3];
    for (at[0] = cut->low[0]; at[0] <= cut->high[0]; at[0]++)
        for (at[1] = cut->low[1]; at[1] <= cut->high[1]; at[1]++)
            for (at[2] = cut->low[2]; at[2] <= cut->high[2]; at[2]++) {
                uint32_t count = work->cells[cell_at(at[0], at[1], at[2])].count;
                tight.count += count;
                for (uint32_t i = 0; i < 3 && count > 0; i++) {
                    tight.low[i] = at[i] < tight.low[i] ? at[i] : tight.low[i];
                    tight.high[i] = at[i] > tight.high[i] ? at[i] : tight.high[i];
                }
            }
    *cut = tight;
}

static int32_t longest_side(const struct cut *cut, int32_t *length)
{
    static const int32_t weights[3] = {2, 4, 1};
    int32_t best = 0;
    *length = 0;
    for (int32_t i = 0; i < 3; i++)
        if ((cut->high[i] - cut->low[i]) * weights[i] > *length) {
            *length = (cut->high[i] - cut->low[i]) * weights[i];
            best = i;
        }
    return best;
}

/* Returns the pixels of a box with this level of a channel. */
static uint64_t slice_count(const struct work *work, struct cut cut, int32_t channel, int32_t level)
{
    cut.low[channel] = cut.high[channel] = level;
    shrink(work, &cut);
    return cut.count;
}

/* Cuts a box across its longest side, with about half of its pixels on each side. */
static void halve(const struct work *work, struct cut *cut, struct cut *other)
{
    int32_t length, channel = longest_side(cut, &length), at = cut->low[channel];
    uint64_t below = slice_count(work, *cut, channel, at);
    while (at + 1 < cut->high[channel] && below * 2 < cut->count)
        below += slice_count(work, *cut, channel, ++at);
    *other = *cut;
    cut->high[channel] = at;
    other->low[channel] = at + 1;
    shrink(work, cut);
    shrink(work, other);
}

/* Returns the box to cut next: many pixels, far apart. -1 when none can be cut. */
static int32_t next_cut(const struct work *work, uint32_t count)
{
    int32_t best = -1;
    uint64_t most = 0;
    for (uint32_t i = 0; i < count; i++) {
        int32_t length;
        longest_side(&work->cuts[i], &length);
        uint64_t want = work->cuts[i].count * (uint64_t)length * (uint64_t)length;
        if (length > 0 && want > most) {
            most = want;
            best = (int32_t)i;
        }
    }
    return best;
}

static void mean_colour(const struct work *work, const struct cut *cut, uint8_t colour[3])
{
    uint64_t sum[3] = {0, 0, 0};
    for (int32_t r = cut->low[0]; r <= cut->high[0]; r++)
        for (int32_t g = cut->low[1]; g <= cut->high[1]; g++)
            for (int32_t b = cut->low[2]; b <= cut->high[2]; b++)
                for (uint32_t i = 0; i < 3; i++)
                    sum[i] += work->cells[cell_at(r, g, b)].sum[i];
    for (uint32_t i = 0; i < 3; i++)
        colour[i] = (uint8_t)((sum[i] + cut->count / 2) / (cut->count > 0 ? cut->count : 1));
}

static void choose(struct work *work, struct palette *palette)
{
    work->cuts[0] = (struct cut){{0, 0, 0}, {LEVELS - 1, LEVELS - 1, LEVELS - 1}, 0};
    shrink(work, &work->cuts[0]);
    palette->count = 1;
    int32_t at;
    while (palette->count < PALETTE_COLOURS && (at = next_cut(work, palette->count)) >= 0)
        halve(work, &work->cuts[at], &work->cuts[palette->count++]);
    for (uint32_t i = 0; i < palette->count; i++)
        mean_colour(work, &work->cuts[i], palette->colours[i]);
}

static uint16_t nearest_of(struct work *work, const struct palette *palette, const int32_t rgb[3])
{
    uint16_t *known = &work->nearest[cell_at(rgb[0] >> 3, rgb[1] >> 3, rgb[2] >> 3)];
    if (*known != UNKNOWN)
        return *known;
    int32_t least = INT32_MAX;
    for (uint32_t i = 0; i < palette->count; i++) {
        int32_t r = palette->colours[i][0] - (rgb[0] | 4),
                g = palette->colours[i][1] - (rgb[1] | 4);
        int32_t b = palette->colours[i][2] - (rgb[2] | 4), off = LIGHT(r * r, g * g, b * b);
        if (off < least) {
            least = off;
            *known = (uint16_t)i;
        }
    }
    return *known;
}

static int32_t within_byte(int32_t v)
{
    return v < 0 ? 0 : v > 255 ? 255 : v;
}

/* Fills indices by error diffusion. errors: of this row and the next, three channels a pixel, with
 * room for a pixel before and behind each row. */
static void diffuse(struct work *work, const struct palette *palette, uint8_t *indices,
                    const struct image *image, int32_t *errors)
{
    int32_t row_size = ((int32_t)image->width + 2) * 3, *now = errors + 3, *next = now + row_size;
    for (uint32_t y = 0; y < image->height; y++) {
        memset(next - 3, 0, (size_t)row_size * sizeof *next);
        for (uint32_t x = 0; x < image->width; x++) {
            size_t at = (size_t)y * image->width + x;
            int32_t rgb[3], *error = now + x * 3;
            for (uint32_t i = 0; i < 3; i++)
                rgb[i] = within_byte(image->pixels[at * 4 + i] + error[i] / 16);
            uint16_t index = nearest_of(work, palette, rgb);
            indices[at] = (uint8_t)index;
            for (uint32_t i = 0; i < 3; i++) {
                int32_t off = (rgb[i] - palette->colours[index][i]) * DIFFUSED / 4;
                now[(x + 1) * 3 + i] += off * 7;
                next[(x + 1) * 3 + i] += off;
                next[x * 3 + i] += off * 5;
                *(next + x * 3 + i - 3) += off * 3;
            }
        }
        int32_t *done = now;
        now = next;
        next = done;
    }
}

int palette_reduce(struct palette *palette, uint8_t *indices, const struct image *image)
{
    struct work *work = calloc(1, sizeof *work);
    int32_t *errors = calloc(((size_t)image->width + 2) * 6, sizeof *errors);
    int result = -1;
    if (work != NULL && errors != NULL) {
        for (size_t i = 0; i < CELLS; i++)
            work->nearest[i] = UNKNOWN;
        count_cells(work, image);
        choose(work, palette);
        diffuse(work, palette, indices, image, errors);
        result = 0;
    }
    free(errors);
    free(work);
    return result;
}
