/* Computed textures. */
#include "renderer/scene/texture.h"

#include "renderer/scene/grain.h"

#include <math.h>

static uint8_t byte_of(float v)
{
    return (uint8_t)(fminf(1.0f, fmaxf(0.0f, v)) * 255.0f + 0.5f);
}

/* Noise of `cells` cells over the unit square that meets itself at the edges. */
static float wrapped(float x, float y, int32_t cells, uint32_t seed)
{
    float fx = floorf(x * (float)cells), fy = floorf(y * (float)cells);
    float u = x * (float)cells - fx, v = y * (float)cells - fy;
    int32_t x0 = (int32_t)fx % cells, y0 = (int32_t)fy % cells;
    int32_t x1 = (x0 + 1) % cells, y1 = (y0 + 1) % cells;
    u = u * u * (3.0f - 2.0f * u);
    v = v * v * (3.0f - 2.0f * v);
    float top = grain_unit(x0, y0, seed) * (1.0f - u) + grain_unit(x1, y0, seed) * u;
    float low = grain_unit(x0, y1, seed) * (1.0f - u) + grain_unit(x1, y1, seed) * u;
    return top + (low - top) * v;
}

static float wrapped_octaves(float x, float y, int32_t cells, uint32_t octaves, uint32_t seed)
{
    float sum = 0.0f, strength = 0.5f, all = 0.0f;
    for (uint32_t i = 0; i < octaves; i++) {
        sum += strength * wrapped(x, y, cells << i, seed + i);
        all += strength;
        strength *= 0.5f;
    }
    return sum / all;
}

void texture_detail(uint8_t (*texels)[2])
{
    float side = (float)TEXTURE_DETAIL_SIDE;
    for (uint32_t row = 0; row < TEXTURE_DETAIL_SIDE; row++)
        for (uint32_t column = 0; column < TEXTURE_DETAIL_SIDE; column++) {
            float x = (float)column / side, y = (float)row / side;
            /* Grass: clumps, bare spots between them, and blades. */
            float clumps = wrapped_octaves(x, y, 9, 4, 401);
            float blades = wrapped(x, y, 128, 411) * 0.6f + wrapped(x, y, 256, 412) * 0.4f;
            float bare = fmaxf(0.0f, wrapped_octaves(x, y, 17, 3, 421) - 0.58f) * 2.2f;
            float grass =
                0.5f + 0.85f * (clumps - 0.5f) + 0.50f * (blades - 0.5f) + 0.5f * bare - 0.06f;
            /* Scrub: round dark bushes on paler ground. */
            float bush = wrapped_octaves(x, y, 13, 3, 431);
            float crown = fminf(1.0f, fmaxf(0.0f, (bush - 0.42f) * 6.0f));
            float leaves = wrapped_octaves(x, y, 64, 3, 441) - 0.5f;
            float scrub = 0.70f - 0.36f * crown + 0.55f * leaves;
            uint8_t *texel = texels[row * TEXTURE_DETAIL_SIDE + column];
            texel[0] = byte_of(grass);
            texel[1] = byte_of(scrub);
        }
}

void texture_clouds(uint8_t *texels)
{
    float side = (float)TEXTURE_CLOUD_SIDE;
    for (uint32_t row = 0; row < TEXTURE_CLOUD_SIDE; row++)
        for (uint32_t column = 0; column < TEXTURE_CLOUD_SIDE; column++)
            texels[row * TEXTURE_CLOUD_SIDE + column] =
                byte_of(wrapped_octaves((float)column / side, (float)row / side, 4, 6, 501));
}

static float smoke(float x, float y, uint32_t which, float *shade)
{
    float out = sqrtf(x * x + y * y);
    float bulge = wrapped_octaves(0.5f + 0.45f * x, 0.5f + 0.45f * y, 4, 4, 601 + 17 * which);
    float body = 1.0f - out + 0.95f * (bulge - 0.5f);
    float thick = fminf(1.0f, fmaxf(0.0f, body * 1.7f));
    /* As if it were a lumpy ball lit from above. */
    float above =
        wrapped_octaves(0.5f + 0.45f * x, 0.5f + 0.45f * (y + 0.09f), 4, 4, 601 + 17 * which);
    *shade = 0.50f + 0.17f * y + 1.3f * (bulge - above);
    return thick * thick * (3.0f - 2.0f * thick) * fminf(1.0f, fmaxf(0.0f, (1.0f - out) * 4.0f));
}

static float flame(float x, float y, uint32_t which, float *shade)
{
    float up = 0.5f + 0.5f * y; /* 0 at the foot */
    float lick = wrapped_octaves(0.5f + 0.4f * x, 0.5f + 0.4f * y, 4, 3, 701 + 13 * which) - 0.5f;
    float half = 0.62f * sqrtf(up + 0.02f) * (1.0f - up) * 2.0f;
    float edge = 1.0f - fabsf(x + 0.5f * lick * up) / fmaxf(half, 0.02f);
    *shade = 0.45f + 0.35f * fminf(1.0f, fmaxf(0.0f, edge)) - 0.15f * up;
    float fade = fminf(1.0f, fmaxf(0.0f, 3.0f * edge + 2.0f * lick));
    return fade * fminf(1.0f, 6.0f * up) * fminf(1.0f, fmaxf(0.0f, 5.0f * (1.0f - up)));
}

void texture_puff(uint8_t (*texels)[2], enum puff_picture picture)
{
    float side = (float)TEXTURE_PUFF_SIDE;
    for (uint32_t row = 0; row < TEXTURE_PUFF_SIDE; row++)
        for (uint32_t column = 0; column < TEXTURE_PUFF_SIDE; column++) {
            float x = 2.0f * ((float)column + 0.5f) / side - 1.0f;
            float y = 1.0f - 2.0f * ((float)row + 0.5f) / side;
            float shade = 0.5f, much;
            if (picture == PUFF_GLOW) {
                float left = fmaxf(0.0f, 1.0f - sqrtf(x * x + y * y));
                much = left * left * (0.45f + 0.55f * left * left);
            } else if (picture == PUFF_FLAME_A || picture == PUFF_FLAME_B) {
                much = flame(x, y, (uint32_t)(picture - PUFF_FLAME_A), &shade);
            } else {
                much = smoke(x, y, (uint32_t)picture, &shade);
            }
            uint8_t *texel = texels[row * TEXTURE_PUFF_SIDE + column];
            texel[0] = byte_of(much);
            texel[1] = byte_of(shade);
        }
}
