/* Antialiasing after T. Lottes, FXAA (2009), on the processor. Only the few pixels on edges cost
 * time, where a software OpenGL would run the whole shader for every pixel. It is several times
 * cheaper than multisampling. Edges are detected for eight pixels at a time. Pixels on edges are
 * collected until there are eight to smooth. */
#include "renderer/soft/fxaa.h"
#include "renderer/soft/texel.h"
#include "renderer/soft/simd8.h"

#define CONTRAST_LEAST 14   /* of 255: a lower contrast is no edge */
#define CONTRAST_SHARE 7    /* nor is a contrast below a seventh of the brightest pixel around */
#define SPAN_MOST      8.0f /* [pixel] along an edge */

/* Pixels on edges that wait to be smoothed. Entries beyond count hold earlier pixels. */
struct edges {
    int32_t column[2 * LANES], row[2 * LANES];
    float dx[2 * LANES], dy[2 * LANES]; /* along the edge */
    float least[2 * LANES], most[2 * LANES];
    uint32_t count;
};

SIMD8 v8u pixels_at(const struct image *image, uint32_t row, int32_t column)
{
    return simd8_load_u(image->pixels + ((ptrdiff_t)row * image->width + column) * 4);
}

SIMD8 v8i luma(v8u pixels)
{
    const v16s red_blue = (v16s)simd8_u(77u | 29u << 16), green = (v16s)simd8_u(150u);
    v8u two = (v8u)((v16s)(pixels & 0x00ff00ffu) * red_blue);
    v8u one = (v8u)((v16s)(pixels >> 8 & 255u) * green);
    return (v8i)(((two & 0xffffu) + (two >> 16) + one) >> 8);
}

SIMD8 v8i least_of(v8i a, v8i b)
{
    return simd8_select_i(a < b, a, b);
}

SIMD8 v8i most_of(v8i a, v8i b)
{
    return simd8_select_i(a > b, a, b);
}

/* The alphas of a row, with space at both ends for what vector loads read beyond. */
struct alphas {
    uint8_t before[32], of[FXAA_WIDTH_MAX], after[32];
};

/* Returns which of 32 pixels of a row may lie on an edge, one bit each. */
SIMD8 uint32_t edge_candidates(const struct alphas *above, const struct alphas *here,
                               const struct alphas *below, uint32_t column)
{
    const uint8_t *from[3] = {above->of + column, here->of + column, below->of + column};
    v8u least = simd8_u(UINT32_MAX), most = simd8_u(0);
    for (uint32_t i = 0; i < 3; i++) {
        v8u left = simd8_load_u(from[i] - 1), right = simd8_load_u(from[i] + 1);
        least = simd8_min_b(least, simd8_min_b(left, right));
        most = simd8_max_b(most, simd8_max_b(left, right));
    }
    v32b thing = (v32b)simd8_u(FXAA_OBJECT_ALPHA * 0x01010101u);
    v32b step = (v32b)most - (v32b)least, enough = (v32b)simd8_u(FXAA_STEP_ALPHA * 0x01010101u);
    v32b stepped = (v32b)((v32b)simd8_max_b((v8u)step, (v8u)enough) == step);
    return simd8_bits_b((v32b)((v32b)most == thing) | stepped);
}

/* Collects those of eight pixels that are on an edge. */
static inline void collect_edges(struct edges *edges, const struct image *from, uint32_t row,
                                 int32_t column, v8i candidates)
{
    v8i nw = luma(pixels_at(from, row - 1, column - 1));
    v8i ne = luma(pixels_at(from, row - 1, column + 1));
    v8i sw = luma(pixels_at(from, row + 1, column - 1));
    v8i se = luma(pixels_at(from, row + 1, column + 1));
    v8i here = luma(pixels_at(from, row, column));
    v8i least = least_of(least_of(least_of(nw, ne), least_of(sw, se)), here);
    v8i most = most_of(most_of(most_of(nw, ne), most_of(sw, se)), here), step = most - least;
    v8i on = candidates & (step >= CONTRAST_LEAST) & (((step << 3) - step) >= most);
    uint32_t bits = simd8_bits(on);
    if (bits == 0)
        return;
    _Static_assert(CONTRAST_SHARE == 7, "the shift above is for a seventh");
    v8f dx = simd8_to_f((sw + se) - (nw + ne)), dy = simd8_to_f((nw + sw) - (ne + se));
    v8f ease = simd8_max(simd8_to_f(nw + ne + sw + se) * (1.0f / 32.0f), simd8_f(2.0f));
    v8f over = 1.0f / (simd8_min(simd8_abs(dx), simd8_abs(dy)) + ease);
    dx = simd8_clamp(dx * over, -SPAN_MOST, SPAN_MOST);
    dy = simd8_clamp(dy * over, -SPAN_MOST, SPAN_MOST);
    for (; bits != 0; bits &= bits - 1) {
        int lane = __builtin_ctz(bits);
        uint32_t n = edges->count++;
        edges->column[n] = column + lane;
        edges->row[n] = (int32_t)row;
        edges->dx[n] = dx[lane];
        edges->dy[n] = dy[lane];
        edges->least[n] = (float)least[lane];
        edges->most[n] = (float)most[lane];
    }
}

/* The colours of eight pixels, times 256. */
struct sample8 {
    v16s red_blue, green;
};

/* Returns the picture's colour at points by bilinear interpolation; whole numbers are pixel
 * centres. */
SIMD8 struct sample8 sample_at(const struct image *from, v8f x, v8f y)
{
    float right = 256.0f * (float)(from->width - 1) - 1.0f;
    float bottom = 256.0f * (float)(from->height - 1) - 1.0f;
    v8i u = simd8_to_i(simd8_clamp(x * 256.0f, 0.0f, right));
    v8i v = simd8_to_i(simd8_clamp(y * 256.0f, 0.0f, bottom));
    struct weights8 w = texel_weights(u & 255, v & 255);
    struct quad8 q = texel_quad(from->pixels, (int32_t)from->width, u >> 8, v >> 8);
    v8u even = simd8_u(0x00ff00ffu), low = simd8_u(0xffu);
    return (struct sample8){
        (v16s)(q.t00 & even) * w.w00 + (v16s)(q.t10 & even) * w.w10 + (v16s)(q.t01 & even) * w.w01 +
            (v16s)(q.t11 & even) * w.w11,
        (v16s)(q.t00 >> 8 & low) * w.w00 + (v16s)(q.t10 >> 8 & low) * w.w10 +
            (v16s)(q.t01 >> 8 & low) * w.w01 + (v16s)(q.t11 >> 8 & low) * w.w11,
    };
}

SIMD8 struct sample8 middle_of(struct sample8 a, struct sample8 b)
{
    return (struct sample8){(a.red_blue >> 1) + (b.red_blue >> 1), (a.green >> 1) + (b.green >> 1)};
}

/* Returns the mean of the colours at (x, y) - (dx, dy) and (x, y) + (dx, dy). */
SIMD8 struct sample8 along(const struct image *from, v8f x, v8f y, v8f dx, v8f dy)
{
    return middle_of(sample_at(from, x - dx, y - dy), sample_at(from, x + dx, y + dy));
}

/* Returns the brightness, 0 .. 255. */
SIMD8 v8f brightness(struct sample8 s)
{
    v8u red_blue = (v8u)s.red_blue;
    return simd8_to_f((v8i)(red_blue & 0xffffu)) * (0.299f / 256.0f) +
           simd8_to_f((v8i)s.green) * (0.587f / 256.0f) +
           simd8_to_f((v8i)(red_blue >> 16)) * (0.114f / 256.0f);
}

SIMD8 v8u rounded(struct sample8 s)
{
    v8u red_blue = ((v8u)(s.red_blue + (uint16_t)128) >> 8) & 0x00ff00ffu;
    return red_blue | (((v8u)s.green + 128u) & 0xff00u) | 0xff000000u;
}

/* Smooths the first eight collected pixels, or all if there are fewer, and removes them. */
static void smooth(struct edges *edges, struct image *to, const struct image *from)
{
    uint32_t count = edges->count < LANES ? edges->count : LANES;
    /* If there are fewer than eight, earlier pixels are computed too and discarded. */
    v8f x = simd8_to_f((v8i)simd8_load_u(edges->column));
    v8f y = simd8_to_f((v8i)simd8_load_u(edges->row));
    v8f dx = simd8_load_f(edges->dx), dy = simd8_load_f(edges->dy);
    struct sample8 close = along(from, x, y, dx * (1.0f / 6.0f), dy * (1.0f / 6.0f));
    struct sample8 wide = middle_of(close, along(from, x, y, dx * 0.5f, dy * 0.5f));
    v8f b = brightness(wide);
    /* A wide mean outside the range of the neighbourhood has crossed the edge; the close one is
     * used. */
    v8i left = (b < simd8_load_f(edges->least)) | (b > simd8_load_f(edges->most));
    uint32_t best[LANES];
    simd8_store_u(best, simd8_select_u(left, rounded(close), rounded(wide)));
    for (uint32_t i = 0; i < count; i++) {
        size_t at = (size_t)edges->row[i] * from->width + (size_t)edges->column[i];
        memcpy(to->pixels + at * 4, &best[i], sizeof best[i]);
    }
    edges->count -= count;
    memcpy(edges->column, edges->column + LANES, LANES * sizeof *edges->column);
    memcpy(edges->row, edges->row + LANES, LANES * sizeof *edges->row);
    memcpy(edges->dx, edges->dx + LANES, LANES * sizeof *edges->dx);
    memcpy(edges->dy, edges->dy + LANES, LANES * sizeof *edges->dy);
    memcpy(edges->least, edges->least + LANES, LANES * sizeof *edges->least);
    memcpy(edges->most, edges->most + LANES, LANES * sizeof *edges->most);
}

/* Reads a row's alphas, and copies the row with alpha 255 unless to is NULL. */
static void read_row(struct alphas *alphas, struct image *to, const struct image *from,
                     uint32_t row)
{
    size_t first = (size_t)row * from->width * 4;
    const uint8_t *pixels = from->pixels + first;
    uint8_t *copy = to != NULL ? to->pixels + first : NULL;
    uint32_t column = 0;
    for (; column + 32 <= from->width; column += 32) {
        v8u four[4];
        for (uint32_t i = 0; i < 4; i++)
            four[i] = simd8_load_u(pixels + (size_t)(column + i * LANES) * 4);
        v8u tops = simd8_top_bytes(four);
        memcpy(alphas->of + column, &tops, sizeof tops);
        for (uint32_t i = 0; copy != NULL && i < 4; i++)
            simd8_store_u(copy + (size_t)(column + i * LANES) * 4, four[i] | 0xff000000u);
    }
    for (; column < from->width; column++) {
        alphas->of[column] = pixels[(size_t)column * 4 + 3];
        if (copy != NULL) {
            memcpy(copy + (size_t)column * 4, pixels + (size_t)column * 4, 3);
            copy[(size_t)column * 4 + 3] = 255;
        }
    }
}

/* Finds and smooths the edges of a row, not the first or last of the picture. Fewer than eight
 * pixels may stay in edges. */
static void smooth_row(struct edges *edges, struct image *to, const struct image *from,
                       uint32_t row, const struct alphas *const alphas[3])
{
    uint32_t last = from->width - 1;
    for (uint32_t column = 0; column < last; column += 32) {
        uint32_t bits = edge_candidates(alphas[0], alphas[1], alphas[2], column);
        if (column == 0)
            bits &= ~1u;
        if (last - column < 32)
            bits &= (1u << (last - column)) - 1u;
        for (uint32_t begin = column; bits != 0; begin += LANES, bits >>= LANES) {
            /* The neighbours of the eight pixels must lie in the picture. */
            uint32_t most = last - LANES, at = begin < most ? begin : most, eight = bits & 255u;
            if (eight == 0)
                continue;
            if (at == 0)
                collect_edges(edges, from, row, 1, simd8_mask(eight >> 1));
            else
                collect_edges(edges, from, row, (int32_t)at, simd8_mask(eight << (begin - at)));
            if (edges->count >= LANES)
                smooth(edges, to, from);
        }
    }
}

void KERNEL(fxaa_rows)(struct image *to, const struct image *from, uint32_t first, uint32_t end)
{
    struct edges edges = {.count = 0};
    struct alphas alphas[3];
    bool narrow = from->width < LANES + 2;
    if (first > 0)
        read_row(&alphas[(first - 1) % 3], NULL, from, first - 1);
    read_row(&alphas[first % 3], to, from, first);
    for (uint32_t row = first; row < end; row++) {
        if (row + 1 < from->height)
            read_row(&alphas[(row + 1) % 3], row + 1 < end ? to : NULL, from, row + 1);
        if (row == 0 || row + 1 >= from->height || narrow)
            continue;
        const struct alphas *const around[3] = {&alphas[(row - 1) % 3], &alphas[row % 3],
                                                &alphas[(row + 1) % 3]};
        smooth_row(&edges, to, from, row, around);
    }
    while (edges.count > 0)
        smooth(&edges, to, from);
}
