/* Computes the textures. */
#include "renderer/scene/draw_list/texture.h"

#include "renderer/scene/noise/value_noise.h"

#include <math.h>
#include <stdbool.h>

#define SIDE_MAX    TEXTURE_DETAIL_SIDE
#define CELLS_MAX   256
#define OCTAVES_MAX 6

_Static_assert(TEXTURE_CLOUD_SIDE <= SIDE_MAX && TEXTURE_PARTICLE_SIDE <= SIDE_MAX, "room of rows");

/* Clamps to 0..1. */
static float unit(float v)
{
    v = v > 0.0f ? v : 0.0f;
    return v < 1.0f ? v : 1.0f;
}

static uint8_t byte_of(float v)
{
    return (uint8_t)(unit(v) * 255.0f + 0.5f);
}

/* --- noise, row by row ------------------------------------------------------------------------ */

/* Value noise of `cells` cells over the unit square that repeats without a seam. Holds the values
 * that all rows share and the two lattice rows around the current row. */
struct noise {
    int32_t cells, row;
    uint32_t seed, count;
    uint16_t cell[SIDE_MAX]; /* cell of each texel; along: position in the cell */
    float along[SIDE_MAX];
    float upper[CELLS_MAX + 1], lower[CELLS_MAX + 1];
};

static float eased(float t)
{
    return t * t * (3.0f - 2.0f * t);
}

/* x: of each texel, 0..1. */
static void noise_begin(struct noise *noise, const float *x, uint32_t count, int32_t cells,
                        uint32_t seed)
{
    noise->cells = cells;
    noise->row = -1;
    noise->seed = seed;
    noise->count = count;
    for (uint32_t i = 0; i < count; i++) {
        float at = x[i] * (float)cells;
        int32_t cell = (int32_t)at;
        noise->cell[i] = (uint16_t)(cell % cells);
        noise->along[i] = eased(at - (float)cell);
    }
}

static void noise_row(struct noise *noise, float y, float *to)
{
    int32_t cells = noise->cells, row = (int32_t)(y * (float)cells);
    float down = eased(y * (float)cells - (float)row);
    if (row != noise->row)
        for (int32_t i = 0; i <= cells; i++) {
            noise->upper[i] = value_noise_unit(i % cells, row % cells, noise->seed);
            noise->lower[i] = value_noise_unit(i % cells, (row + 1) % cells, noise->seed);
        }
    noise->row = row;
    for (uint32_t i = 0; i < noise->count; i++) {
        const float *upper = noise->upper + noise->cell[i], *lower = noise->lower + noise->cell[i];
        float u = noise->along[i], back = 1.0f - u;
        float top = upper[0] * back + upper[1] * u, low = lower[0] * back + lower[1] * u;
        to[i] = top + (low - top) * down;
    }
}

/* Noises whose cells become smaller by half each. */
struct octaves {
    uint32_t count;
    struct noise noise[OCTAVES_MAX];
};

static void octaves_begin(struct octaves *octaves, const float *x, uint32_t count, int32_t cells,
                          uint32_t many, uint32_t seed)
{
    octaves->count = many;
    for (uint32_t i = 0; i < many; i++)
        noise_begin(&octaves->noise[i], x, count, cells << i, seed + i);
}

static void octaves_row(struct octaves *octaves, float y, float *to)
{
    float one[SIDE_MAX], strength = 0.5f, all = 0.0f;
    uint32_t count = octaves->noise[0].count;
    for (uint32_t i = 0; i < count; i++)
        to[i] = 0.0f;
    for (uint32_t k = 0; k < octaves->count; k++) {
        noise_row(&octaves->noise[k], y, one);
        for (uint32_t i = 0; i < count; i++)
            to[i] += strength * one[i];
        all += strength;
        strength *= 0.5f;
    }
    for (uint32_t i = 0; i < count; i++)
        to[i] /= all;
}

/* Fills x with the positions of texels that begin at 0. */
static void places(float *x, uint32_t side)
{
    for (uint32_t i = 0; i < side; i++)
        x[i] = (float)i / (float)side;
}

/* --- the ground and the sky ------------------------------------------------------------------- */

void texture_detail(uint8_t (*texels)[2])
{
    enum { SIDE = TEXTURE_DETAIL_SIDE };
    float x[SIDE], clumps[SIDE], blades[SIDE], finest[SIDE], bare[SIDE], bush[SIDE], leaves[SIDE];
    struct octaves clump, spot, crown, leaf;
    struct noise blade, fine;
    places(x, SIDE);
    octaves_begin(&clump, x, SIDE, 9, 4, 401);
    noise_begin(&blade, x, SIDE, 128, 411);
    noise_begin(&fine, x, SIDE, 256, 412);
    octaves_begin(&spot, x, SIDE, 17, 3, 421);
    octaves_begin(&crown, x, SIDE, 13, 3, 431);
    octaves_begin(&leaf, x, SIDE, 64, 3, 441);
    for (uint32_t row = 0; row < SIDE; row++) {
        octaves_row(&clump, x[row], clumps);
        noise_row(&blade, x[row], blades);
        noise_row(&fine, x[row], finest);
        octaves_row(&spot, x[row], bare);
        octaves_row(&crown, x[row], bush);
        octaves_row(&leaf, x[row], leaves);
        for (uint32_t i = 0; i < SIDE; i++, texels++) {
            /* Grass: clumps, bare spots between them, and blades. */
            float blown = blades[i] * 0.6f + finest[i] * 0.4f;
            float worn = (bare[i] > 0.58f ? bare[i] - 0.58f : 0.0f) * 2.2f;
            float grass =
                0.5f + 0.85f * (clumps[i] - 0.5f) + 0.50f * (blown - 0.5f) + 0.5f * worn - 0.06f;
            /* Scrub: round dark bushes on paler ground. */
            float dark = unit((bush[i] - 0.42f) * 6.0f);
            float scrub = 0.70f - 0.36f * dark + 0.55f * (leaves[i] - 0.5f);
            (*texels)[0] = byte_of(grass);
            (*texels)[1] = byte_of(scrub);
        }
    }
}

void texture_clouds(uint8_t *texels)
{
    float x[TEXTURE_CLOUD_SIDE], thick[TEXTURE_CLOUD_SIDE];
    struct octaves octaves;
    places(x, TEXTURE_CLOUD_SIDE);
    octaves_begin(&octaves, x, TEXTURE_CLOUD_SIDE, 4, 6, 501);
    for (uint32_t row = 0; row < TEXTURE_CLOUD_SIDE; row++) {
        octaves_row(&octaves, x[row], thick);
        for (uint32_t i = 0; i < TEXTURE_CLOUD_SIDE; i++)
            *texels++ = byte_of(thick[i]);
    }
}

/* --- particles -------------------------------------------------------------------------------- */

/* above: the noise a little higher in the picture. */
static float smoke(float x, float y, float bulge, float above, float *shade)
{
    float out = sqrtf(x * x + y * y);
    float body = 1.0f - out + 0.95f * (bulge - 0.5f);
    float thick = unit(body * 1.7f);
    /* The shade is that of a lumpy ball lit from above. */
    *shade = 0.50f + 0.17f * y + 1.3f * (bulge - above);
    return thick * thick * (3.0f - 2.0f * thick) * unit((1.0f - out) * 4.0f);
}

static float flame(float x, float y, float noise, float *shade)
{
    float up = 0.5f + 0.5f * y; /* 0 at the foot */
    float lick = noise - 0.5f;
    float half = 0.62f * sqrtf(up + 0.02f) * (1.0f - up) * 2.0f;
    float edge = 1.0f - fabsf(x + 0.5f * lick * up) / fmaxf(half, 0.02f);
    *shade = 0.45f + 0.35f * unit(edge) - 0.15f * up;
    float fade = unit(3.0f * edge + 2.0f * lick);
    return fade * fminf(1.0f, 6.0f * up) * unit(5.0f * (1.0f - up));
}

/* Clods or drops: dense at the foot, streaks and specks towards the top. */
static float spray(float x, float y, float streaks, float specks, float *shade)
{
    float up = 0.5f + 0.5f * y, out = fabsf(x);
    float half = 0.45f + 0.40f * up, edge = 1.0f - out / half;
    float body = 1.5f * edge + 0.9f * (streaks - 0.5f) + 2.0f * (specks - 0.5f) - 0.9f * up + 0.15f;
    *shade = 0.42f + 0.30f * (specks - 0.5f) + 0.16f * up;
    float thick = unit(1.6f * body);
    return thick * unit(edge * 4.0f) * fminf(1.0f, 7.0f * up) * fminf(1.0f, 5.0f * (1.0f - up));
}

/* Blades cover a larger share of the circle near the hub; their tips are coloured. */
static float disc(float out)
{
    float tips = out > 0.93f ? 0.35f : 0.0f;
    return (0.35f + 0.35f * (1.0f - out) + tips) * fminf(1.0f, fmaxf(0.0f, (1.0f - out) * 32.0f));
}

static float glow(float out)
{
    float left = fmaxf(0.0f, 1.0f - out);
    return left * left * (0.45f + 0.55f * left * left);
}

/* The two noises that a particle's picture is made of. */
struct particle_noise {
    struct octaves first, second;
    float spread; /* half the sampled width of the unit square */
};

static void particle_noise_begin(struct particle_noise *noise, const float *x,
                                 enum particle_picture picture)
{
    bool flames = picture == PARTICLE_FLAME_A || picture == PARTICLE_FLAME_B;
    uint32_t side = TEXTURE_PARTICLE_SIDE, which = (uint32_t)picture;
    float at[TEXTURE_PARTICLE_SIDE];
    noise->spread = picture == PARTICLE_SPRAY ? 0.5f : flames ? 0.4f : 0.45f;
    for (uint32_t i = 0; i < side; i++)
        at[i] = 0.5f + noise->spread * x[i];
    if (picture == PARTICLE_SPRAY) {
        octaves_begin(&noise->first, at, side, 16, 1, 801);
        octaves_begin(&noise->second, at, side, 16, 3, 811);
    } else if (flames) {
        octaves_begin(&noise->first, at, side, 4, 3, 701 + 13 * (which - PARTICLE_FLAME_A));
        noise->second.count = 0;
    } else {
        octaves_begin(&noise->first, at, side, 4, 4, 601 + 17 * which);
        octaves_begin(&noise->second, at, side, 4, 4, 601 + 17 * which);
    }
}

static void particle_noise_row(struct particle_noise *noise, float y, enum particle_picture picture,
                               float *first, float *second)
{
    float up = 0.5f + 0.5f * y, higher = y + 0.09f;
    octaves_row(&noise->first, picture == PARTICLE_SPRAY ? 0.25f * up : 0.5f + noise->spread * y,
                first);
    if (noise->second.count > 0)
        octaves_row(&noise->second,
                    picture == PARTICLE_SPRAY ? 0.5f * up : 0.5f + noise->spread * higher, second);
}

void texture_particle(uint8_t (*texels)[2], enum particle_picture picture)
{
    enum { SIDE = TEXTURE_PARTICLE_SIDE };
    float across[SIDE], first[SIDE], second[SIDE];
    bool plain = picture == PARTICLE_GLOW || picture == PARTICLE_DISC;
    struct particle_noise noise;
    for (uint32_t i = 0; i < SIDE; i++)
        across[i] = 2.0f * ((float)i + 0.5f) / (float)SIDE - 1.0f;
    if (!plain)
        particle_noise_begin(&noise, across, picture);
    for (uint32_t row = 0; row < SIDE; row++) {
        float y = 1.0f - 2.0f * ((float)row + 0.5f) / (float)SIDE;
        if (!plain)
            particle_noise_row(&noise, y, picture, first, second);
        for (uint32_t i = 0; i < SIDE; i++, texels++) {
            float x = across[i], shade = 0.5f, much;
            if (picture == PARTICLE_GLOW)
                much = glow(sqrtf(x * x + y * y));
            else if (picture == PARTICLE_DISC)
                much = disc(sqrtf(x * x + y * y));
            else if (picture == PARTICLE_FLAME_A || picture == PARTICLE_FLAME_B)
                much = flame(x, y, first[i], &shade);
            else if (picture == PARTICLE_SPRAY)
                much = spray(x, y, first[i], second[i], &shade);
            else
                much = smoke(x, y, first[i], second[i], &shade);
            (*texels)[0] = byte_of(much);
            (*texels)[1] = byte_of(shade);
        }
    }
}
