/* Drawing symbols: a shape is the union of a few convex polygons. A pixel's distance to its edge
 * gives the coverage by the fill and by the rim. */
#include "renderer/chart/symbol.h"

#include "world/entity/kind.h"
#include "world/maths/maths.h"
#include "world/model.h"
#include "world/world.h"

#include <math.h>
#include <string.h>

#define POLYGONS_MAX 4u
#define CORNERS_MAX  6u

/* Corners in units of the symbol's length: forward, to the right. The console's page has the same
 * shapes (clients/console/page/symbols.js). */
struct polygon {
    uint32_t count;
    float corner[CORNERS_MAX][2];
};

struct shape {
    float style; /* of the requested length */
    uint32_t count;
    struct polygon polygons[POLYGONS_MAX];
};

static const struct shape shapes[SYMBOL_COUNT] = {
    [SYMBOL_LAND] = {1.0f, 1, {{3, {{0.62f, 0.0f}, {-0.42f, 0.42f}, {-0.42f, -0.42f}}}}},
    [SYMBOL_AIR] = {1.1f,
                    2,
                    {{3, {{0.6f, 0.12f}, {-0.5f, -0.58f}, {-0.2f, 0.12f}}},
                     {3, {{0.6f, -0.12f}, {-0.5f, 0.58f}, {-0.2f, -0.12f}}}}},
    [SYMBOL_SHIP] =
        {1.4f,
         1,
         {{5, {{0.65f, 0.0f}, {0.2f, 0.22f}, {-0.55f, 0.22f}, {-0.55f, -0.22f}, {0.2f, -0.22f}}}}},
    [SYMBOL_TANK] = {1.0f,
                     2,
                     {{4, {{0.3f, 0.34f}, {-0.5f, 0.34f}, {-0.5f, -0.34f}, {0.3f, -0.34f}}},
                      {4, {{0.85f, 0.08f}, {0.2f, 0.08f}, {0.2f, -0.08f}, {0.85f, -0.08f}}}}},
    [SYMBOL_CARRIER] =
        {1.0f,
         1,
         {{5, {{0.62f, 0.0f}, {0.25f, 0.36f}, {-0.5f, 0.36f}, {-0.5f, -0.36f}, {0.25f, -0.36f}}}}},
    [SYMBOL_TRUCK] = {1.05f,
                      2,
                      {{4, {{0.62f, 0.2f}, {0.34f, 0.24f}, {0.34f, -0.24f}, {0.62f, -0.2f}}},
                       {4, {{0.16f, 0.3f}, {-0.62f, 0.3f}, {-0.62f, -0.3f}, {0.16f, -0.3f}}}}},
    [SYMBOL_JEEP] = {0.9f,
                     2,
                     {{3, {{0.6f, 0.08f}, {-0.15f, 0.08f}, {-0.45f, -0.42f}}},
                      {3, {{0.6f, -0.08f}, {-0.15f, -0.08f}, {-0.45f, 0.42f}}}}},
    [SYMBOL_HELICOPTER] =
        {1.15f,
         4,
         {{4, {{0.46f, 0.36f}, {0.36f, 0.46f}, {-0.46f, -0.36f}, {-0.36f, -0.46f}}},
          {4, {{0.46f, -0.36f}, {0.36f, -0.46f}, {-0.46f, 0.36f}, {-0.36f, 0.46f}}},
          {6,
           {{0.4f, 0.0f},
            {0.2f, 0.17f},
            {-0.2f, 0.15f},
            {-0.35f, 0.0f},
            {-0.2f, -0.15f},
            {0.2f, -0.17f}}},
          {4, {{0.0f, 0.06f}, {-0.75f, 0.04f}, {-0.75f, -0.04f}, {0.0f, -0.06f}}}}},
    [SYMBOL_JET] = {1.25f,
                    3,
                    {{4, {{0.7f, 0.0f}, {0.2f, 0.1f}, {-0.5f, 0.0f}, {0.2f, -0.1f}}},
                     {4, {{0.2f, 0.0f}, {-0.28f, 0.5f}, {-0.42f, 0.5f}, {-0.22f, 0.0f}}},
                     {4, {{0.2f, 0.0f}, {-0.28f, -0.5f}, {-0.42f, -0.5f}, {-0.22f, 0.0f}}}}},
};

static const struct shape flame = {
    1.0f, 1, {{4, {{0.75f, 0.05f}, {-0.1f, 0.4f}, {-0.5f, 0.0f}, {-0.1f, -0.4f}}}}};
static const struct shape ember = {
    1.0f, 1, {{4, {{0.3f, 0.02f}, {-0.14f, 0.19f}, {-0.38f, 0.0f}, {-0.14f, -0.19f}}}}};
static const struct shape star = {
    1.0f,

    2,
    {{4, {{0.75f, 0.0f}, {0.0f, 0.17f}, {-0.75f, 0.0f}, {0.0f, -0.17f}}},
     {4, {{0.0f, 0.75f}, {0.17f, 0.0f}, {0.0f, -0.75f}, {-0.17f, 0.0f}}}}};

enum symbol_shape symbol_shape(const struct world *world, const struct kind *kind, double pixels)
{
    static const struct {
        const char *model;
        enum symbol_shape shape;
    } known[] = {
        {"tank", SYMBOL_TANK}, {"carrier", SYMBOL_CARRIER},       {"truck", SYMBOL_TRUCK},
        {"jeep", SYMBOL_JEEP}, {"helicopter", SYMBOL_HELICOPTER}, {"helo-cow", SYMBOL_HELICOPTER},
        {"jet", SYMBOL_JET}};
    if (pixels >= SYMBOL_KINDS_PIXELS && kind->model < world->counts.models)
        for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
            if (strcmp(world->models[kind->model].name, known[i].model) == 0)
                return known[i].shape;
    return kind->domain == DOMAIN_SEA   ? SYMBOL_SHIP
           : kind->domain == DOMAIN_AIR ? SYMBOL_AIR
                                        : SYMBOL_LAND;
}

/* --- shapes ----------------------------------------------------------------------------------- */

/* An edge of a polygon. A pixel's depth within it is x * px + y * py + at. */
struct edge {
    float x, y, at;
};

struct outline {
    float x0, y0, x1, y1; /* bounds, relative to the symbol's place */
    struct edge edges[POLYGONS_MAX][CORNERS_MAX];
    uint32_t counts[POLYGONS_MAX], count;
};

static void transform(struct outline *outline, const struct shape *shape, double heading_rad,
                      double size)
{
    float s = (float)(maths_sin(heading_rad) * size), c = (float)(maths_cos(heading_rad) * size);
    *outline = (struct outline){.count = shape->count};
    for (uint32_t p = 0; p < shape->count; p++) {
        const struct polygon *polygon = &shape->polygons[p];
        float x[CORNERS_MAX], y[CORNERS_MAX], area = 0.0f;
        for (uint32_t i = 0; i < polygon->count; i++) {
            float forward = polygon->corner[i][0], right = polygon->corner[i][1];
            x[i] = s * forward + c * right;
            y[i] = -c * forward + s * right;
            outline->x0 = x[i] < outline->x0 ? x[i] : outline->x0;
            outline->y0 = y[i] < outline->y0 ? y[i] : outline->y0;
            outline->x1 = x[i] > outline->x1 ? x[i] : outline->x1;
            outline->y1 = y[i] > outline->y1 ? y[i] : outline->y1;
        }
        for (uint32_t i = 0; i < polygon->count; i++) {
            uint32_t next = i + 1 < polygon->count ? i + 1 : 0;
            area += x[i] * y[next] - x[next] * y[i];
        }
        for (uint32_t i = 0; i < polygon->count; i++) {
            uint32_t next = i + 1 < polygon->count ? i + 1 : 0;
            float ex = x[next] - x[i], ey = y[next] - y[i];
            float style = (area < 0.0f ? -1.0f : 1.0f) / sqrtf(ex * ex + ey * ey);
            struct edge *edge = &outline->edges[p][i];
            *edge = (struct edge){-style * ey, style * ex, 0.0f};
            edge->at = -(edge->x * x[i] + edge->y * y[i]);
        }
        outline->counts[p] = polygon->count;
    }
}

/* Four pixels of a row at once. */
#define LANES 4
typedef float f32x4 __attribute__((vector_size(16)));
typedef int32_t i32x4 __attribute__((vector_size(16)));

static f32x4 splat(float v)
{
    return (f32x4){v, v, v, v};
}

static f32x4 min4(f32x4 a, f32x4 b)
{
    i32x4 less = a < b;
    return (f32x4)((less & (i32x4)a) | (~less & (i32x4)b));
}

static f32x4 max4(f32x4 a, f32x4 b)
{
    return -min4(-a, -b);
}

/* Returns the pixels' depths within the outline. rows[p][i]: what an edge adds for their row. */
static f32x4 depth_in(const struct outline *outline, float rows[POLYGONS_MAX][CORNERS_MAX], f32x4 x)
{
    f32x4 depth = splat(-1e6f);
    for (uint32_t p = 0; p < outline->count; p++) {
        const struct edge *edges = outline->edges[p];
        f32x4 within = splat(edges[0].x) * x + splat(rows[p][0]);
        for (uint32_t i = 1; i < outline->counts[p]; i++)
            within = min4(within, splat(edges[i].x) * x + splat(rows[p][i]));
        depth = max4(depth, within);
    }
    return depth;
}

/* Returns the coverage of pixels of this depth, 0 to 255. */
static i32x4 coverage(f32x4 depth)
{
    f32x4 share = min4(max4(depth + 0.5f, splat(0.0f)), splat(1.0f)) * 255.0f + 0.5f;
    return __builtin_convertvector(share, i32x4);
}

struct symbol_paint {
    struct rgba fill, rim;
    float rim_width;
};

static void draw_row(uint8_t *pixels, int32_t count, const struct outline *outline,
                     float rows[POLYGONS_MAX][CORNERS_MAX], float x,
                     const struct symbol_paint *paint)
{
    for (int32_t column = 0; column < count; column += LANES, pixels += 4 * LANES, x += LANES) {
        f32x4 depth = depth_in(outline, rows, (f32x4){x, x + 1.0f, x + 2.0f, x + 3.0f});
        i32x4 outer = coverage(depth + paint->rim_width), inner = coverage(depth);
        int32_t lane_count = count - column < LANES ? count - column : LANES;
        for (int32_t i = 0; i < lane_count; i++) {
            if (outer[i] == 0)
                continue;
            if (inner[i] < 255)
                image_blend(pixels + i * 4, paint->rim, outer[i] * paint->rim.a / 255);
            if (inner[i] > 0)
                image_blend(pixels + i * 4, paint->fill, inner[i] * paint->fill.a / 255);
        }
    }
}

static void draw_shape(struct image *image, const struct shape *shape, struct point at,
                       double heading_rad, double pixels, const struct symbol_paint *paint)
{
    struct outline outline;
    double size = pixels * (double)shape->style;
    double rim = 1.2 * (double)paint->rim_width + 0.5;
    if (!(at.x + size > 0.0 && at.y + size > 0.0 && at.x - size < image->width &&
          at.y - size < image->height))
        return;
    transform(&outline, shape, heading_rad, size);
    int32_t x0 = (int32_t)maths_max(at.x + (double)outline.x0 - rim, 0.0);
    int32_t y0 = (int32_t)maths_max(at.y + (double)outline.y0 - rim, 0.0);
    int32_t x1 = (int32_t)maths_min(at.x + (double)outline.x1 + rim + 1.0, image->width);
    int32_t y1 = (int32_t)maths_min(at.y + (double)outline.y1 + rim + 1.0, image->height);
    for (int32_t y = y0; y < y1; y++) {
        float rows[POLYGONS_MAX][CORNERS_MAX], dy = (float)(y + 0.5 - at.y);
        for (uint32_t p = 0; p < outline.count; p++)
            for (uint32_t i = 0; i < outline.counts[p]; i++)
                rows[p][i] = outline.edges[p][i].y * dy + outline.edges[p][i].at;
        draw_row(image->pixels + ((size_t)y * image->width + (size_t)x0) * 4, x1 - x0, &outline,
                 rows, (float)(x0 + 0.5 - at.x), paint);
    }
}

/* --- symbols ---------------------------------------------------------------------------------- */

struct rgba symbol_colour(enum force force)
{
    switch (force) {
    case FORCE_BLUE:
        return (struct rgba){56, 132, 255, 255};
    case FORCE_RED:
        return (struct rgba){232, 40, 24, 255};
    default:
        return (struct rgba){255, 226, 96, 255};
    }
}

/* Small symbols have a fainter pale rim, which would hide those of vehicles close to each other. */
static struct rgba rim_colour(enum force force, double pixels)
{
    uint8_t pale = pixels < SYMBOL_KINDS_PIXELS ? 110 : 255;
    return force == FORCE_RED    ? (struct rgba){255, 238, 228, pale}
           : force == FORCE_BLUE ? (struct rgba){4, 14, 48, 255}
                                 : (struct rgba){40, 30, 4, 255};
}

static float rim_width(double pixels)
{
    return (float)maths_clamp(0.11 * pixels, 0.8, 3.0);
}

void symbol_vehicle(struct image *image, struct point at, enum symbol_shape shape,
                    double heading_rad, double pixels, enum force force)
{
    const struct symbol_paint paint = {symbol_colour(force), rim_colour(force, pixels),
                                       rim_width(pixels)};
    draw_shape(image, &shapes[shape], at, heading_rad, pixels, &paint);
}

void symbol_munition(struct image *image, struct point at, double heading_rad, double pixels)
{
    const struct rgba tail = {255, 245, 200, 130}, head = {255, 250, 225, 255};
    double length = 0.9 * pixels;
    struct point back = {at.x - length * maths_sin(heading_rad),
                         at.y + length * maths_cos(heading_rad)};
    image_line(image, back, at, 1.0, tail);
    image_disc(image, at, 0.14 * pixels + 0.9, (struct rgba){20, 16, 10, 200});
    image_disc(image, at, 0.14 * pixels + 0.1, head);
}

void symbol_wreck(struct image *image, struct point at, double pixels)
{
    double half = 0.3 * pixels, width = maths_clamp(0.15 * pixels, 1.1, 4.0);
    const struct rgba pale = {235, 225, 205, 150}, black = {10, 8, 6, 255};
    for (int32_t pass = 0; pass < 2; pass++)
        for (int32_t side = -1; side <= 1; side += 2) {
            struct point a = {at.x - half, at.y - side * half},
                         b = {at.x + half, at.y + side * half};
            image_line(image, a, b, pass == 0 ? width + 1.4 : width, pass == 0 ? pale : black);
        }
}

void symbol_fire(struct image *image, struct point at, double pixels)
{
    const struct rgba orange = {255, 128, 16, 255}, soot = {30, 14, 6, 255};
    const struct symbol_paint outside = {orange, soot, 0.8f * rim_width(pixels)};
    const struct symbol_paint inside = {{255, 236, 130, 255}, orange, 0.0f};
    draw_shape(image, &flame, at, 0.0, 0.85 * pixels, &outside);
    draw_shape(image, &ember, at, 0.0, 0.85 * pixels, &inside);
}

void symbol_blast(struct image *image, struct point at, double age, double pixels)
{
    uint8_t alpha = (uint8_t)(255.0 * (1.0 - maths_clamp(age, 0.0, 1.0)));
    const struct symbol_paint paint = {
        {255, 250, 210, alpha}, {255, 120, 0, alpha}, rim_width(pixels)};
    draw_shape(image, &star, at, 0.3, pixels * (0.7 + 0.6 * age), &paint);
}

void symbol_crater(struct image *image, struct point at, double radius)
{
    image_disc(image, at, radius, (struct rgba){40, 30, 22, 190});
    image_ring(image, at, radius, 0.9, (struct rgba){228, 208, 166, 170});
}
