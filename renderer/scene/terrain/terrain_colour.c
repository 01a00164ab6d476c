/* Computes ground textures in blocks, row by row. Each property is computed for a whole row at a
 * time, in a simple loop. Colours are sRGB fractions; light multiplies them. */
#include "renderer/scene/terrain/terrain_colour.h"

#include "renderer/scene/terrain/earthwork_colour.h"
#include "renderer/scene/terrain/terrain_block.h"
#include "renderer/scene/noise/value_noise.h"
#include "renderer/scene/noise/value_noise_rows.h"
#include "renderer/scene/frame/light.h"
#include "renderer/scene/terrain/nearby_roads.h"
#include "world/world.h"

#include <math.h>
#include <string.h>

#define BLOCK TERRAIN_BLOCK_TEXELS

#define ROAD_HALF_M  4.0f /* half a road's width */
#define ROAD_FADES_M 2.5f /* width of the transition to the cover beside it */
#define ROAD_RUT_M   1.7f /* distance of the ruts from the middle */
#define ROAD_REACH_M (ROAD_HALF_M + ROAD_FADES_M)

_Static_assert(BLOCK == VALUE_NOISE_COLUMNS_MAX, "a row of a block fits a row of noise");

struct colour {
    float r, g, b;
};

struct texel {
    struct colour colour;
    float scrub; /* 0..1 */
    float water; /* 0..1 */
};

/* The position of a texel and the ground there. */
struct site {
    float height;
    float slope_x, slope_z;            /* rise a metre to the east, to the south */
    float broad, middle, fine, finest; /* noise of about 400, 60, 9 and 4 m */
    float open;                        /* share of water around, 0..1 */
    float far;                         /* 1 where texels are larger than trees */
};

/* A row of sites, and the results. */
struct row {
    float height[BLOCK], slope_x[BLOCK], slope_z[BLOCK];
    float broad[BLOCK], middle[BLOCK], fine[BLOCK], finest[BLOCK], open[BLOCK];
    float rough_x[BLOCK], rough_z[BLOCK]; /* unevenness between the posts */
    float move_x[BLOCK], move_z[BLOCK];   /* shift of the borders between covers, in cells */
    float r[BLOCK], g[BLOCK], b[BLOCK], scrub[BLOCK], water[BLOCK], wave[BLOCK], sun[BLOCK];
    float wash[BLOCK];     /* 1 at the edge of the water */
    uint8_t covers[BLOCK]; /* enum cover or TERRAIN_BLOCK_MIXED */
};

enum {
    BROAD_A,
    BROAD_B,
    MIDDLE_A,
    MIDDLE_B,
    FINE_A,
    FINE_B,
    FINEST,
    ROUGH_X,
    ROUGH_Z,
    MOVE_A_X,
    MOVE_B_X,
    MOVE_A_Z,
    MOVE_B_Z,
    NOISES
};

struct block {
    const struct terrain_colour_tile *tile;
    double x, z; /* [m, world] of its first texel */
    uint32_t column, row, columns, rows;
    float far;
    struct terrain_block terrain;
    struct value_noise_rows noise[NOISES];
    float roads[BLOCK * BLOCK]; /* [m] from the middle of the nearest road */
    bool has_roads;
    struct row now;
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
static const struct colour sea_shore = {0.400f, 0.520f, 0.460f};
static const struct colour lake_shore = {0.270f, 0.370f, 0.330f};
static const struct colour subsoil = {0.440f, 0.345f, 0.235f};
static const struct colour wet_sand = {0.520f, 0.450f, 0.330f};
static const struct colour dust = {0.800f, 0.730f, 0.600f};
static const struct colour gravel = {0.560f, 0.490f, 0.380f};
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

static float between(float a, float b, float t)
{
    return a + (b - a) * t;
}

/* --- covers ----------------------------------------------------------------------------------- */

static inline struct texel grass_texel(const struct site *s)
{
    /* Slopes that face north stay moist and greener. South slopes and summits bleach. */
    float north = clamp01(0.5f + 1.8f * s->slope_z + 0.25f * s->broad);
    float low = clamp01(1.0f - s->height / 700.0f);
    struct colour c = mix(straw, dry, clamp01(0.5f + 0.6f * s->middle + 0.25f * s->fine));
    c = mix(c, olive, 0.62f * ramp(0.45f, 0.95f, north + 0.2f * s->middle));
    c = mix(c, meadow, 0.45f * low * ramp(0.25f, 0.8f, s->broad + 0.3f * s->middle));
    float steep = sqrtf(s->slope_x * s->slope_x + s->slope_z * s->slope_z);
    c = mix(c, earth, 0.75f * ramp(0.45f, 0.85f, steep + 0.15f * s->fine));
    return (struct texel){c, 0.0f, 0.0f};
}

static inline float clump(const struct site *s)
{
    return ramp(-0.25f, 0.35f, s->fine + 0.5f * s->middle + 0.5f * s->finest);
}

static inline struct texel chaparral_texel(const struct site *s)
{
    return (struct texel){mix(mix(dry, olive, 0.5f), shrub, 0.35f + 0.6f * clump(s)), 0.85f, 0.0f};
}

static inline struct texel forest_texel(const struct site *s)
{
    /* From afar a wood consists of crowns. Near by trees are drawn as plants, and the ground is
     * visible. */
    struct colour crowns = mix(canopy, canopy_light, clump(s));
    struct colour floor_near =
        mix(mix(litter, olive, 0.35f + 0.3f * s->middle), shrub, 0.60f * clump(s));
    return (struct texel){mix(floor_near, crowns, 0.42f + 0.45f * s->far), 0.6f, 0.0f};
}

static inline struct texel rock_texel(const struct site *s)
{
    float dark = clamp01(0.5f + 0.7f * s->fine + 0.3f * s->middle);
    return (struct texel){mix(rock, rock_dark, dark), 0.3f, 0.0f};
}

static inline struct texel sand_texel(const struct site *s)
{
    return (struct texel){mix(sand, dry, clamp01(0.25f + 0.3f * s->middle)), 0.0f, 0.0f};
}

/* Returns the distance of water from the shore: 0 at the shore, 1 where the bottom is no longer
 * visible. */
static inline float off_shore(const struct site *s)
{
    return clamp01(2.2f * s->open - 1.2f + 0.08f * s->fine);
}

static inline struct texel sea_texel(const struct site *s)
{
    float off = off_shore(s);
    struct colour c = mix(sea_shore, sea_shallow, ramp(0.0f, 0.35f, off + 0.05f * s->middle));
    return (struct texel){mix(c, sea_deep, ramp(0.2f, 1.0f, off)), 0.0f, 1.0f};
}

static inline struct texel lake_texel(const struct site *s)
{
    return (struct texel){mix(lake_shore, lake_deep, ramp(0.0f, 0.8f, off_shore(s))), 0.0f, 1.0f};
}

static inline struct texel cover_texel(const struct site *s, enum cover cover)
{
    switch (cover) {
    case COVER_CHAPARRAL:
        return chaparral_texel(s);
    case COVER_FOREST:
        return forest_texel(s);
    case COVER_ROCK:
        return rock_texel(s);
    case COVER_SAND:
        return sand_texel(s);
    case COVER_SEA:
        return sea_texel(s);
    case COVER_LAKE:
        return lake_texel(s);
    default:
        return grass_texel(s);
    }
}

static inline struct site site_of(const struct block *block, uint32_t i)
{
    const struct row *row = &block->now;
    return (struct site){row->height[i], row->slope_x[i], row->slope_z[i],
                         row->broad[i],  row->middle[i],  row->fine[i],
                         row->finest[i], row->open[i],    block->far};
}

static inline void put_texel(struct row *row, uint32_t i, const struct texel *t)
{
    row->r[i] = t->colour.r;
    row->g[i] = t->colour.g;
    row->b[i] = t->colour.b;
    row->scrub[i] = t->scrub;
    row->water[i] = t->water;
}

/* A separate loop for each cover. */
#define RUN_OF(name)                                                                               \
    static void run_of_##name(struct block *block, uint32_t first, uint32_t end)                   \
    {                                                                                              \
        for (uint32_t i = first; i < end; i++) {                                                   \
            struct site site = site_of(block, i);                                                  \
            struct texel texel = name##_texel(&site);                                              \
            put_texel(&block->now, i, &texel);                                                     \
        }                                                                                          \
    }
RUN_OF(grass)
RUN_OF(chaparral)
RUN_OF(forest)
RUN_OF(rock)
RUN_OF(sand)
RUN_OF(sea)
RUN_OF(lake)

/* Mixes the land covers by their shares. */
static struct texel blend(const struct site *site, const float share[COVER_COUNT])
{
    struct texel sum = {.scrub = 0.0f};
    float all = 0.0f;
    for (uint32_t c = 0; c < COVER_COUNT; c++) {
        if (share[c] <= 0.0f || cover_is_water((enum cover)c))
            continue;
        struct texel t = cover_texel(site, (enum cover)c);
        sum.colour.r += share[c] * t.colour.r;
        sum.colour.g += share[c] * t.colour.g;
        sum.colour.b += share[c] * t.colour.b;
        sum.scrub += share[c] * t.scrub;
        all += share[c];
    }
    if (all < 0.01f)
        return sand_texel(site);
    sum.colour = scale(sum.colour, 1.0f / all);
    sum.scrub /= all;
    return sum;
}

/* Where land meets water, the height decides: posts are far apart, and a cliff between two of them
 * must not be flooded. Low land is beach, or bare rock where it is steep. */
static void put_shore(struct block *block, uint32_t i, const struct site *site, struct texel *t,
                      bool sea)
{
    float above = site->height - block->terrain.level + 0.25f * site->fine;
    float steep = site->slope_x * site->slope_x + site->slope_z * site->slope_z;
    struct colour low = mix(wet_sand, rock_dark, ramp(0.1f, 0.4f, steep));
    struct colour beach = mix(sand, rock, ramp(0.1f, 0.4f, steep));
    float bare = sea ? 1.0f - ramp(2.0f, 5.0f, above) : 0.6f - 0.6f * ramp(0.5f, 1.5f, above);
    bare *= ramp(0.2f, 0.45f, site->open); /* no beach if no post of water is near */
    t->colour = mix(t->colour, mix(low, beach, ramp(0.6f, 1.9f, above)), bare);
    t->scrub *= 1.0f - bare;
    float water = 1.0f - ramp(0.1f, 0.6f, above);
    struct texel w = sea ? sea_texel(site) : lake_texel(site);
    t->colour = mix(t->colour, w.colour, water);
    t->water = water;
    block->now.wave[i] = sea ? 1.0f : 0.0f;
    block->now.wash[i] = ramp(-0.1f, 0.4f, above);
}

static void run_mixed(struct block *block, uint32_t first, uint32_t end)
{
    struct row *row = &block->now;
    for (uint32_t i = first; i < end; i++) {
        struct site site = site_of(block, i);
        float share[COVER_COUNT];
        terrain_block_shares(&block->terrain, i, row->move_x[i] + 0.10f * row->fine[i],
                             row->move_z[i] - 0.10f * row->fine[i], share);
        struct texel t = blend(&site, share);
        if (site.open > 0.0f)
            put_shore(block, i, &site, &t, block->terrain.sea);
        put_texel(row, i, &t);
    }
}

/* Handles one run of equal covers after another. */
static void colour_row(struct block *block)
{
    static void (*const run[COVER_COUNT])(struct block *, uint32_t, uint32_t) = {
        [COVER_GRASS] = run_of_grass,   [COVER_CHAPARRAL] = run_of_chaparral,
        [COVER_FOREST] = run_of_forest, [COVER_ROCK] = run_of_rock,
        [COVER_SAND] = run_of_sand,     [COVER_ROAD] = run_of_grass,
        [COVER_SEA] = run_of_sea,       [COVER_LAKE] = run_of_lake};
    const uint8_t *covers = block->now.covers;
    for (uint32_t i = 0; i < block->columns;) {
        uint32_t first = i;
        while (i < block->columns && covers[i] == covers[first])
            i++;
        if (covers[first] == TERRAIN_BLOCK_MIXED)
            run_mixed(block, first, i);
        else
            run[covers[first]](block, first, i);
        if (covers[first] == COVER_SEA)
            for (uint32_t w = first; w < i; w++)
                block->now.wave[w] = 1.0f;
    }
}

/* --- roads ------------------------------------------------------------------------------------ */

/* Draws a road into the row: ruts, grass on the crown between them, gravel along the edges. A texel
 * wider than the road takes the road's share of it, but roads never fade out completely, because
 * users look for them. */
static void lay_roads(struct block *block, uint32_t number, double z)
{
    struct row *row = &block->now;
    const float *off = block->roads + (size_t)number * BLOCK;
    float step = (float)block->tile->step_m, edge = 0.5f * step;
    float strength = 2.2f * ROAD_HALF_M / step;
    strength = strength < 0.45f ? 0.45f : strength > 1.0f ? 1.0f : strength;
    for (uint32_t i = 0; i < block->columns; i++) {
        if (off[i] >= ROAD_REACH_M + edge)
            continue;
        double x = block->x + i * block->tile->step_m;
        float wander = value_noise_value(x / 5.0, z / 5.0, 71);
        float d = off[i] + 0.6f * wander;
        float on = 1.0f - ramp(ROAD_HALF_M - 0.4f - edge, ROAD_REACH_M + edge, d);
        struct colour c = dust;
        if (step < 2.0f) {
            float rut = 1.0f - ramp(0.25f, 0.8f, fabsf(off[i] - ROAD_RUT_M));
            float crown = 1.0f - ramp(0.3f, 0.8f, off[i] - 0.3f * wander);
            c = mix(c, dry, 0.35f * crown);
            c = mix(c, gravel, 0.55f * ramp(ROAD_HALF_M - 1.4f, ROAD_HALF_M + 0.4f, d));
            c = scale(c, 1.0f - 0.20f * rut - 0.05f * wander - 0.06f * row->finest[i]);
        }
        on *= strength;
        row->r[i] = between(row->r[i], c.r, on);
        row->g[i] = between(row->g[i], c.g, on);
        row->b[i] = between(row->b[i], c.b, on);
        row->scrub[i] *= 1.0f - on;
        row->water[i] *= 1.0f - on;
    }
}

/* --- light ------------------------------------------------------------------------------------ */

/* Computes the share of the sun's light, with the unevenness between the posts. */
static void light_row(struct block *block)
{
    struct row *row = &block->now;
    float relief = (float)block->tile->relief;
    float x = (float)block->tile->sun.x, y = (float)block->tile->sun.y;
    float z = (float)block->tile->sun.z;
    for (uint32_t i = 0; i < block->columns; i++) {
        float rough = (1.0f - row->water[i]) * relief;
        float sx = rough * (row->slope_x[i] + 0.11f * row->rough_x[i] + 0.07f * row->middle[i]);
        float sz = rough * (row->slope_z[i] + 0.11f * row->rough_z[i] - 0.07f * row->middle[i]);
        float facing = y - sx * x - sz * z;
        row->sun[i] = (facing > 0.0f ? facing : 0.0f) / sqrtf(1.0f + sx * sx + sz * sz);
    }
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

static void put_row(const struct block *block, uint32_t number)
{
    const struct row *row = &block->now;
    size_t at = (size_t)(block->row + number) * block->tile->columns + block->column;
    uint8_t *rgba = block->tile->rgba + at * 4;
    for (uint32_t i = 0; i < block->columns; i++, rgba += 4) {
        float uneven = 0.06f * row->broad[i] + 0.05f * row->middle[i] + 0.03f * row->fine[i] +
                       0.05f * row->finest[i];
        uneven = 1.0f + (1.0f - row->water[i]) * uneven;
        put_lit(rgba, (struct colour){row->r[i] * uneven, row->g[i] * uneven, row->b[i] * uneven},
                row->sun[i]);
        float ground =
            TERRAIN_COLOUR_GROUND_ALPHA + (255 - TERRAIN_COLOUR_GROUND_ALPHA) * row->scrub[i];
        float near = clamp01(2.2f - 2.2f * row->open[i]);
        near = near > row->wash[i] ? near : row->wash[i];
        float shore = TERRAIN_COLOUR_SHORE_ALPHA * row->wave[i] * near;
        float dry_share = 1.0f - ramp(0.35f, 0.65f, row->water[i]);
        rgba[3] = (uint8_t)(between(shore, ground, dry_share) + 0.5f);
    }
    memcpy(block->tile->light + at, row->sun, block->columns * sizeof *row->sun);
}

/* --- craters ---------------------------------------------------------------------------------- */

/* Blends a colour over a texel, lit like the ground there. */
static void lay(uint8_t *texel, float light, struct colour colour, float share)
{
    uint8_t lit[3];
    put_lit(lit, colour, light);
    for (uint32_t i = 0; i < 3; i++)
        texel[i] = (uint8_t)(between((float)texel[i], (float)lit[i], share) + 0.5f);
    texel[3] =
        (uint8_t)(between((float)texel[3], (float)TERRAIN_COLOUR_GROUND_ALPHA, share) + 0.5f);
}

/* Returns the change of the sun's light by a crater's own slopes, at `out` radii from its centre in
 * the unit direction (x, z). */
static float crater_light(const struct terrain_colour_tile *tile, const struct crater *crater,
                          float out, float x, float z)
{
    float deep = crater->depth_m / crater->radius_m, rise = 0.0f;
    if (out < 1.0f)
        rise = 2.0f * deep * (1.0f + (float)CRATER_RIM_HEIGHT) * out;
    else if (out < (float)CRATER_RIM)
        rise = -2.0f * deep * (float)CRATER_RIM_HEIGHT * ((float)CRATER_RIM - out) /
               (((float)CRATER_RIM - 1.0f) * ((float)CRATER_RIM - 1.0f));
    return -rise * (x * (float)tile->sun.x + z * (float)tile->sun.z) / sqrtf(1.0f + rise * rise);
}

static void terrain_colour_crater(const struct terrain_colour_tile *tile,
                                  const struct crater *crater)
{
    float radius = crater->radius_m;
    double reach = TERRAIN_COLOUR_CRATER_REACH * (double)radius, step = tile->step_m;
    double c0 = ceil((crater->x - reach - tile->x) / step);
    double c1 = floor((crater->x + reach - tile->x) / step);
    double r0 = ceil((crater->z - reach - tile->z) / step);
    double r1 = floor((crater->z + reach - tile->z) / step);
    if (!(c1 >= 0.0 && r1 >= 0.0 && c0 < tile->columns && r0 < tile->rows))
        return;
    uint32_t first = (uint32_t)maths_max(c0, 0.0), top = (uint32_t)maths_max(r0, 0.0);
    for (uint32_t row = top; row < tile->rows && row <= r1; row++)
        for (uint32_t column = first; column < tile->columns && column <= c1; column++) {
            double x = tile->x + column * step, z = tile->z + row * step;
            float dx = (float)(x - crater->x), dz = (float)(z - crater->z);
            float off = sqrtf(dx * dx + dz * dz), out = off / radius;
            float unit_x = off > 0.0f ? dx / off : 0.0f, unit_z = off > 0.0f ? dz / off : 0.0f;
            /* Rays of ejected earth and soot. */
            float ray =
                value_noise_value((double)unit_x * 3.0 + crater->x, (double)unit_z * 3.0, 81);
            float lump = value_noise_value(x / 0.7, z / 0.7, 82);
            float thrown = 1.0f - ramp(0.9f, (float)TERRAIN_COLOUR_CRATER_REACH, out - 0.7f * ray);
            float black = 1.0f - ramp(0.2f, 1.9f, out - 0.3f * ray + 0.2f * lump);
            struct colour soil = mix(subsoil, earth, 0.5f + 0.5f * lump);
            struct colour colour = mix(soil, soot, 0.85f * black);
            size_t at = (size_t)row * tile->columns + column;
            float light = tile->light[at] + crater_light(tile, crater, out, unit_x, unit_z);
            float share = out < 1.1f ? 1.0f : clamp01(thrown * (0.85f + 0.5f * lump));
            lay(tile->rgba + at * 4, clamp01(light), colour, share);
        }
}

/* --- earthworks ------------------------------------------------------------------------------- */

/* Texels of the tile in a rectangle of the map; none if the first is after the last. */
struct texels {
    int64_t left, right, top, bottom;
};

static struct texels texels_in(const struct terrain_colour_tile *tile, struct vec3 middle,
                               double reach_x, double reach_z)
{
    double step = tile->step_m;
    return (struct texels){
        (int64_t)ceil(maths_max((middle.x - reach_x - tile->x) / step, 0.0)),
        (int64_t)floor(maths_min((middle.x + reach_x - tile->x) / step, tile->columns - 1.0)),
        (int64_t)ceil(maths_max((middle.z - reach_z - tile->z) / step, 0.0)),
        (int64_t)floor(maths_min((middle.z + reach_z - tile->z) / step, tile->rows - 1.0))};
}

/* Returns how much of the texel is painted, 0..1. */
static float work_share(const struct earthwork *work, double x, double z)
{
    double inside = earthwork_colour_inside(work, x, z);
    if (inside > 0.0 || work->height_m == 0.0)
        return inside > 0.0 ? 1.0f : 0.0f;
    return clamp01(1.0f + (float)(inside / EARTHWORK_COLOUR_MARGIN_M));
}

static void terrain_colour_work(const struct terrain_colour_tile *tile,
                                const struct terrain *terrain, const struct earthwork *work)
{
    const struct earthwork_view view = {tile->sun, tile->step_m, tile->relief};
    struct texels in = texels_in(tile, (struct vec3){work->x, 0.0, work->z},
                                 earthwork_reach_x(work) + EARTHWORK_COLOUR_MARGIN_M,
                                 earthwork_reach_z(work) + EARTHWORK_COLOUR_MARGIN_M);
    for (int64_t row = in.top; row <= in.bottom; row++)
        for (int64_t column = in.left; column <= in.right; column++) {
            double x = tile->x + (double)column * tile->step_m;
            double z = tile->z + (double)row * tile->step_m;
            float share = work_share(work, x, z);
            if (!(share > 0.0f))
                continue;
            struct earthwork_look look = earthwork_colour_at(terrain, work, &view, x, z);
            size_t at = (size_t)row * tile->columns + (size_t)column;
            lay(tile->rgba + at * 4, clamp01(tile->light[at] + look.light),
                (struct colour){look.r, look.g, look.b}, share);
            if (look.water)
                tile->rgba[at * 4 + 3] = TERRAIN_COLOUR_WATER_ALPHA;
        }
}

/* --- blocks ----------------------------------------------------------------------------------- */

/* A texel shows a road that is this near to its middle [m]. */
static double road_reach(const struct terrain_colour_tile *tile)
{
    return (double)ROAD_REACH_M + 0.5 * tile->step_m;
}

static void open_block(struct block *block, const struct world *world)
{
    static const struct {
        double wavelength_m;
        uint32_t seed;
    } noises[NOISES] = {[BROAD_A] = {410.0, 11}, [BROAD_B] = {1900.0, 12}, [MIDDLE_A] = {71.0, 13},
                        [MIDDLE_B] = {27.0, 14}, [FINE_A] = {9.0, 15},     [FINE_B] = {3.1, 16},
                        [FINEST] = {4.0, 51},    [ROUGH_X] = {31.0, 61},   [ROUGH_Z] = {31.0, 62},
                        [MOVE_A_X] = {1.7, 31},  [MOVE_B_X] = {0.6, 32},   [MOVE_A_Z] = {1.7, 33},
                        [MOVE_B_Z] = {0.6, 34}};
    const struct terrain_colour_tile *tile = block->tile;
    block->x = tile->x + block->column * tile->step_m;
    block->z = tile->z + block->row * tile->step_m;
    block->far = clamp01((float)tile->step_m / 10.0f);
    terrain_block_open(&block->terrain, &world->terrain, block->x, block->z, tile->step_m,
                       block->columns, block->rows);
    for (uint32_t i = 0; i < NOISES; i++) {
        /* Borders are shifted by noise with wavelengths of a cell and less, by less than one cell,
         * so that the grid of posts does not show. */
        double unit = i >= MOVE_A_X ? block->terrain.cell_m : 1.0;
        value_noise_rows_begin(&block->noise[i], noises[i].wavelength_m * unit, noises[i].seed,
                               block->x, tile->step_m, block->columns);
    }
    block->has_roads =
        nearby_roads_distances(tile->roads, block->x, block->z, tile->step_m, block->columns,
                               block->rows, BLOCK, road_reach(tile), block->roads);
}

static void fill_noise(struct block *block, double z)
{
    struct row *row = &block->now;
    struct value_noise_rows *noise = block->noise;
    memset(row->broad, 0, sizeof row->broad);
    memset(row->middle, 0, sizeof row->middle);
    memset(row->fine, 0, sizeof row->fine);
    memset(row->finest, 0, sizeof row->finest);
    memset(row->rough_x, 0, sizeof row->rough_x);
    memset(row->rough_z, 0, sizeof row->rough_z);
    value_noise_rows_add(&noise[BROAD_A], z, 0.65f, row->broad);
    value_noise_rows_add(&noise[BROAD_B], z, 0.35f, row->broad);
    value_noise_rows_add(&noise[MIDDLE_A], z, 0.65f, row->middle);
    value_noise_rows_add(&noise[MIDDLE_B], z, 0.45f, row->middle);
    value_noise_rows_add(&noise[FINE_A], z, 0.7f, row->fine);
    value_noise_rows_add(&noise[FINE_B], z, 0.3f, row->fine);
    value_noise_rows_add(&noise[FINEST], z, 1.0f, row->finest);
    value_noise_rows_add(&noise[ROUGH_X], z, 1.0f, row->rough_x);
    value_noise_rows_add(&noise[ROUGH_Z], z, 1.0f, row->rough_z);
    if (memchr(row->covers, TERRAIN_BLOCK_MIXED, block->columns) == NULL)
        return;
    memset(row->move_x, 0, sizeof row->move_x);
    memset(row->move_z, 0, sizeof row->move_z);
    value_noise_rows_add(&noise[MOVE_A_X], z, 0.50f, row->move_x);
    value_noise_rows_add(&noise[MOVE_B_X], z, 0.24f, row->move_x);
    value_noise_rows_add(&noise[MOVE_A_Z], z, 0.50f, row->move_z);
    value_noise_rows_add(&noise[MOVE_B_Z], z, 0.24f, row->move_z);
}

static void terrain_colour_block(struct block *block, const struct world *world)
{
    struct row *row = &block->now;
    open_block(block, world);
    memset(row->open, 0, sizeof row->open);
    for (uint32_t number = 0; number < block->rows; number++) {
        double z = block->z + number * block->tile->step_m;
        terrain_block_row(&block->terrain, z);
        terrain_block_covers(&block->terrain, row->covers);
        terrain_block_ground(&block->terrain, row->height, row->slope_x, row->slope_z);
        if (block->terrain.wet)
            terrain_block_water(&block->terrain, row->open);
        fill_noise(block, z);
        memset(row->wave, 0, sizeof row->wave);
        memset(row->wash, 0, sizeof row->wash);
        colour_row(block);
        if (block->has_roads)
            lay_roads(block, number, z);
        light_row(block);
        put_row(block, number);
    }
}

bool terrain_colour_ground(const struct world *world, const struct crater_index *craters,
                           const struct terrain_colour_tile *tile)
{
    struct block block; /* too large to be cleared for each tile */
    bool sea = false;
    block.tile = tile;
    for (block.row = 0; block.row < tile->rows; block.row += BLOCK)
        for (block.column = 0; block.column < tile->columns; block.column += BLOCK) {
            uint32_t columns = tile->columns - block.column, rows = tile->rows - block.row;
            block.columns = columns < BLOCK ? columns : BLOCK;
            block.rows = rows < BLOCK ? rows : BLOCK;
            terrain_colour_block(&block, world);
            sea |= block.terrain.sea;
        }
    for (uint32_t i = 0; i < world->terrain.earthworks.count; i++)
        terrain_colour_work(tile, &world->terrain, &world->terrain.earthworks.works[i]);
    if (craters != NULL)
        for (uint32_t i = 0; i < craters->count; i++)
            terrain_colour_crater(tile, &craters->craters[i]);
    return sea;
}
