/* Painting and keeping the base map. */
#include "renderer/chart/base_map.h"

#include "renderer/scene/terrain/terrain_colour.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define RELIEF        2.2 /* exaggeration of slopes in the shading */
#define INDEX_CONTOUR 5   /* every fifth contour is darker */
#define STRIP         8   /* [pixel] width of the strips that are painted */
#define ROAD_LINE_M   24.0
#define ROAD_STEP     1.0 /* pixels from a point that is drawn to the next */
#define ROAD_LEAST    1.0 /* [pixel] */
#define ROAD_MOST     2.5
#define ROAD_COLOUR_M (ROAD_LINE_M / ROAD_MOST) /* coarser maps show roads as lines alone */

static const struct rgba beyond = {22, 26, 30, 255}; /* outside of the world */

void base_map_open(struct base_map *base, const struct world *world)
{
    *base = (struct base_map){.world = world};
}

void base_map_close(struct base_map *base)
{
    image_free(&base->ring);
    road_index_free(&base->roads);
}

/* --- painting --------------------------------------------------------------------------------- */

double base_map_contour_m(double metres)
{
    static const double intervals[] = {5.0, 10.0, 20.0, 50.0, 100.0, 200.0};
    uint32_t i = 0;
    while (i + 1 < sizeof intervals / sizeof intervals[0] && intervals[i] < 1.4 * metres)
        i++;
    return intervals[i];
}

static void darken(uint8_t *pixel, int32_t share)
{
    for (uint32_t i = 0; i < 3; i++)
        pixel[i] = (uint8_t)(pixel[i] * (256 - share) / 256);
}

/* Fills bands[width + 1] with the number of the contour band of each pixel of a row. */
static void fill_bands(int32_t *bands, const struct map_view *view, const struct terrain *terrain,
                       uint32_t row, double contour_m)
{
    double z = view->z + (row + 0.5) * view->metres;
    for (uint32_t column = 0; column <= view->width; column++) {
        double x = view->x + (column + 0.5) * view->metres;
        bands[column] = (int32_t)floor(terrain_base_height(terrain, x, z) / contour_m);
    }
}

/* Darkens pixels whose right or lower neighbour lies in another contour band. Returns 0, or -1 with
 * errno ENOMEM. */
static int draw_contours(struct image *image, const struct map_view *view,
                         const struct terrain *terrain)
{
    double contour_m = base_map_contour_m(view->metres);
    int32_t *here = malloc(2 * ((size_t)view->width + 1) * sizeof *here);
    if (here == NULL)
        return -1;
    int32_t *rows = here, *below = here + view->width + 1;
    fill_bands(here, view, terrain, 0, contour_m);
    for (uint32_t row = 0; row < view->height; row++) {
        uint8_t *pixel = image->pixels + (size_t)row * image->width * 4;
        fill_bands(below, view, terrain, row + 1, contour_m);
        for (uint32_t column = 0; column < view->width; column++, pixel += 4) {
            int32_t band = here[column], top = band;
            top = here[column + 1] > top ? here[column + 1] : top;
            top = below[column] > top ? below[column] : top;
            if (band != here[column + 1] || band != below[column])
                darken(pixel, top % INDEX_CONTOUR == 0 ? 92 : 44);
        }
        int32_t *free_row = here;
        here = below;
        below = free_row;
    }
    free(rows);
    return 0;
}

/* Draws roads as lines: at a map's scale the ground's colour hardly shows them. */
static void draw_roads(struct image *image, const struct map_view *view, const struct world *world)
{
    const struct rgba line = {112, 58, 34, 190};
    double pixels = maths_clamp(ROAD_LINE_M / view->metres, ROAD_LEAST, ROAD_MOST);
    struct point from = {0};
    bool begins = true;
    for (uint32_t i = 0; i + 1 < world->counts.road_points; i++) {
        const struct road_point *a = &world->road_points[i], *b = a + 1;
        bool goes_on = a->road == b->road;
        struct point to = map_point(view, b->x, b->z);
        if (begins)
            from = map_point(view, a->x, a->z);
        begins = !goes_on;
        if (!goes_on)
            continue;
        /* On small maps many points lie in one pixel. */
        bool last = i + 2 == world->counts.road_points || b[1].road != b->road;
        if (!last && fabs(to.x - from.x) + fabs(to.y - from.y) < ROAD_STEP)
            continue;
        image_line(image, from, to, pixels, line);
        from = to;
    }
}

static void blank_beyond(struct image *image, const struct map_view *view, double side_m)
{
    int32_t left = (int32_t)ceil(-view->x / view->metres - 0.5);
    int32_t top = (int32_t)ceil(-view->z / view->metres - 0.5);
    int32_t right = (int32_t)ceil((side_m - view->x) / view->metres - 0.5);
    int32_t bottom = (int32_t)ceil((side_m - view->z) / view->metres - 0.5);
    int32_t width = (int32_t)view->width, height = (int32_t)view->height;
    image_rectangle(image, 0, 0, left, height, beyond);
    image_rectangle(image, 0, 0, width, top, beyond);
    image_rectangle(image, right, 0, width - right, height, beyond);
    image_rectangle(image, 0, bottom, width, height - bottom, beyond);
}

/* Paints the view's ground into an image of its size. Returns 0, or -1 with errno ENOMEM. */
static int paint_view(struct image *image, const struct map_view *view, const struct world *world,
                      const struct road_index *roads)
{
    size_t count = (size_t)view->width * view->height;
    float *light = malloc(count * sizeof *light);
    if (light == NULL)
        return -1;
    struct terrain_colour_tile tile = {
        .x = view->x + 0.5 * view->metres,
        .z = view->z + 0.5 * view->metres,
        .step_m = view->metres,
        .columns = view->width,
        .rows = view->height,
        .sun = {-0.52, 0.68, -0.52}, /* from the north-west, as is usual on maps */
        .relief = RELIEF,
        .rgba = image->pixels,
        .light = light,
        .roads = roads,
    };
    terrain_colour_ground(world, NULL, &tile);
    free(light);
    for (size_t i = 0; i < count; i++)
        image->pixels[i * 4 + 3] = 255;
    if (draw_contours(image, view, &world->terrain) != 0)
        return -1;
    draw_roads(image, view, world);
    blank_beyond(image, view, world->terrain.squares.world_m);
    return 0;
}

/* --- the ring --------------------------------------------------------------------------------- */

static int64_t modulo(int64_t a, int64_t b)
{
    int64_t rest = a % b;
    return rest < 0 ? rest + b : rest;
}

static int64_t strip_floor(int64_t pixel)
{
    return pixel - modulo(pixel, STRIP);
}

/* Copies columns of one raster row between the ring and a row of pixels. */
static void copy_row(struct base_map *base, int64_t row, int64_t x0, int64_t x1, uint8_t *pixels,
                     bool into_ring)
{
    int64_t width = base->ring.width;
    uint8_t *line =
        base->ring.pixels + (size_t)modulo(row, base->ring.height) * base->ring.width * 4;
    while (x0 < x1) {
        int64_t at = modulo(x0, width), run = width - at < x1 - x0 ? width - at : x1 - x0;
        uint8_t *ring = line + (size_t)at * 4;
        memcpy(into_ring ? ring : pixels, into_ring ? pixels : ring, (size_t)run * 4);
        pixels += run * 4;
        x0 += run;
    }
}

/* Returns the roads that the ground's colour shows, NULL if none: on coarse maps the lines cover
 * it. Sets errno to ENOMEM without memory. */
static const struct road_index *roads_of_colour(struct base_map *base)
{
    if (base->metres >= ROAD_COLOUR_M)
        return NULL;
    if (!base->has_roads &&
        road_index_make(&base->roads, base->world->road_points, base->world->counts.road_points,
                        base->world->terrain.squares.world_m) != 0)
        return NULL;
    base->has_roads = true;
    return &base->roads;
}

static int paint_part(struct base_map *base, struct base_map_part part)
{
    if (part.x0 >= part.x1 || part.y0 >= part.y1)
        return 0;
    struct map_view view = {.x = (double)part.x0 * base->metres,
                            .z = (double)part.y0 * base->metres,
                            .metres = base->metres,
                            .width = (uint32_t)(part.x1 - part.x0),
                            .height = (uint32_t)(part.y1 - part.y0)};
    struct image image;
    const struct road_index *roads = roads_of_colour(base);
    if (roads == NULL && base->metres < ROAD_COLOUR_M)
        return -1;
    if (image_init(&image, view.width, view.height) != 0)
        return -1;
    int result = paint_view(&image, &view, base->world, roads);
    for (int64_t row = part.y0; result == 0 && row < part.y1; row++)
        copy_row(base, row, part.x0, part.x1,
                 image.pixels + (size_t)(row - part.y0) * view.width * 4, true);
    image_free(&image);
    base->painted += (uint64_t)view.width * view.height;
    return result;
}

/* Makes the ring large enough for a part at this scale; a new ring is empty. Returns 0, or -1 with
 * errno ENOMEM. */
static int make_ring(struct base_map *base, double metres, struct base_map_part part)
{
    uint32_t width = (uint32_t)(part.x1 - part.x0), height = (uint32_t)(part.y1 - part.y0);
    if (base->metres == metres && base->ring.width >= width && base->ring.height >= height)
        return 0;
    image_free(&base->ring);
    base->metres = 0.0;
    base->held = (struct base_map_part){0, 0, 0, 0};
    /* A view of the same size may begin within a strip or on its edge. */
    if (image_init(&base->ring, width + STRIP, height + STRIP) != 0)
        return -1;
    base->metres = metres;
    return 0;
}

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t most(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

/* Paints the pixels of a part that are not held. Then only the part is held. Returns 0, or -1 with
 * errno ENOMEM. */
static int paint_missing(struct base_map *base, struct base_map_part part)
{
    struct base_map_part kept = {most(part.x0, base->held.x0), most(part.y0, base->held.y0),
                                 least(part.x1, base->held.x1), least(part.y1, base->held.y1)};
    if (kept.x0 >= kept.x1 || kept.y0 >= kept.y1)
        kept = (struct base_map_part){part.x1, part.y1, part.x1, part.y1};
    const struct base_map_part missing[] = {
        {part.x0, part.y0, part.x1, kept.y0},
        {part.x0, kept.y1, part.x1, part.y1},
        {part.x0, kept.y0, kept.x0, kept.y1},
        {kept.x1, kept.y0, part.x1, kept.y1},
    };
    base->held = (struct base_map_part){0, 0, 0, 0};
    for (size_t i = 0; i < sizeof missing / sizeof missing[0]; i++)
        if (paint_part(base, missing[i]) != 0)
            return -1;
    base->held = part;
    return 0;
}

int base_map_draw(struct base_map *base, struct image *image, const struct map_view *view)
{
    int64_t x0 = llround(view->x / view->metres), y0 = llround(view->z / view->metres);
    struct base_map_part part = {strip_floor(x0), strip_floor(y0),
                                 strip_floor(x0 + view->width + STRIP - 1),
                                 strip_floor(y0 + view->height + STRIP - 1)};
    if (make_ring(base, view->metres, part) != 0 || paint_missing(base, part) != 0)
        return -1;
    for (int64_t row = 0; row < view->height; row++)
        copy_row(base, y0 + row, x0, x0 + view->width,
                 image->pixels +
                     ((size_t)(view->top + row) * image->width + (size_t)view->left) * 4,
                 false);
    return 0;
}
