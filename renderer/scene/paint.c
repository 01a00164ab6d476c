/* Painting the ground. Colours are sRGB fractions; light multiplies them. */
#include "renderer/scene/paint.h"

#include "renderer/scene/light.h"
#include "renderer/scene/grain.h"

#include <math.h>

#define ROAD_HALF_M     4.0 /* half a road's width */
#define ROAD_SHOULDER_M 2.5
#define ROAD_RUT_M      1.7 /* ruts to each side of the middle */
#define SCORCH_REACH    2.6 /* of a crater's radius: how far its soot lies */

struct colour {
    float r, g, b;
};

struct texel {
    struct colour colour;
    float scrub; /* 0..1 */
    float water; /* 0..1 */
};

/* Where a texel lies and how the ground slopes there. */
struct site {
    double x, z, step;
    double height;
    float slope_x, slope_z;    /* rise a metre to the east, to the south */
    float broad, middle, fine; /* noise of some 400, 60 and 9 m */
};

static const struct colour straw = {0.800f, 0.670f, 0.410f};
static const struct colour dry = {0.700f, 0.590f, 0.340f};
static const struct colour olive = {0.490f, 0.510f, 0.270f};
static const struct colour meadow = {0.420f, 0.500f, 0.230f};
static const struct colour earth = {0.560f, 0.450f, 0.320f};
static const struct colour shrub = {0.270f, 0.320f, 0.175f};
static const struct colour canopy = {0.185f, 0.260f, 0.125f};
static const struct colour canopy_light = {0.300f, 0.370f, 0.180f};
static const struct colour litter = {0.400f, 0.370f, 0.220f};
static const struct colour rock = {0.600f, 0.560f, 0.490f};
static const struct colour rock_dark = {0.420f, 0.390f, 0.350f};
static const struct colour sand = {0.880f, 0.800f, 0.620f};
static const struct colour sea_deep = {0.075f, 0.235f, 0.340f};
static const struct colour sea_shallow = {0.215f, 0.440f, 0.470f};
static const struct colour lake_deep = {0.110f, 0.260f, 0.330f};
static const struct colour foam = {0.930f, 0.950f, 0.940f};
static const struct colour dust = {0.760f, 0.670f, 0.510f};
static const struct colour soot = {0.110f, 0.095f, 0.080f};

static float clamp01(float v)
{
    return v < 0.0f ? 0.0f : v > 1.0f ? 1.0f : v;
}

static float ramp(float low, float high, float v)
{
    float t = clamp01((v - low) / (high - low));
    return t * t * (3.0f - 2.0f * t);
}

static struct colour mix(struct colour a, struct colour b, float t)
{
    return (struct colour){a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

static struct colour scale(struct colour a, float s)
{
    return (struct colour){a.r * s, a.g * s, a.b * s};
}

/* Noise of a wavelength [m]; nothing where the texels are too coarse to hold it. */
static float band(const struct site *s, double wavelength, uint32_t seed)
{
    float held = clamp01((float)(wavelength / s->step) * 0.5f - 0.5f);
    return held > 0.0f ? held * grain_value(s->x / wavelength, s->z / wavelength, seed) : 0.0f;
}

/* --- the shape of the ground ------------------------------------------------------------------ */

static int64_t post_clamp(int64_t i, const struct terrain *terrain)
{
    return i < 0 ? 0 : i >= terrain->side ? terrain->side - 1 : i;
}

static float post(const struct terrain *terrain, int64_t column, int64_t row)
{
    return terrain->posts[post_clamp(row, terrain) * terrain->side + post_clamp(column, terrain)];
}

/* Slopes as if the ground bent smoothly from post to post: flat triangles would show as facets. */
static void smooth_slope(const struct terrain *terrain, struct site *s)
{
    double gx = s->x / terrain->spacing_m, gz = s->z / terrain->spacing_m;
    int64_t c = grain_floor(gx), r = grain_floor(gz);
    float u = (float)(gx - (double)c), v = (float)(gz - (double)r), sx = 0.0f, sz = 0.0f,
          height = 0.0f;
    for (int64_t i = 0; i < 4; i++) {
        int64_t pc = c + (i & 1), pr = r + (i >> 1);
        float weight = (i & 1 ? u : 1.0f - u) * (i >> 1 ? v : 1.0f - v);
        sx += weight * (post(terrain, pc + 1, pr) - post(terrain, pc - 1, pr));
        sz += weight * (post(terrain, pc, pr + 1) - post(terrain, pc, pr - 1));
        height += weight * post(terrain, pc, pr);
    }
    float scale_m = (float)(0.5 / terrain->spacing_m);
    s->slope_x = sx * scale_m;
    s->slope_z = sz * scale_m;
    s->height = height;
}

/* --- covers ----------------------------------------------------------------------------------- */

/* The cover of a post; roads are painted by their own lines, so a post's COVER_ROAD is grass. */
static uint8_t post_cover(const struct terrain *terrain, int64_t column, int64_t row)
{
    int64_t at = post_clamp(row, terrain) * terrain->side + post_clamp(column, terrain);
    uint8_t cover = terrain->cover[at];
    return cover == COVER_ROAD || cover >= COVER_COUNT ? (uint8_t)COVER_GRASS : cover;
}

/* Is it one cover as far around a cell as borders can be shaken? */
static bool one_cover(const struct terrain *terrain, int64_t column, int64_t row, uint8_t cover)
{
    for (int64_t r = row - 1; r <= row + 2; r++)
        for (int64_t c = column - 1; c <= column + 2; c++)
            if (post_cover(terrain, c, r) != cover)
                return false;
    return true;
}

/* Shares of the covers around a place. Borders are shaken by noise as long as a cell and shorter,
 * by less than a cell in all: the grid of the posts must not show. */
static void cover_shares(const struct terrain *terrain, const struct site *s,
                         float share[COVER_COUNT])
{
    double cell = terrain->spacing_m, gx = s->x / cell, gz = s->z / cell;
    int64_t c = grain_floor(gx), r = grain_floor(gz);
    uint8_t here = post_cover(terrain, c, r);
    for (uint32_t i = 0; i < COVER_COUNT; i++)
        share[i] = 0.0f;
    if (one_cover(terrain, c, r, here)) {
        share[here] = 1.0f;
        return;
    }
    float shake_x = 0.50f * band(s, 1.7 * cell, 31) + 0.24f * band(s, 0.6 * cell, 32);
    float shake_z = 0.50f * band(s, 1.7 * cell, 33) + 0.24f * band(s, 0.6 * cell, 34);
    gx += (double)(shake_x + 0.10f * s->fine);
    gz += (double)(shake_z - 0.10f * s->fine);
    c = grain_floor(gx);
    r = grain_floor(gz);
    /* Steeper than linear: a border is some metres wide, not a whole cell. */
    float u = ramp(0.25f, 0.75f, (float)(gx - (double)c));
    float v = ramp(0.25f, 0.75f, (float)(gz - (double)r));
    for (int64_t i = 0; i < 4; i++)
        share[post_cover(terrain, c + (i & 1), r + (i >> 1))] +=
            (i & 1 ? u : 1.0f - u) * (i >> 1 ? v : 1.0f - v);
}

static struct colour grass_colour(const struct site *s)
{
    /* Slopes that face north keep their water: greener. South slopes and tops bleach. */
    float north = clamp01(0.5f + 1.8f * s->slope_z + 0.25f * s->broad);
    float low = clamp01(1.0f - (float)s->height / 700.0f);
    struct colour c = mix(straw, dry, clamp01(0.5f + 0.6f * s->middle + 0.25f * s->fine));
    c = mix(c, olive, 0.62f * ramp(0.45f, 0.95f, north + 0.2f * s->middle));
    c = mix(c, meadow, 0.45f * low * ramp(0.25f, 0.8f, s->broad + 0.3f * s->middle));
    float steep = sqrtf(s->slope_x * s->slope_x + s->slope_z * s->slope_z);
    return mix(c, earth, 0.75f * ramp(0.45f, 0.85f, steep + 0.15f * s->fine));
}

static struct texel cover_texel(const struct site *s, enum cover cover, float share)
{
    struct texel t = {.scrub = 0.0f, .water = 0.0f};
    float clump = ramp(-0.25f, 0.35f, s->fine + 0.5f * s->middle + band(s, 4.0, 51) * 0.5f);
    switch (cover) {
    case COVER_CHAPARRAL:
        t.colour = mix(mix(dry, olive, 0.5f), shrub, 0.35f + 0.6f * clump);
        t.scrub = 0.85f;
        break;
    case COVER_FOREST: {
        /* Far away a wood is its crowns; near by they stand there, and the ground shows. */
        float far = clamp01((float)s->step / 10.0f);
        struct colour crowns = mix(canopy, canopy_light, clump);
        struct colour floor_near =
            mix(mix(litter, olive, 0.35f + 0.3f * s->middle), shrub, 0.60f * clump);
        t.colour = mix(floor_near, crowns, 0.42f + 0.45f * far);
        t.scrub = 0.6f;
        break;
    }
    case COVER_ROCK:
        t.colour = mix(rock, rock_dark, clamp01(0.5f + 0.7f * s->fine + 0.3f * s->middle));
        t.scrub = 0.3f;
        break;
    case COVER_SAND:
        t.colour = mix(sand, dry, clamp01(0.25f + 0.3f * s->middle));
        break;
    case COVER_SEA:
        /* The share of sea falls towards the shore, and stands for the depth. */
        t.colour = mix(sea_shallow, sea_deep, ramp(0.6f, 1.0f, share));
        t.water = 1.0f;
        break;
    case COVER_LAKE:
        t.colour = mix(sea_shallow, lake_deep, ramp(0.4f, 0.9f, share));
        t.water = 1.0f;
        break;
    default:
        t.colour = grass_colour(s);
        break;
    }
    return t;
}

static struct texel blend_covers(const struct terrain *terrain, const struct site *s)
{
    float share[COVER_COUNT];
    cover_shares(terrain, s, share);
    struct texel sum = {.scrub = 0.0f};
    for (uint32_t i = 0; i < COVER_COUNT; i++) {
        if (share[i] <= 0.0f)
            continue;
        struct texel t = cover_texel(s, (enum cover)i, share[i]);
        sum.colour.r += share[i] * t.colour.r;
        sum.colour.g += share[i] * t.colour.g;
        sum.colour.b += share[i] * t.colour.b;
        sum.scrub += share[i] * t.scrub;
        sum.water += share[i] * t.water;
    }
    /* Wet sand and a line of foam where the sea meets the land. */
    float sea = share[COVER_SEA];
    if (sea > 0.02f && sea < 0.98f) {
        float line = 1.0f - fabsf(sea - 0.5f - 0.12f * s->fine) / 0.16f;
        sum.colour = mix(sum.colour, foam, 0.85f * clamp01(line));
    }
    return sum;
}

/* --- light ------------------------------------------------------------------------------------ */

/* Share of the sun's light on the site, with the small unevenness that no post holds. */
static float sun_share(const struct site *s, const struct paint_tile *tile, float water)
{
    float rough = (1.0f - water) * (float)tile->relief;
    float sx = rough * (s->slope_x + 0.11f * band(s, 31.0, 61) + 0.07f * s->middle);
    float sz = rough * (s->slope_z + 0.11f * band(s, 31.0, 62) - 0.07f * s->middle);
    float facing = (float)tile->sun.y - sx * (float)tile->sun.x - sz * (float)tile->sun.z;
    return facing > 0.0f ? facing / sqrtf(1.0f + sx * sx + sz * sz) : 0.0f;
}

static uint8_t byte_of(float v)
{
    return (uint8_t)(clamp01(v) * 255.0f + 0.5f);
}

static void put_lit(uint8_t *rgba, struct colour c, float sun)
{
    rgba[0] = byte_of(c.r * (SKY_LIGHT_RED + SUN_LIGHT_RED * sun));
    rgba[1] = byte_of(c.g * (SKY_LIGHT_GREEN + SUN_LIGHT_GREEN * sun));
    rgba[2] = byte_of(c.b * (SKY_LIGHT_BLUE + SUN_LIGHT_BLUE * sun));
}

static void paint_texel(const struct terrain *terrain, const struct paint_tile *tile,
                        struct site *s, size_t at)
{
    s->broad = band(s, 410.0, 11) * 0.65f + band(s, 1900.0, 12) * 0.35f;
    s->middle = band(s, 71.0, 13) * 0.7f + band(s, 27.0, 14) * 0.3f;
    s->fine = band(s, 9.0, 15) * 0.7f + band(s, 3.1, 16) * 0.3f;
    smooth_slope(terrain, s);
    struct texel t = blend_covers(terrain, s);
    t.colour = scale(t.colour, 1.0f + (1.0f - t.water) * (0.06f * s->broad + 0.05f * s->middle));
    tile->light[at] = sun_share(s, tile, t.water);
    put_lit(tile->rgba + at * 4, t.colour, tile->light[at]);
    float ground = PAINT_GROUND_ALPHA + (255 - PAINT_GROUND_ALPHA) * t.scrub;
    tile->rgba[at * 4 + 3] = (uint8_t)(ground * (1.0f - ramp(0.35f, 0.65f, t.water)) + 0.5f);
}

/* --- what lies on the ground ------------------------------------------------------------------ */

struct box {
    int64_t x0, z0, x1, z1; /* texels, inclusive */
};

/* The texels within a box of the world; false when there are none. */
static bool tile_box(const struct paint_tile *tile, double x0, double z0, double x1, double z1,
                     struct box *box)
{
    double columns = (double)tile->columns - 1.0, rows = (double)tile->rows - 1.0;
    double c0 = ceil((x0 - tile->x) / tile->step_m), c1 = floor((x1 - tile->x) / tile->step_m);
    double r0 = ceil((z0 - tile->z) / tile->step_m), r1 = floor((z1 - tile->z) / tile->step_m);
    if (!(c1 >= 0.0 && r1 >= 0.0 && c0 <= columns && r0 <= rows && c0 <= c1 && r0 <= r1))
        return false;
    box->x0 = (int64_t)fmax(0.0, c0);
    box->z0 = (int64_t)fmax(0.0, r0);
    box->x1 = (int64_t)fmin(columns, c1);
    box->z1 = (int64_t)fmin(rows, r1);
    return true;
}

/* Lays a colour over a texel, lit as the ground under it is. */
static void lay(const struct paint_tile *tile, size_t at, struct colour colour, float share)
{
    uint8_t lit[3], *texel = tile->rgba + at * 4;
    put_lit(lit, colour, tile->light[at]);
    for (uint32_t i = 0; i < 3; i++)
        texel[i] = byte_of(((float)texel[i] + ((float)lit[i] - (float)texel[i]) * share) / 255.0f);
    float alpha = (float)texel[3] + ((float)PAINT_GROUND_ALPHA - (float)texel[3]) * share;
    texel[3] = (uint8_t)(alpha + 0.5f);
}

static void paint_road(const struct paint_tile *tile, const struct road_point *a,
                       const struct road_point *b)
{
    /* Where a texel is wider than the road it takes the road's share of it, but a road never
     * fades away altogether: people look for roads. */
    double half = ROAD_HALF_M + ROAD_SHOULDER_M, edge = 0.5 * tile->step_m;
    double strength = maths_clamp(2.2 * ROAD_HALF_M / tile->step_m, 0.45, 1.0);
    double reach = half + edge, ax = (double)a->x, az = (double)a->z;
    double dx = (double)b->x - ax, dz = (double)b->z - az, squared = dx * dx + dz * dz;
    struct box box;
    if (!tile_box(tile, fmin(ax, ax + dx) - reach, fmin(az, az + dz) - reach,
                  fmax(ax, ax + dx) + reach, fmax(az, az + dz) + reach, &box))
        return;
    for (int64_t row = box.z0; row <= box.z1; row++)
        for (int64_t column = box.x0; column <= box.x1; column++) {
            double x = tile->x + (double)column * tile->step_m;
            double z = tile->z + (double)row * tile->step_m;
            double t = squared > 0.0 ? ((x - ax) * dx + (z - az) * dz) / squared : 0.0;
            t = maths_clamp(t, 0.0, 1.0);
            double off = hypot(x - ax - t * dx, z - az - t * dz);
            if (off >= reach)
                continue;
            float wander = grain_value(x / 5.0, z / 5.0, 71);
            float on = 1.0f - ramp((float)(ROAD_HALF_M - 1.0 - edge), (float)reach,
                                   (float)off + 0.8f * wander);
            struct colour colour = dust;
            if (tile->step_m < 2.0) {
                float rut = 1.0f - ramp(0.2f, 0.9f, fabsf((float)off - (float)ROAD_RUT_M));
                colour = scale(dust, 1.0f - 0.16f * rut - 0.07f * wander);
            }
            lay(tile, (size_t)row * tile->columns + (size_t)column, colour, on * (float)strength);
        }
}

static void paint_crater(const struct paint_tile *tile, const struct crater *crater)
{
    double radius = crater->radius_m, reach = SCORCH_REACH * radius;
    struct box box;
    if (!tile_box(tile, crater->x - reach, crater->z - reach, crater->x + reach, crater->z + reach,
                  &box))
        return;
    for (int64_t row = box.z0; row <= box.z1; row++)
        for (int64_t column = box.x0; column <= box.x1; column++) {
            double dx = tile->x + (double)column * tile->step_m - crater->x;
            double dz = tile->z + (double)row * tile->step_m - crater->z;
            /* Rays of soot and thrown earth. */
            float turn = (float)maths_atan2(dz, dx), out = (float)(hypot(dx, dz) / radius);
            float ray = grain_value((double)turn * 4.0, crater->x, 81);
            float black = 0.9f * (1.0f - ramp(0.75f, (float)SCORCH_REACH * 0.8f, out - 0.4f * ray));
            struct colour colour =
                mix(soot, earth,
                    0.45f * (1.0f - ramp(0.0f, 0.6f, out)) + 0.35f * ramp(0.9f, 1.2f, out));
            lay(tile, (size_t)row * tile->columns + (size_t)column, colour, black);
        }
}

void paint_ground(const struct world *world, const struct crater_index *craters,
                  const struct paint_tile *tile)
{
    struct site site = {.step = tile->step_m};
    for (uint32_t row = 0; row < tile->rows; row++)
        for (uint32_t column = 0; column < tile->columns; column++) {
            site.x = tile->x + column * tile->step_m;
            site.z = tile->z + row * tile->step_m;
            paint_texel(&world->terrain, tile, &site, (size_t)row * tile->columns + column);
        }
    for (uint32_t i = 0; i + 1 < world->counts.road_points; i++)
        if (world->road_points[i].road == world->road_points[i + 1].road)
            paint_road(tile, &world->road_points[i], &world->road_points[i + 1]);
    if (craters != NULL)
        for (uint32_t i = 0; i < craters->count; i++)
            paint_crater(tile, &craters->craters[i]);
}
