/* Draws pictures of plants. Coordinates: x -0.5..0.5 to the right, y 0..1 up, z towards the eye. */
#include "renderer/scene/model/plant_impostors.h"

#include "renderer/scene/noise/value_noise.h"
#include "world/maths/maths.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define SIDE ((float)PLANT_IMPOSTORS_SIDE)

struct tone {
    float r, g, b;
};

struct canvas {
    struct plant_impostors_picture *picture;
    float depth[PLANT_IMPOSTORS_SIDE][PLANT_IMPOSTORS_SIDE];
    uint32_t seed, drawn; /* drawn: number of random numbers used */
    bool blades;          /* grass lets light through, so all its normals point up */
};

/* A lobe of a crown, covered with clumps of leaves. */
struct lobe {
    float x, y, z, rx, ry; /* centre; half width and depth, half height */
};

static const struct tone oak_dark = {0.165f, 0.235f, 0.095f};
static const struct tone oak_light = {0.360f, 0.430f, 0.185f};
static const struct tone valley_dark = {0.235f, 0.300f, 0.115f};
static const struct tone valley_light = {0.480f, 0.530f, 0.245f};
static const struct tone pine_dark = {0.200f, 0.270f, 0.175f};
static const struct tone pine_light = {0.420f, 0.490f, 0.320f};
static const struct tone fir_dark = {0.110f, 0.190f, 0.110f};
static const struct tone fir_light = {0.250f, 0.350f, 0.190f};
static const struct tone bush_dark = {0.230f, 0.260f, 0.130f};
static const struct tone bush_light = {0.450f, 0.450f, 0.240f};
static const struct tone bark = {0.300f, 0.235f, 0.180f};
static const struct tone fresh_wood = {0.720f, 0.560f, 0.360f};
static const struct tone straw_dark = {0.680f, 0.560f, 0.320f};
static const struct tone straw_light = {0.900f, 0.790f, 0.510f};

static float random_unit(struct canvas *c)
{
    return value_noise_unit((int32_t)c->drawn++, 0, c->seed);
}

static float between(struct canvas *c, float low, float high)
{
    return low + (high - low) * random_unit(c);
}

static uint8_t byte_of(float v)
{
    v = v > 0.0f ? v : 0.0f;
    return (uint8_t)((v < 1.0f ? v : 1.0f) * 255.0f + 0.5f);
}

static struct tone tone_mix(struct tone a, struct tone b, float t)
{
    return (struct tone){a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

/* Returns true if a point at this depth would be visible. */
static bool shows(const struct canvas *c, int32_t px, int32_t py, float depth)
{
    return px >= 0 && py >= 0 && px < (int32_t)PLANT_IMPOSTORS_SIDE &&
           py < (int32_t)PLANT_IMPOSTORS_SIDE && depth > c->depth[py][px];
}

static void put(struct canvas *c, int32_t px, int32_t py, float depth, struct tone tone,
                const float normal[3])
{
    if (!shows(c, px, py, depth))
        return;
    c->depth[py][px] = depth;
    uint8_t *colour = c->picture->colour[py][px], *facing = c->picture->facing[py][px];
    colour[0] = byte_of(tone.r);
    colour[1] = byte_of(tone.g);
    colour[2] = byte_of(tone.b);
    colour[3] = 255;
    for (uint32_t i = 0; i < 3; i++)
        facing[i] = (uint8_t)(128.0f + 127.0f * normal[i]);
}

/* Draws a ball of leaves with a ragged rim. lean: normal of the lobe there. */
static void clump(struct canvas *c, float x, float y, float z, float radius, struct tone tone,
                  const float lean[3])
{
    float cx = (x + 0.5f) * SIDE, cy = (1.0f - y) * SIDE, r = radius * SIDE;
    for (int32_t py = (int32_t)(cy - r); py <= (int32_t)(cy + r); py++)
        for (int32_t px = (int32_t)(cx - r); px <= (int32_t)(cx + r); px++) {
            float dx = ((float)px + 0.5f - cx) / r, dy = (cy - (float)py - 0.5f) / r;
            float out = dx * dx + dy * dy;
            if (out >= 1.0f)
                continue;
            float dz = sqrtf(1.0f - out), n[3];
            if (!shows(c, px, py, z + radius * dz) ||
                (out > 0.35f &&
                 out > 0.35f + 0.65f * value_noise_unit(px / 2, py / 2, c->seed ^ 77u)))
                continue;
            n[0] = 0.55f * lean[0] + 0.45f * dx;
            n[1] = 0.55f * lean[1] + 0.45f * dy;
            n[2] = 0.55f * lean[2] + 0.45f * dz;
            float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) + 1e-6f;
            for (uint32_t i = 0; i < 3; i++)
                n[i] /= length;
            float speck = 0.82f + 0.36f * value_noise_unit(px, py, c->seed ^ 99u);
            struct tone leaf = {tone.r * speck, tone.g * speck, tone.b * speck};
            put(c, px, py, z + radius * dz, leaf, n);
        }
}

/* Covers the front of a lobe with clumps. The underside and the hollows are darker. */
static void leafy(struct canvas *c, const struct lobe *lobe, uint32_t clumps, float size,
                  struct tone dark, struct tone light)
{
    for (uint32_t i = 0; i < clumps; i++) {
        float turn = between(c, 0.0f, 6.2831853f), high = between(c, -0.95f, 1.0f);
        float ring = sqrtf(1.0f - high * high);
        double sine, cosine;
        maths_sincos((double)turn, &sine, &cosine);
        float n[3] = {(float)cosine * ring, high, fabsf((float)sine) * ring};
        float in = between(c, 0.78f, 1.02f);
        float x = lobe->x + n[0] * lobe->rx * in, y = lobe->y + n[1] * lobe->ry * in;
        float z = lobe->z + n[2] * lobe->rx * in;
        float shade = 0.25f + 0.45f * (0.5f + 0.5f * high) + 0.3f * random_unit(c);
        shade *= 0.55f + 0.45f * in * in;
        clump(c, x, y, z, size * between(c, 0.7f, 1.35f), tone_mix(dark, light, shade), n);
    }
}

/* Draws a round stick from one point to another. */
static void stick(struct canvas *c, float x0, float y0, float x1, float y1, float thick0,
                  float thick1, struct tone tone)
{
    float along = sqrtf((x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0));
    int32_t steps = (int32_t)(along * SIDE * 1.5f) + 2;
    for (int32_t i = 0; i <= steps; i++) {
        float t = (float)i / (float)steps, half = (thick0 + (thick1 - thick0) * t) * SIDE * 0.5f;
        float cx = (x0 + (x1 - x0) * t + 0.5f) * SIDE, cy = (1.0f - (y0 + (y1 - y0) * t)) * SIDE;
        for (int32_t px = (int32_t)floorf(cx - half); px <= (int32_t)(cx + half); px++) {
            float across = ((float)px + 0.5f - cx) / fmaxf(half, 0.5f);
            if (fabsf(across) > 1.0f)
                continue;
            float rough = 0.8f + 0.4f * value_noise_unit(px, (int32_t)cy / 3, c->seed ^ 5u);
            struct tone wood = {tone.r * rough, tone.g * rough, tone.b * rough};
            float out = sqrtf(1.0f - across * across);
            const float round[3] = {across, 0.0f, out}, up[3] = {0.2f * across, 0.92f, 0.38f};
            put(c, px, (int32_t)cy, 0.02f * out, wood, c->blades ? up : round);
        }
    }
}

static void oak(struct canvas *c, struct tone dark, struct tone light, float spread, float crown)
{
    float fork = crown - 0.10f;
    stick(c, 0.0f, 0.0f, between(c, -0.03f, 0.03f), fork, 0.075f, 0.05f, bark);
    for (int32_t i = -2; i <= 2; i++)
        stick(c, 0.0f, fork - 0.06f, (float)i * 0.15f * spread, fork + between(c, 0.1f, 0.25f),
              0.035f, 0.012f, bark);
    for (uint32_t i = 0; i < 11; i++) {
        float along = ((float)i + 0.5f) / 11.0f * 2.0f - 1.0f;
        float dome = sqrtf(1.0f - 0.8f * along * along);
        struct lobe lobe = {.x = along * 0.36f * spread,
                            .y = crown + between(c, 0.05f, 0.62f * (1.0f - crown)) * dome,
                            .z = between(c, -0.15f, 0.15f) + 0.1f * dome,
                            .rx = between(c, 0.10f, 0.15f) * (0.6f + 0.4f * spread)};
        lobe.ry = lobe.rx * between(c, 0.75f, 0.95f);
        lobe.y = fminf(lobe.y, 0.985f - lobe.ry - 0.02f);
        lobe.x = fmaxf(-0.47f + lobe.rx, fminf(0.47f - lobe.rx, lobe.x));
        leafy(c, &lobe, 90, 0.030f, dark, light);
    }
    struct lobe top = {0.0f, crown + 0.52f * (1.0f - crown), 0.05f, 0.26f * spread,
                       0.44f * (1.0f - crown)};
    leafy(c, &top, 240, 0.030f, dark, light);
}

static void pine(struct canvas *c)
{
    float sway = between(c, -0.06f, 0.06f);
    stick(c, 0.0f, 0.0f, sway, 0.95f, 0.045f, 0.012f, bark);
    for (uint32_t i = 0; i < 40; i++) {
        float y = 0.27f + 0.69f * ((float)i + random_unit(c)) / 41.0f, top = (y - 0.27f) / 0.73f;
        float reach = 0.05f + 0.24f * sqrtf(1.0f - top) * fminf(1.0f, 0.55f + 2.0f * top);
        float x = sway * y + between(c, -1.0f, 1.0f) * reach;
        stick(c, sway * y, y - 0.05f, x, y, 0.014f, 0.006f, bark);
        struct lobe lobe = {x, y - 0.01f, between(c, -0.08f, 0.12f), between(c, 0.055f, 0.085f),
                            between(c, 0.032f, 0.05f)};
        leafy(c, &lobe, 34, 0.020f, pine_dark, pine_light);
    }
}

static void fir(struct canvas *c)
{
    stick(c, 0.0f, 0.0f, 0.0f, 0.97f, 0.05f, 0.01f, bark);
    for (uint32_t i = 0; i < 46; i++) {
        float y = 0.10f + 0.88f * (float)i / 46.0f, reach = 0.30f * (1.0f - y) + 0.012f;
        for (int32_t j = -7; j <= 7; j++) {
            float across = (float)j / 7.0f * between(c, 0.85f, 1.12f), x = across * reach;
            float front = 1.0f - fminf(1.0f, fabsf(across));
            float n[3] = {0.8f * across, 0.25f, 0.25f + 0.6f * front};
            float shade = between(c, 0.05f, 0.95f) * (0.5f + 0.5f * y);
            clump(c, x, y - 0.3f * fabsf(x) + between(c, -0.012f, 0.012f), reach * front,
                  0.013f + 0.012f * (1.0f - y), tone_mix(fir_dark, fir_light, shade), n);
        }
    }
}

static void bush(struct canvas *c)
{
    for (int32_t i = -3; i <= 3; i++)
        stick(c, 0.0f, 0.0f, (float)i * 0.09f, 0.4f, 0.015f, 0.008f, bark);
    for (uint32_t i = 0; i < 12; i++) {
        float along = ((float)i + 0.5f) / 12.0f * 2.0f - 1.0f;
        struct lobe lobe = {along * 0.3f, between(c, 0.14f, 0.62f), between(c, -0.1f, 0.2f),
                            between(c, 0.14f, 0.19f), between(c, 0.15f, 0.25f)};
        lobe.y = fminf(lobe.y, 0.96f - lobe.ry);
        leafy(c, &lobe, 70, 0.036f, bush_dark, bush_light);
    }
}

static void stump(struct canvas *c)
{
    stick(c, 0.0f, 0.0f, 0.0f, 0.75f, 0.62f, 0.5f, bark);
    for (uint32_t i = 0; i < 14; i++) {
        float x = between(c, -0.22f, 0.22f);
        stick(c, x, 0.70f, x + between(c, -0.05f, 0.05f), between(c, 0.78f, 0.98f), 0.06f, 0.01f,
              fresh_wood);
    }
}

static void grass(struct canvas *c)
{
    for (uint32_t i = 0; i < 56; i++) {
        float fan = between(c, -1.0f, 1.0f), x = 0.10f * fan + between(c, -0.05f, 0.05f);
        float bend = 0.34f * fan * fabsf(fan) + between(c, -0.06f, 0.06f);
        float high = between(c, 0.45f, 0.97f) * (1.0f - 0.5f * fan * fan);
        struct tone tone = tone_mix(straw_dark, straw_light, random_unit(c));
        stick(c, x, 0.0f, x + 0.3f * bend, 0.55f * high, 0.022f, 0.018f, tone);
        stick(c, x + 0.3f * bend, 0.55f * high, x + bend, high, 0.018f, 0.006f, tone);
    }
}

/* Gives transparent pixels the mean colour of the others. Otherwise minification would draw dark
 * rims. */
static void bleed(struct plant_impostors_picture *picture)
{
    uint32_t sum[3] = {0, 0, 0}, count = 0;
    for (uint32_t y = 0; y < PLANT_IMPOSTORS_SIDE; y++)
        for (uint32_t x = 0; x < PLANT_IMPOSTORS_SIDE; x++)
            if (picture->colour[y][x][3] != 0) {
                for (uint32_t i = 0; i < 3; i++)
                    sum[i] += picture->colour[y][x][i];
                count++;
            }
    for (uint32_t y = 0; y < PLANT_IMPOSTORS_SIDE && count > 0; y++)
        for (uint32_t x = 0; x < PLANT_IMPOSTORS_SIDE; x++)
            if (picture->colour[y][x][3] == 0)
                for (uint32_t i = 0; i < 3; i++)
                    picture->colour[y][x][i] = (uint8_t)(sum[i] / count);
}

void plant_impostors_paint(struct plant_impostors_picture *picture, enum plant_impostors which)
{
    static struct canvas c;
    c.picture = picture;
    c.seed = 1000u + (uint32_t)which;
    c.drawn = 0;
    c.blades = which == PLANT_IMPOSTORS_GRASS_A || which == PLANT_IMPOSTORS_GRASS_B;
    for (uint32_t y = 0; y < PLANT_IMPOSTORS_SIDE; y++)
        for (uint32_t x = 0; x < PLANT_IMPOSTORS_SIDE; x++) {
            c.depth[y][x] = -10.0f;
            memset(picture->colour[y][x], 0, 4);
            memcpy(picture->facing[y][x], (const uint8_t[4]){128, 192, 238, 0}, 4);
        }
    switch (which) {
    case PLANT_IMPOSTORS_OAK_A:
    case PLANT_IMPOSTORS_OAK_B:
    case PLANT_IMPOSTORS_OAK_C:
        oak(&c, oak_dark, oak_light, 1.0f, 0.36f);
        break;
    case PLANT_IMPOSTORS_VALLEY_OAK_A:
    case PLANT_IMPOSTORS_VALLEY_OAK_B:
        oak(&c, valley_dark, valley_light, 0.85f, 0.42f);
        break;
    case PLANT_IMPOSTORS_PINE_A:
    case PLANT_IMPOSTORS_PINE_B:
        pine(&c);
        break;
    case PLANT_IMPOSTORS_FIR:
        fir(&c);
        break;
    case PLANT_IMPOSTORS_BUSH_A:
    case PLANT_IMPOSTORS_BUSH_B:
    case PLANT_IMPOSTORS_BUSH_C:
        bush(&c);
        break;
    case PLANT_IMPOSTORS_STUMP:
        stump(&c);
        break;
    default:
        grass(&c);
        break;
    }
    bleed(picture);
}
