/* The shading pass: the colours of ground, water and sky, eight pixels of a row at a time.
 *
 * Two slowly varying values are computed only at every eighth pixel of every fourth row: for the
 * air in front of the ground, the horizon's colour and the length of the ray; and the sky, which is
 * interpolated between four such points. Ground at a low angle uses mips whose texels are several
 * pixels wide. There only every second or fourth pixel is looked up, and those between are
 * interpolated. */
#include "renderer/soft/atmosphere.h"
#include "renderer/soft/kernel.h"
#include "renderer/soft/soft_ground.h"
#include "renderer/soft/texel.h"

#define STEP_ROWS 4
#define SUN_NEAR  0.998f /* cosine of an angle to the sun that contains its disc */
#define STEPS_MAX (SOFT_SIDE_MAX / LANES)

_Static_assert(SOFT_BAND_ROWS % STEP_ROWS == 0, "a step is within one band");

/* Values at the middle of every eight pixels of a row; colours 0..255. */
struct horizon_row {
    float r[STEPS_MAX], g[STEPS_MAX], b[STEPS_MAX];
    float far[STEPS_MAX]; /* [m] length of the ray to 1 m along the view */
    int32_t y;            /* the row it was computed for; -1: none */
};

/* Values at the left end of every eight pixels of a row, and at the right end of the last. */
struct sky_row {
    float r[STEPS_MAX + LANES], g[STEPS_MAX + LANES], b[STEPS_MAX + LANES];
    float sun[STEPS_MAX + LANES]; /* cosine of the angle to the sun */
    int32_t y;
};

/* The state of shading a band. */
struct shading {
    const struct soft_ground *ground;
    const struct soft_frame *frame;
    struct horizon_row horizon;
    struct sky_row above, below; /* at the first of four rows, and at the first of the next four */
    float ray[3];                /* at the row's left end */
    float rise;                  /* rise of the row's rays for each metre along the view */
    float fog_share, fog_fall;   /* for this row; see air_before() */
};

/* Eight points of one ground patch, while they are shaded. */
struct ground8 {
    v8f ahead;         /* [m] */
    v8f east, south;   /* from the eye [m] */
    v8i mask;          /* mask of the points that are shaded */
    struct texels8 at; /* the ground texture, then the colour, 0..255 */
    uint32_t x;        /* column of the first */
    uint32_t patch;
    uint32_t rate;  /* pixels for each point: 1, or 2 or 4 if all points are shaded */
    float far_m;    /* [m] distance of one of the points */
    float covers_m; /* [m] ground that its pixel covers along the view */
};

/* Several groups take each step together: while one waits for its texels from memory, the processor
 * continues with others. */
#define QUEUE_LENGTH 12u

struct ground_queue {
    struct ground8 ground[QUEUE_LENGTH];
    uint32_t count, coloured,
        drawn; /* groups; the first of these that have been coloured, stored */
};

/* Returns the weight of the next coarser mip, when the ideal texel is 1 .. 2 texels of this mip
 * wide. The transition is short. */
SIMD8 float next_mip_weight(float texels)
{
    float share = (texels - 1.7f) * (1.0f / 0.3f);
    return share < 1.0f ? share : 1.0f;
}

/* Returns the mip of the detail texture for an ideal width in texels of the largest mip. */
SIMD8 int32_t fine_mip(float texels_wide)
{
    int32_t mip = power_of_2(texels_wide) + 1;
    return mip < 0 ? 0 : mip > SOFT_DETAIL_POWER ? SOFT_DETAIL_POWER : mip;
}

/* Looks up the detail texture, 0..65280, at at + by * point [period], turned a little by across. */
SIMD8 struct pair8 fine_at(const struct soft_ground *ground, const struct ground8 *g,
                           float texels_wide, const float at[2], float by, float across)
{
    int32_t mip = fine_mip(texels_wide), power = SOFT_DETAIL_POWER - mip;
    float size = (float)(256 << power), step = by * size, aside = across * step;
    v8f u = g->east * step + (at[0] * size - 128.0f), v = g->south * step + (at[1] * size - 128.0f);
    if (across != 0.0f) {
        u += g->south * aside;
        v -= g->east * aside;
    }
    struct pair8 fine = texel_pair(ground->detail.mip[mip], power, u, v);
    float share = next_mip_weight(texels_wide * (1.0f / (float)(1u << mip)) * 2.0f);
    if (share > 0.0f && power > 0) {
        struct pair8 next =
            texel_pair(ground->detail.mip[mip + 1], power - 1, u * 0.5f - 64.0f, v * 0.5f - 64.0f);
        fine.red += (next.red - fine.red) * share;
        fine.green += (next.green - fine.green) * share;
    }
    return fine;
}

#define FINE_PER_M  (1.0f / FINE_M)
#define WAVES_ASIDE 0.35f
/* Less than the full width that a pixel covers: at a low angle the mean would look too blurred. */
#define SHARP 0.66f
#define WIDE  ((float)(1 << SOFT_DETAIL_POWER))

/* Returns the share that is left at a distance when fading from fades to faded [m]. */
static inline float fading(float far, float fades, float faded)
{
    float left = (faded - far) / (faded - fades);
    return left > 1.0f ? 1.0f : left;
}

/* Returns the factor by which the detail texture changes the ground's brightness. */
SIMD8 v8f detail_brightness(const struct soft_ground *ground, const struct ground8 *g, v8f scrub)
{
    float fine = fading(g->far_m, FINE_FADES_M, FINE_FADED_M);
    if (fine <= 0.0f)
        return simd8_f(1.0f);
    struct pair8 at = fine_at(ground, g, SHARP * g->covers_m * (WIDE * FINE_PER_M), ground->fine_at,
                              FINE_PER_M, 0.0f);
    return 1.0f + fine * (simd8_mix(at.red, at.green, scrub) * TEXEL_OVER - 0.5f);
}

/* Looks up the ground texture; channels 0..65280. */
SIMD8 struct texels8 ground_texture(const struct soft_patch *patch, const struct ground8 *g)
{
    /* The mip depends only on the distance and on what a pixel covers. Patches of different levels
     * therefore meet with equal sharpness, and nothing changes suddenly when a patch is divided. */
    float texels = tile_texels(g->far_m, g->covers_m, 1.0f) * patch->per_m;
    int32_t power = power_of_2(texels);
    uint32_t mip = power < 0 ? 0 : power > 5 ? 5 : (uint32_t)power;
    float scale = 1.0f / (float)(1u << mip), size = 256.0f * scale;
    float step = patch->per_m * size, off = 128.0f * scale - 128.0f;
    v8f u = g->east * step + (patch->at_u * size + off);
    v8f v = g->south * step + (patch->at_v * size + off);
    struct texels8 tile = texel_four(patch->texture, mip, u, v);
    float share = next_mip_weight(texels * scale);
    if (share > 0.0f) {
        struct texels8 next =
            texel_four(patch->texture, mip + 1, u * 0.5f - 64.0f, v * 0.5f - 64.0f);
        tile.r += (next.r - tile.r) * share;
        tile.g += (next.g - tile.g) * share;
        tile.b += (next.b - tile.b) * share;
        tile.a += (next.a - tile.a) * share;
    }
    return tile;
}

/* Returns the foam on the sea near the shore, whose distance is in the texture's alpha: two lines
 * that come and go, and the wash at the water's edge. */
SIMD8 v8f foam(const struct soft_frame *frame, v8f alpha, v8f ragged, v8f lumps)
{
    float beat = frame->time_s * (1.0f / SURF_S);
    beat = fabsf(2.0f * (beat - (float)(int32_t)beat) - 1.0f);
    beat = beat * beat * (3.0f - 2.0f * beat);
    v8f shore = simd8_clamp(alpha * (1.0f / SHORE_WATER), 0.0f, 1.0f);
    v8f line = shore - 0.29f - 0.32f * beat - 0.5f * ragged;
    v8f amount = simd8_max(1.0f - 7.0f * simd8_abs(line), simd8_f(0.0f));
    amount += 0.5f * simd8_max(1.0f - 6.0f * simd8_abs(line + 0.34f), simd8_f(0.0f));
    amount = simd8_max(amount, 5.0f * (shore - 0.86f)) * (0.3f + 1.2f * lumps);
    return simd8_clamp(amount * simd8_clamp(3.0f * shore - 0.4f, 0.0f, 1.0f), 0.0f, 0.9f);
}

/* Returns the water's colour, 0..1: the reflected sky, the sun on the waves, and foam. */
static struct colour8 water(const struct soft_ground *ground, const struct soft_frame *frame,
                            const struct ground8 *g, float rise, struct colour8 deep, v8f alpha,
                            bool surf)
{
    v8f direction[3] = {g->east, g->ahead * rise, g->south}, back[3], n[3];
    v8f far = simd8_sqrt(simd8_dot3(direction, direction));
    float t = frame->time_s;
    const float ripples_at[2] = {ground->ripples_at[0] + 0.023f * t,
                                 ground->ripples_at[1] + 0.023f * t};
    const float swell_at[2] = {ground->swell_at[0] - 0.007f * t, ground->swell_at[1] - 0.007f * t};
    /* The swell runs across the ripples. */
    struct ground8 turned = *g;
    turned.east = g->south;
    turned.south = g->east;
    struct pair8 ripples = fine_at(ground, g, g->covers_m * (WIDE * SOFT_RIPPLES_PER_M), ripples_at,
                                   SOFT_RIPPLES_PER_M, WAVES_ASIDE);
    struct pair8 swell = fine_at(ground, &turned, g->covers_m * (WIDE * SOFT_SWELL_PER_M), swell_at,
                                 SOFT_SWELL_PER_M, -WAVES_ASIDE);
    v8f calm = (frame->texture ? WAVE_STEEP * WAVE_HALF_M : 0.0f) / (WAVE_HALF_M + far);
    v8f east = ((ripples.red + swell.red) * TEXEL_OVER - 1.0f) * calm;
    v8f south = ((ripples.green + swell.green) * TEXEL_OVER - 1.0f) * calm;
    v8f over = 1.0f / simd8_sqrt(east * east + south * south + 1.0f);
    n[0] = east * over;
    n[1] = over;
    n[2] = south * over;
    for (uint32_t i = 0; i < 3; i++)
        direction[i] = direction[i] / far;
    v8f facing = simd8_dot3(direction, n);
    for (uint32_t i = 0; i < 3; i++)
        back[i] = direction[i] - 2.0f * facing * n[i];
    back[1] = simd8_max(back[1], simd8_f(0.0f));
    v8f grazing = simd8_clamp(1.0f + facing, 0.0f, 1.0f);
    v8f mirror = 0.04f + 0.80f * (grazing * grazing) * (grazing * grazing);
    v8f glint = simd8_max(simd8_dot3_f(frame->sun, back), simd8_f(0.0f));
    for (uint32_t i = 0; i < 7; i++)
        glint *= glint; /* to the power of 128 */
    back[1] += WAVE_LIFT;
    struct colour8 c = colour_mix(deep, atmosphere_sky(frame, back), mirror);
    c.r += SUN_LIGHT_RED * 1.6f * glint;
    c.g += SUN_LIGHT_GREEN * 1.6f * glint;
    c.b += SUN_LIGHT_BLUE * 1.6f * glint;
    if (!surf || simd8_bits((alpha > 0.005f) & g->mask) == 0)
        return c;
    return colour_mix(c, colour_of(FOAM_WHITE),
                      foam(frame, alpha, swell.red * TEXEL_OVER, ripples.green * TEXEL_OVER));
}

/* Packs a colour of 0..255, or brighter, to bytes with alpha 0. */
SIMD8 v8u bytes_of(struct colour8 c)
{
    v8i r = simd8_round(simd8_min(c.r, simd8_f(255.0f))),
        g = simd8_round(simd8_min(c.g, simd8_f(255.0f)));
    v8i b = simd8_round(simd8_min(c.b, simd8_f(255.0f)));
    return (v8u)(r | g << 8 | b << 16);
}

/* Returns the alpha by which fxaa_rows() finds edges: the ground's depth in quarters of a power of
 * two, and whether it lies in shadow. */
SIMD8 v8u edge_alpha(v8f depth, v8u shadow)
{
    v8i quarters = ((v8i)depth >> 21) - 4 * (127 - 20);
    quarters = simd8_select_i(quarters < 1, simd8_i(1), quarters);
    v8u dark = (v8u)((v8i)(shadow > 127u)) & 128u;
    return ((v8u)quarters | dark) << 24;
}

/* Returns the air in front of the ground. Along one ray the fog grows with the distance as 1 -
 * exp(-distance * fall), which needs no division for each pixel. */
SIMD8 struct atmosphere8 air_before(const struct shading *r, uint32_t step, v8f ahead)
{
    const struct horizon_row *h = &r->horizon;
    v8f far = ahead * h->far[step];
    v8f fog = (r->fog_share * h->far[step]) * (1.0f - simd8_exp2(ahead * r->fog_fall));
    v8f all = fog + r->frame->haze * far, share = 0.5f * fog / simd8_max(all, simd8_f(1e-6f));
    struct atmosphere8 air = {.opacity = 1.0f - simd8_exp_minus(all)};
    struct colour8 white = colour_scale(colour_of(FOG_WHITE), simd8_f(255.0f));
    air.colour.r = h->r[step] + (white.r - h->r[step]) * share;
    air.colour.g = h->g[step] + (white.g - h->g[step]) * share;
    air.colour.b = h->b[step] + (white.b - h->b[step]) * share;
    return air;
}

/* --- the steps -------------------------------------------------------------------------------- */

static void look_up_textures(const struct shading *r, struct ground_queue *w)
{
    for (uint32_t i = w->coloured; i < w->count; i++) {
        struct ground8 *g = &w->ground[i];
        g->at = ground_texture(&r->ground->patches[g->patch], g);
    }
}

static void shade_ground(const struct shading *r, struct ground_queue *w)
{
    for (uint32_t i = w->coloured; i < w->count; i++) {
        struct ground8 *g = &w->ground[i];
        v8f scrub = simd8_clamp((g->at.a * TEXEL_OVER - 0.376f) * (1.0f / 0.624f), 0.0f, 1.0f);
        v8f bright = r->frame->texture ? detail_brightness(r->ground, g, scrub) * (1.0f / 256.0f)
                                       : simd8_f(1.0f / 256.0f);
        struct colour8 dry = {g->at.r * bright, g->at.g * bright, g->at.b * bright}, c = dry;
        const struct soft_patch *patch = &r->ground->patches[g->patch];
        v8f alpha = g->at.a * TEXEL_OVER;
        if (patch->wet && simd8_bits((alpha < SHORE_GROUND) & g->mask) != 0) {
            struct colour8 deep = {g->at.r * TEXEL_OVER, g->at.g * TEXEL_OVER,
                                   g->at.b * TEXEL_OVER};
            c = water(r->ground, r->frame, g, r->rise, deep, alpha, patch->surf);
            c = colour_mix(colour_scale(c, simd8_f(255.0f)), dry,
                           simd8_smoothstep(SHORE_WATER, SHORE_GROUND, alpha));
        }
        g->at.r = c.r;
        g->at.g = c.g;
        g->at.b = c.b;
    }
}

/* Stores one pixel for each point, with shadows. */
SIMD8 void store_pixels(const struct ground8 *g, const struct atmosphere8 *air, uint32_t *colour,
                        const float *depth)
{
    const struct colour8 dark = colour_of(12.75f, 15.3f, 22.95f);
    struct colour8 c = {g->at.r, g->at.g, g->at.b};
    v8u code = simd8_load_u(colour), shadow = (code >> SOFT_SHADOW_BITS) & 255u;
    if (simd8_bits(g->mask & (v8i)(shadow != 0)) != 0)
        c = colour_mix(c, dark, simd8_to_f((v8i)shadow) * (0.5f / 255.0f));
    v8u packed = bytes_of(atmosphere_over(c, air)) | edge_alpha(simd8_load_f(depth), shadow);
    simd8_store_u(colour, simd8_select_u(g->mask, packed, code));
}

/* Interpolates between each point's colour and its neighbour's. */
SIMD8 v8u interpolate(const struct colour8 *c, const struct colour8 *beside, float share)
{
    return bytes_of(colour_mix(*c, *beside, simd8_f(share)));
}

/* Returns each point's left neighbour. That of the first is the last of before, or, where there is
 * none, extrapolated. */
SIMD8 v8f to_left(v8f v, const v8f *before)
{
    v8f moved = __builtin_shufflevector(v, v, 0, 0, 1, 2, 3, 4, 5, 6);
    moved[0] = before != NULL ? (*before)[LANES - 1] : 2.0f * v[0] - v[1];
    return moved;
}

SIMD8 v8f to_right(v8f v, const v8f *after)
{
    v8f moved = __builtin_shufflevector(v, v, 1, 2, 3, 4, 5, 6, 7, 7);
    moved[LANES - 1] = after != NULL ? (*after)[0] : 2.0f * v[LANES - 1] - v[LANES - 2];
    return moved;
}

SIMD8 void store_sixteen(v8u even, v8u odd, uint32_t *colour, const float *depth)
{
    v8u low = __builtin_shufflevector(even, odd, 0, 8, 1, 9, 2, 10, 3, 11);
    v8u high = __builtin_shufflevector(even, odd, 4, 12, 5, 13, 6, 14, 7, 15);
    simd8_store_u(colour, low | edge_alpha(simd8_load_f(depth), simd8_u(0u)));
    simd8_store_u(colour + LANES, high | edge_alpha(simd8_load_f(depth + LANES), simd8_u(0u)));
}

/* Stores two or four pixels for each point. */
SIMD8 void store_interpolated(const struct ground8 *g, const struct texels8 *before,
                              const struct texels8 *after, uint32_t *colour, const float *depth)
{
    struct colour8 c = {g->at.r, g->at.g, g->at.b};
    struct colour8 left = {to_left(c.r, before ? &before->r : NULL),
                           to_left(c.g, before ? &before->g : NULL),
                           to_left(c.b, before ? &before->b : NULL)};
    struct colour8 right = {to_right(c.r, after ? &after->r : NULL),
                            to_right(c.g, after ? &after->g : NULL),
                            to_right(c.b, after ? &after->b : NULL)};
    if (g->rate == 2) {
        store_sixteen(interpolate(&c, &left, 0.25f), interpolate(&c, &right, 0.25f), colour, depth);
        return;
    }
    v8u first = interpolate(&c, &left, 0.375f), second = interpolate(&c, &left, 0.125f);
    v8u third = interpolate(&c, &right, 0.125f), fourth = interpolate(&c, &right, 0.375f);
    v8u odd = __builtin_shufflevector(first, third, 0, 8, 1, 9, 2, 10, 3, 11);
    v8u even = __builtin_shufflevector(second, fourth, 0, 8, 1, 9, 2, 10, 3, 11);
    store_sixteen(odd, even, colour, depth);
    odd = __builtin_shufflevector(first, third, 4, 12, 5, 13, 6, 14, 7, 15);
    even = __builtin_shufflevector(second, fourth, 4, 12, 5, 13, 6, 14, 7, 15);
    store_sixteen(odd, even, colour + 2 * LANES, depth + 2 * LANES);
}

/* Returns true if both groups have several pixels a point and are adjacent. */
SIMD8 bool are_adjacent(const struct ground8 *a, const struct ground8 *b)
{
    return a->rate > 1 && b->rate > 1 && a->x + a->rate * LANES == b->x;
}

/* Stores the pixels of the groups before end. */
static void store_groups(const struct shading *r, struct ground_queue *w, uint32_t end,
                         uint32_t *colour, const float *depth)
{
    struct ground8 *all = w->ground;
    for (uint32_t i = w->coloured; i < w->count; i++) {
        struct ground8 *g = &all[i];
        struct atmosphere8 air = air_before(r, g->x / LANES + g->rate / 2, g->ahead);
        if (g->rate == 1) {
            store_pixels(g, &air, colour + g->x, depth + g->x);
            continue;
        }
        struct colour8 c = atmosphere_over((struct colour8){g->at.r, g->at.g, g->at.b}, &air);
        g->at = (struct texels8){c.r, c.g, c.b, air.opacity};
    }
    for (uint32_t i = w->drawn; i < end; i++) {
        bool before = i > 0 && are_adjacent(&all[i - 1], &all[i]);
        bool after = i + 1 < w->count && are_adjacent(&all[i], &all[i + 1]);
        if (all[i].rate > 1)
            store_interpolated(&all[i], before ? &all[i - 1].at : NULL,
                               after ? &all[i + 1].at : NULL, colour + all[i].x, depth + all[i].x);
    }
}

/* Shades and stores the queued groups. Unless the row ends, a last group with several pixels a
 * point stays queued until its right neighbour is known. */
static void flush_queue(const struct shading *r, struct ground_queue *w, bool ends,
                        uint32_t *colour, const float *depth)
{
    look_up_textures(r, w);
    shade_ground(r, w);
    bool waits = !ends && w->ground[w->count - 1].rate > 1;
    store_groups(r, w, waits ? w->count - 1 : w->count, colour, depth);
    if (waits) {
        w->ground[0] = w->ground[w->count - 2];
        w->ground[1] = w->ground[w->count - 1];
    }
    w->count = w->coloured = waits ? 2 : 0;
    w->drawn = waits ? 1 : 0;
}

/* Returns how much ground a pixel covers along the view [m]; code: the slope of its depth. */
SIMD8 float covered(const struct shading *r, uint32_t code, float ahead, float far)
{
    float across = ahead * r->frame->pixel_m, along = soft_steepness(code) * ahead * far;
    return along > across ? along : across;
}

/* Queues eight ground pixels, once for each patch among them, which is mostly one. */
SIMD8 void queue_pixels(const struct shading *r, struct ground_queue *w, uint32_t x, v8i mask,
                        uint32_t *colour, const float *depth)
{
    v8u code = simd8_load_u(colour + x), patch = code & ((1u << SOFT_PATCH_BITS) - 1);
    v8f column = simd8_to_f(simd8_count() + (int32_t)x) + 0.5f;
    v8f ahead = 1.0f / simd8_select(mask, simd8_load_f(depth + x), simd8_f(1.0f));
    for (uint32_t bits = simd8_bits(mask); bits != 0;) {
        int first = __builtin_ctz(bits);
        struct ground8 *g = &w->ground[w->count++];
        g->ahead = ahead;
        g->east = (r->ray[0] + column * r->frame->ray_x[0]) * ahead;
        g->south = (r->ray[2] + column * r->frame->ray_x[2]) * ahead;
        g->mask = mask & ((v8i)patch == (int32_t)patch[first]);
        g->x = x;
        g->rate = 1;
        g->patch = patch[first];
        g->far_m = ahead[first] * r->horizon.far[x / LANES];
        g->covers_m = covered(r, code[first] >> SOFT_PATCH_BITS, ahead[first], g->far_m);
        bits &= ~simd8_bits(g->mask);
        if (w->count == QUEUE_LENGTH)
            flush_queue(r, w, false, colour, depth);
    }
}

/* The greatest ratio of depths between pixels that are interpolated. */
#define MIX_DEPTH 1.2f

/* The width of texels [pixel] from which every second or fourth pixel is enough. */
#define BROAD_FOR_2 1.3f
#define BROAD_FOR_4 2.6f

/* Returns the mean depth of each pair of sixteen pixels. */
SIMD8 v8f mean_of_pairs(v8f a, v8f b)
{
    return 0.5f * (__builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14) +
                   __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15));
}

/* Returns the width [m] of a texel of the finest texture that will be looked up. Waves are no finer
 * than the detail texture. */
SIMD8 float texel_width(const struct soft_patch *patch, float far, float covers)
{
    int32_t mip = power_of_2(tile_texels(far, covers, 1.0f) * patch->per_m);
    float broad = (float)(1u << (mip < 0 ? 0 : mip > 5 ? 5 : mip)) / patch->per_m;
    if (far >= FINE_FADED_M && !patch->wet)
        return broad;
    mip = fine_mip(SHARP * covers * (WIDE * FINE_PER_M));
    return fminf(broad, (float)(1u << mip) * (1.0f / (WIDE * FINE_PER_M)));
}

/* Returns true if rate * 8 pixels belong to one smooth piece of ground without shadow. mean: the
 * mean depth of each two or four of them. */
SIMD8 bool is_smooth(uint32_t rate, const uint32_t *colour, const float *depth, v8f *mean)
{
    const v8u same = simd8_u(~(((1u << SOFT_STEEP_BITS) - 1) << SOFT_PATCH_BITS));
    float middle = depth[LANES];
    v8f at[4], least = simd8_f(middle), most = least;
    v8u other = simd8_u(0u);
    for (uint32_t i = 0; i < rate; i++) {
        at[i] = simd8_load_f(depth + i * LANES);
        least = simd8_min(least, at[i]);
        most = simd8_max(most, at[i]);
        other |= (simd8_load_u(colour + i * LANES) ^ colour[LANES]) & same;
    }
    *mean = mean_of_pairs(at[0], at[1]);
    if (rate == 4)
        *mean = mean_of_pairs(*mean, mean_of_pairs(at[2], at[3]));
    return simd8_bits((v8i)(other != 0u) | (most > MIX_DEPTH * middle) |
                      (least * MIX_DEPTH < middle) | (least == 0.0f)) == 0;
}

/* Queues 16 or 32 pixels together if they are smooth and their texels wide enough. Returns their
 * number, or 0. */
SIMD8 uint32_t queue_smooth_pixels(const struct shading *r, struct ground_queue *w, uint32_t x,
                                   uint32_t *colour, const float *depth)
{
    uint32_t code = colour[x + LANES], patch = code & ((1u << SOFT_PATCH_BITS) - 1);
    if (x + 2 * LANES > r->frame->width || code >> SOFT_SHADOW_BITS != 0 ||
        depth[x + LANES] <= 0.0f)
        return 0;
    float ahead = 1.0f / depth[x + LANES], far = ahead * r->horizon.far[x / LANES + 1];
    float covers = covered(r, code >> SOFT_PATCH_BITS, ahead, far);
    float broad = texel_width(&r->ground->patches[patch], far, covers);
    float across = ahead * r->frame->pixel_m;
    uint32_t rate = 4;
    v8f mean;
    if (x + 4 * LANES > r->frame->width || broad < BROAD_FOR_4 * across ||
        !is_smooth(4, colour + x, depth + x, &mean))
        rate = 2;
    if (rate == 2 && (broad < BROAD_FOR_2 * across || !is_smooth(2, colour + x, depth + x, &mean)))
        return 0;
    v8f column = simd8_to_f(simd8_count() * (int32_t)rate + (int32_t)x) + 0.5f * (float)rate;
    struct ground8 *g = &w->ground[w->count++];
    g->ahead = 1.0f / mean;
    g->east = (r->ray[0] + column * r->frame->ray_x[0]) * g->ahead;
    g->south = (r->ray[2] + column * r->frame->ray_x[2]) * g->ahead;
    g->mask = simd8_i(-1);
    g->x = x;
    g->rate = rate;
    g->patch = patch;
    g->far_m = far;
    g->covers_m = covers;
    if (w->count == QUEUE_LENGTH)
        flush_queue(r, w, false, colour, depth);
    return rate * LANES;
}

/* --- sky -------------------------------------------------------------------------------------- */

/* Returns the glow around the sun. Its disc needs a higher resolution: see sky_pixels(). */
SIMD8 struct colour8 sun_glow(v8f sun)
{
    v8f s32 = sun;
    for (uint32_t i = 0; i < 5; i++)
        s32 *= s32;
    v8f s256 = s32 * s32;
    s256 *= s256;
    s256 *= s256;
    return colour_scale(colour_of(SUN_WARM), 0.20f * s32 + 0.30f * s256);
}

/* Returns the sky's colour along rays. sun: the cosine of their angle to the sun. */
static struct colour8 sky_at(const struct soft_ground *ground, const struct soft_frame *frame,
                             const v8f ray[3], v8f *sun)
{
    v8f over = 1.0f / simd8_sqrt(simd8_dot3(ray, ray)), direction[3];
    for (uint32_t i = 0; i < 3; i++)
        direction[i] = ray[i] * over;
    struct colour8 c = atmosphere_sky(frame, direction);
    *sun = simd8_max(simd8_dot3_f(frame->sun, direction), simd8_f(0.0f));
    struct colour8 glow = sun_glow(*sun);
    c = colour_add(c, glow);
    v8f near = 1.0f / (simd8_max(direction[1], simd8_f(0.0f)) + 0.12f), x = direction[0] * near,
        z = direction[2] * near;
    float t = frame->time_s;
    v8f broad = texel_cloud(ground->clouds, x * 0.11f + 0.0004f * t, z * 0.11f + 0.0004f * t);
    v8f fine = texel_cloud(ground->clouds, x * 0.47f + 0.0007f * t, z * 0.47f + 0.0007f * t);
    v8f cloud = simd8_smoothstep(0.50f, 0.78f, 0.68f * broad + 0.36f * fine);
    cloud *= 0.72f * simd8_smoothstep(0.02f, 0.16f, direction[1]);
    struct colour8 lit =
        colour_mix(colour_of(CLOUD_SHADE), colour_of(CLOUD_LIT), 0.4f + 0.6f * fine);
    lit = colour_add(lit, colour_scale(glow, simd8_f(0.5f)));
    struct atmosphere8 air = atmosphere_before_sky(frame, direction);
    return atmosphere_over(colour_mix(c, lit, cloud), &air);
}

/* Computes the rays of every eighth pixel of a row, from column x on. */
SIMD8 void rays_at(const struct soft_frame *frame, float x, float y, v8f ray[3])
{
    v8f column = simd8_to_f(simd8_count()) * (float)LANES + x;
    for (uint32_t i = 0; i < 3; i++)
        ray[i] = frame->ray[i] + y * frame->ray_y[i] + column * frame->ray_x[i];
}

static void fill_sky(const struct shading *r, struct sky_row *row, int32_t y)
{
    for (uint32_t step = 0; step * LANES < r->frame->width + LANES; step += LANES) {
        v8f ray[3], sun;
        rays_at(r->frame, (float)(step * LANES), (float)y, ray);
        struct colour8 c = colour_scale(sky_at(r->ground, r->frame, ray, &sun), simd8_f(255.0f));
        simd8_store_f(row->sun + step, sun);
        simd8_store_f(row->r + step, c.r);
        simd8_store_f(row->g + step, c.g);
        simd8_store_f(row->b + step, c.b);
    }
    row->y = y;
}

static void fill_horizon(struct shading *r, int32_t y)
{
    struct horizon_row *row = &r->horizon;
    for (uint32_t step = 0; step * LANES < r->frame->width; step += LANES) {
        v8f ray[3];
        rays_at(r->frame, (float)(step * LANES) + 0.5f * LANES, (float)y + 0.5f * STEP_ROWS, ray);
        struct colour8 c =
            colour_scale(atmosphere_horizon(r->frame, ray[0], ray[2]), simd8_f(255.0f));
        simd8_store_f(row->r + step, c.r);
        simd8_store_f(row->g + step, c.g);
        simd8_store_f(row->b + step, c.b);
        simd8_store_f(row->far + step, simd8_sqrt(simd8_dot3(ray, ray)));
    }
    row->y = y;
}

SIMD8 v8f sky_mix(const float *above, const float *below, v8f across, float down)
{
    float left = above[0] + (below[0] - above[0]) * down;
    float right = above[1] + (below[1] - above[1]) * down;
    return left + across * (right - left);
}

/* Returns how much of the sun's disc eight pixels see, without clouds and fog. */
SIMD8 v8f sun_disc(const struct soft_frame *frame, uint32_t x, int32_t y)
{
    v8f ray[3], column = simd8_to_f(simd8_count()) + ((float)x + 0.5f);
    for (uint32_t i = 0; i < 3; i++)
        ray[i] = frame->ray[i] + ((float)y + 0.5f) * frame->ray_y[i] + column * frame->ray_x[i];
    v8f sun = simd8_dot3_f(frame->sun, ray);
    sun /= simd8_sqrt(simd8_dot3(ray, ray));
    return simd8_clamp((sun - SUN_EDGE) * (1.0f / (SUN_WHOLE - SUN_EDGE)), 0.0f, 1.0f);
}

static void sky_pixels(struct shading *r, uint32_t x, int32_t y, v8i mask, uint32_t *colour)
{
    int32_t first = y & -STEP_ROWS;
    if (r->below.y == first)
        r->above = r->below;
    if (r->above.y != first)
        fill_sky(r, &r->above, first);
    if (r->below.y != first + STEP_ROWS)
        fill_sky(r, &r->below, first + STEP_ROWS);
    uint32_t step = x / LANES;
    v8f across = (simd8_to_f(simd8_count()) + 0.5f) * (1.0f / LANES);
    float down = ((float)(y - first) + 0.5f) * (1.0f / STEP_ROWS);
    struct colour8 c = {sky_mix(r->above.r + step, r->below.r + step, across, down),
                        sky_mix(r->above.g + step, r->below.g + step, across, down),
                        sky_mix(r->above.b + step, r->below.b + step, across, down)};
    if (r->above.sun[step] > SUN_NEAR) {
        v8f disc = 255.0f * sun_disc(r->frame, x, y);
        struct colour8 sun = colour_scale(colour_of(SUN_WARM), disc);
        c = colour_add(c, sun);
    }
    simd8_store_u(colour, simd8_select_u(mask, bytes_of(c), simd8_load_u(colour)));
}

/* --- rows ------------------------------------------------------------------------------------- */

static void begin_row(struct shading *r, int32_t y)
{
    const struct soft_frame *f = r->frame;
    for (uint32_t i = 0; i < 3; i++)
        r->ray[i] = f->ray[i] + ((float)y + 0.5f) * f->ray_y[i];
    if (r->horizon.y != (y & -STEP_ROWS))
        fill_horizon(r, y & -STEP_ROWS);
    /* A nearly level ray is treated as rising slightly, since the fog divides by the rise. */
    float rise = r->ray[1] + 0.5f * (float)f->width * f->ray_x[1];
    rise = rise > 1e-3f || rise < -1e-3f ? rise : rise < 0.0f ? -1e-3f : 1e-3f;
    r->rise = rise;
    r->fog_share = f->fog / (rise * f->fog_fall);
    r->fog_fall = -1.44269504f * rise * f->fog_fall;
}

static void shade_row(struct shading *r, uint32_t *colour, const float *depth, int32_t y)
{
    struct ground_queue queue;
    queue.count = queue.coloured = queue.drawn = 0;
    begin_row(r, y);
    for (uint32_t x = 0; x < r->frame->width;) {
        v8i unshaded = (v8i)((simd8_load_u(colour + x) >> 24) == 0);
        v8i on_ground = unshaded & (simd8_load_f(depth + x) > 0.0f), sky = unshaded & ~on_ground;
        if (simd8_bits(on_ground) == 255) {
            uint32_t done = queue_smooth_pixels(r, &queue, x, colour, depth);
            if (done > 0) {
                x += done;
                continue;
            }
        }
        if (simd8_bits(sky) != 0)
            sky_pixels(r, x, y, sky, colour + x);
        if (simd8_bits(on_ground) != 0)
            queue_pixels(r, &queue, x, on_ground, colour, depth);
        x += LANES;
    }
    flush_queue(r, &queue, true, colour, depth);
}

void KERNEL(soft_shade_fill)(const struct soft_ground *ground, const struct soft_frame *frame,
                             const struct soft_target *target)
{
    struct shading r = {.ground = ground,
                        .frame = frame,
                        .horizon = {.y = -1},
                        .above = {.y = -1},
                        .below = {.y = -1}};
    for (int32_t y = target->first; y < target->end; y++) {
        size_t row = (size_t)(y - target->first) * target->stride;
        shade_row(&r, target->colour + row, target->depth + row, y);
    }
}
