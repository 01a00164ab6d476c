/* Composing the map picture. */
#include "renderer/chart/annotated_picture.h"

#include "renderer/chart/legend.h"
#include "world/terrain/gridsquare.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#define CLOSE_UP_SIDE_M 6000.0 /* of ground across the close-up */
#define WIDE_M          60.0   /* a pixel: from here symbols are smallest */
#define NEAR_M          15.0   /* ... and from here down largest */
#define WIDE_SYMBOL     0.46   /* of the letters' size */
#define NEAR_SYMBOL     0.80
#define SYMBOL_LEAST    5.5 /* [pixel] */
#define TRIANGLE        5.0 /* the viewing triangle's length, in letters' sizes */
#define WIDE_OPACITY    150 /* of tracks */
#define NEAR_OPACITY    210

static const struct rgba panel = {22, 26, 30, 255};
static const struct rgba rule = {10, 12, 14, 255};

static void begin(struct annotated_picture *chart, const struct world *world, uint32_t width,
                  uint32_t height)
{
    *chart = (struct annotated_picture){.world = world, .width = width, .height = height};
    map_layout_map(&chart->layout, width, height);
    base_map_open(&chart->whole, world);
    base_map_open(&chart->close_up.base, world);
    base_map_open(&chart->small.base, world);
    base_map_open(&chart->area, world);
}

int annotated_picture_open(struct annotated_picture *chart, const struct world *world,
                           uint32_t width, uint32_t height, struct error_text *error)
{
    begin(chart, world, width, height);
    chart->text = text_open(error);
    return chart->text == NULL ? -1 : 0;
}

void annotated_picture_open_beside(struct annotated_picture *chart,
                                   const struct annotated_picture *first, uint32_t width,
                                   uint32_t height)
{
    begin(chart, first->world, width, height);
    chart->text = first->text;
    chart->beside = true;
}

static void close_part(struct annotated_picture_part *part)
{
    base_map_close(&part->base);
    image_free(&part->image);
}

void annotated_picture_close(struct annotated_picture *chart)
{
    if (!chart->beside)
        text_close(chart->text);
    base_map_close(&chart->whole);
    close_part(&chart->close_up);
    close_part(&chart->small);
    base_map_close(&chart->area);
}

int annotated_picture_part_size(struct annotated_picture_part *part, uint32_t width,
                                uint32_t height)
{
    if (part->image.pixels != NULL && part->image.width == width && part->image.height == height)
        return 0;
    image_free(&part->image);
    return image_init(&part->image, width, height);
}

void annotated_picture_shorten(struct annotated_picture *chart, char *words, uint32_t size,
                               int32_t width)
{
    size_t length = strlen(words);
    while (length > 0 && text_width(chart->text, size, words) > width) {
        words[--length] = '\0';
        if (length > 0)
            words[length - 1] = '.';
    }
}

int annotated_picture_ground(struct base_map *base, struct image *image,
                             const struct map_view *view,
                             const struct annotated_picture_source *source,
                             const struct annotated_picture_scale *scale)
{
    const struct frame_view *moment = source->moment;
    if (base_map_draw(base, image, view) != 0)
        return -1;
    map_craters(image, view, moment->craters, scale->symbol);
    if (scale->tracks > 0)
        map_tracks(image, view, moment, source->tracks, scale->symbol, scale->tracks);
    if (source->camera != NULL)
        map_sight(image, view, source->camera, scale->triangle);
    return 0;
}

void annotated_picture_things(struct image *image, const struct map_view *view,
                              const struct annotated_picture_source *source,
                              const struct annotated_picture_scale *scale)
{
    const struct frame_view *moment = source->moment;
    /* Below the vehicles, which they would hide; not on a map so small that they would be all. */
    if (source->effects != NULL && scale->symbol >= SYMBOL_LEAST)
        map_blasts(image, view, moment, source->effects, scale->symbol);
    map_vehicles(image, view, moment, source->slot, scale->symbol);
    if (source->slot != SLOT_NONE)
        map_followed(image, view, moment, source->slot, scale->symbol, 0.8 * scale->triangle);
}

/* 0 for a map of a wide country, 1 for one near by. */
static double nearness(const struct map_view *view)
{
    return maths_clamp((WIDE_M - view->metres) / (WIDE_M - NEAR_M), 0.0, 1.0);
}

static struct annotated_picture_scale scale_of(const struct annotated_picture *chart,
                                               const struct map_view *view)
{
    double share = nearness(view), letters = chart->layout.letters;
    double symbol = (WIDE_SYMBOL + (NEAR_SYMBOL - WIDE_SYMBOL) * share) * letters;
    return (struct annotated_picture_scale){
        .symbol = maths_max(symbol, SYMBOL_LEAST),
        .triangle = TRIANGLE * letters,
        .tracks = (uint8_t)(WIDE_OPACITY + (NEAR_OPACITY - WIDE_OPACITY) * share)};
}

/* Keeps words off the followed vehicle and what it drives and looks at. */
static void take_followed(struct taken *taken, const struct map_view *view,
                          const struct annotated_picture_source *source, double length)
{
    const struct entities *e = source->moment->entities;
    if (source->slot == SLOT_NONE || taken->count == TAKEN_MAX)
        return;
    struct point at = map_point(view, e->x[source->slot], e->z[source->slot]);
    double ahead_x = at.x + length * maths_sin(e->heading[source->slot]);
    double ahead_y = at.y - length * maths_cos(e->heading[source->slot]);
    taken->boxes[taken->count++] =
        (struct box){(int32_t)maths_min(at.x, ahead_x), (int32_t)maths_min(at.y, ahead_y),
                     (int32_t)fabs(ahead_x - at.x) + 1, (int32_t)fabs(ahead_y - at.y) + 1};
}

/* A map with its words; what is taken before is kept clear of them. */
static int draw_map(struct annotated_picture *chart, struct base_map *base, struct image *image,
                    const struct map_view *view, const struct annotated_picture_source *source,
                    struct taken *taken)
{
    struct annotated_picture_scale scale = scale_of(chart, view);
    taken->bounds =
        (struct box){view->left, view->top, (int32_t)view->width, (int32_t)view->height};
    if (annotated_picture_ground(base, image, view, source, &scale) != 0)
        return -1;
    take_followed(taken, view, source, scale.triangle);
    legend_marks(chart, image, view, source, taken);
    annotated_picture_things(image, view, source, &scale);
    return 0;
}

/* The picture outside of a box, to cover what was drawn over the box's edges. */
static void blank_around(struct image *image, struct box box)
{
    int32_t width = (int32_t)image->width, height = (int32_t)image->height;
    int32_t right = box.left + box.width, bottom = box.top + box.height;
    image_rectangle(image, 0, 0, box.left, height, rule);
    image_rectangle(image, right, 0, width - right, height, rule);
    image_rectangle(image, box.left, 0, box.width, box.top, rule);
    image_rectangle(image, box.left, bottom, box.width, height - bottom, rule);
}

static int draw_whole(struct annotated_picture *chart, struct image *image,
                      const struct annotated_picture_source *source)
{
    struct box box = chart->layout.whole, corner = {0, 0, 0, 0};
    struct map_view view = map_whole(box.left, box.top, (uint32_t)box.width);
    struct taken taken = {.count = 0};
    if (chart->layout.legend.width == 0) {
        corner = legend_corner(chart, &view, source);
        taken.boxes[taken.count++] = corner;
    }
    if (draw_map(chart, &chart->whole, image, &view, source, &taken) != 0)
        return -1;
    image_rectangle(image, corner.left, corner.top, corner.width, corner.height,
                    (struct rgba){panel.r, panel.g, panel.b, 215});
    if (corner.width > 0)
        legend_symbols(chart, image, corner, false);
    blank_around(image, box);
    return 0;
}

static int draw_close_up(struct annotated_picture *chart, struct image *image,
                         const struct annotated_picture_source *source)
{
    struct box box = chart->layout.close_up;
    double x = 0.5 * WORLD_SIDE_M, z = x;
    if (source->slot != SLOT_NONE) {
        x = source->moment->entities->x[source->slot];
        z = source->moment->entities->z[source->slot];
    }
    struct map_view view = map_around(x, z, CLOSE_UP_SIDE_M / box.width, 0, 0, (uint32_t)box.width,
                                      (uint32_t)box.height);
    struct taken taken = {.count = 0};
    map_align(&view);
    if (annotated_picture_part_size(&chart->close_up, view.width, view.height) != 0 ||
        draw_map(chart, &chart->close_up.base, &chart->close_up.image, &view, source, &taken) != 0)
        return -1;
    image_copy(image, &chart->close_up.image, box.left, box.top);
    return 0;
}

int annotated_picture_map(struct annotated_picture *chart, struct image *image,
                          const struct annotated_picture_source *source)
{
    const struct map_layout *layout = &chart->layout;
    if (draw_whole(chart, image, source) != 0)
        return -1;
    if (layout->close_up.width > 0 && draw_close_up(chart, image, source) != 0)
        return -1;
    if (layout->legend.width == 0)
        return 0;
    struct box figures = layout->figures, legend = layout->legend;
    image_rectangle(image, figures.left, figures.top, figures.width, figures.height, panel);
    image_rectangle(image, legend.left, legend.top, legend.width, legend.height, panel);
    legend_figures(chart, image, figures, source);
    legend_symbols(chart, image, legend, layout->close_up.width > 0);
    return 0;
}

int annotated_picture_area(struct annotated_picture *chart, struct image *image,
                           const struct annotated_picture_source *source, double x, double z,
                           double metres)
{
    struct map_view view = map_around(x, z, metres, 0, 0, chart->width, chart->height);
    struct taken taken = {.count = 0};
    map_align(&view);
    return draw_map(chart, &chart->area, image, &view, source, &taken);
}
