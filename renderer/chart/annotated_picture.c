/* Composing the map's picture. */
#include "renderer/chart/annotated_picture.h"

#include "renderer/chart/legend.h"
#include "world/terrain/gridsquare.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#define CLOSE_UP_SIDE_M 6000.0 /* width of the ground in the close-up */
#define WIDE_M          60.0   /* a pixel: from here on symbols are smallest */
#define NEAR_M          15.0   /* a pixel: up to here symbols are largest */
#define WIDE_SYMBOL     0.46   /* symbols' length in font sizes */
#define NEAR_SYMBOL     0.80
#define SYMBOL_LEAST    5.5 /* [pixel] */
#define TRIANGLE        5.0 /* length of the camera's triangle in font sizes */
#define WIDE_OPACITY    150 /* of tracks, as for symbols */
#define NEAR_OPACITY    210

static const struct rgba panel = {22, 26, 30, 255};
static const struct rgba rule = {10, 12, 14, 255};

static void begin(struct annotated_picture *picture, const struct world *world, uint32_t width,
                  uint32_t height)
{
    *picture = (struct annotated_picture){.world = world, .width = width, .height = height};
    map_layout_init(&picture->layout, width, height);
    base_map_open(&picture->whole, world);
    base_map_open(&picture->close_up.base, world);
    base_map_open(&picture->small.base, world);
}

int annotated_picture_open(struct annotated_picture *picture, const struct world *world,
                           uint32_t width, uint32_t height, struct error_text *error)
{
    begin(picture, world, width, height);
    picture->text = text_open(error);
    return picture->text == NULL ? -1 : 0;
}

void annotated_picture_open_shared(struct annotated_picture *picture,
                                   const struct annotated_picture *first, uint32_t width,
                                   uint32_t height)
{
    begin(picture, first->world, width, height);
    picture->text = first->text;
    picture->shares_text = true;
}

static void close_inset(struct annotated_picture_inset *inset)
{
    base_map_close(&inset->base);
    image_free(&inset->image);
}

void annotated_picture_close(struct annotated_picture *picture)
{
    if (!picture->shares_text)
        text_close(picture->text);
    base_map_close(&picture->whole);
    close_inset(&picture->close_up);
    close_inset(&picture->small);
}

int annotated_picture_inset_resize(struct annotated_picture_inset *inset, uint32_t width,
                                   uint32_t height)
{
    if (inset->image.pixels != NULL && inset->image.width == width && inset->image.height == height)
        return 0;
    image_free(&inset->image);
    return image_init(&inset->image, width, height);
}

void annotated_picture_shorten(struct annotated_picture *picture, char *label, uint32_t size,
                               int32_t width)
{
    size_t length = strlen(label);
    while (length > 0 && text_width(picture->text, size, label) > width) {
        label[--length] = '\0';
        if (length > 0)
            label[length - 1] = '.';
    }
}

int annotated_picture_ground(struct base_map *base, struct image *image,
                             const struct map_view *view,
                             const struct annotated_picture_source *source,
                             const struct annotated_picture_style *style)
{
    const struct frame_view *frame_view = source->frame_view;
    if (base_map_draw(base, image, view) != 0)
        return -1;
    map_earthworks(image, view, &frame_view->world->terrain.earthworks);
    map_objectives(image, view, frame_view);
    map_craters(image, view, frame_view->craters, style->symbol);
    if (style->tracks > 0)
        map_tracks(image, view, frame_view, source->tracks, style->symbol, style->tracks);
    if (source->camera != NULL)
        map_camera(image, view, source->camera, style->triangle);
    return 0;
}

void annotated_picture_symbols(struct image *image, const struct map_view *view,
                               const struct annotated_picture_source *source,
                               const struct annotated_picture_style *style)
{
    const struct frame_view *frame_view = source->frame_view;
    /* Detonations lie below the vehicles, and would cover a small map. */
    if (source->effects != NULL && style->symbol >= SYMBOL_LEAST)
        map_blasts(image, view, frame_view, source->effects, style->symbol);
    map_vehicles(image, view, frame_view, source->slot, style->symbol);
    if (source->slot != SLOT_NONE)
        map_followed(image, view, frame_view, source->slot, style->symbol, 0.8 * style->triangle);
}

/* Returns from 0 for a wide map to 1 for a close one. */
static double nearness(const struct map_view *view)
{
    return maths_clamp((WIDE_M - view->metres) / (WIDE_M - NEAR_M), 0.0, 1.0);
}

static struct annotated_picture_style style_of(const struct annotated_picture *picture,
                                               const struct map_view *view)
{
    double share = nearness(view), font_size = picture->layout.font_size;
    double symbol = (WIDE_SYMBOL + (NEAR_SYMBOL - WIDE_SYMBOL) * share) * font_size;
    return (struct annotated_picture_style){
        .symbol = maths_max(symbol, SYMBOL_LEAST),
        .triangle = TRIANGLE * font_size,
        .tracks = (uint8_t)(WIDE_OPACITY + (NEAR_OPACITY - WIDE_OPACITY) * share)};
}

/* Keeps labels off the followed vehicle and the ground ahead of it. */
static void take_followed(struct label_space *space, const struct map_view *view,
                          const struct annotated_picture_source *source, double length)
{
    const struct entities *e = source->frame_view->entities;
    if (source->slot == SLOT_NONE || space->count == LABEL_SPACE_MAX)
        return;
    struct point at = map_point(view, e->row[source->slot].x, e->row[source->slot].z);
    double ahead_x = at.x + length * maths_sin(e->row[source->slot].heading);
    double ahead_y = at.y - length * maths_cos(e->row[source->slot].heading);
    space->boxes[space->count++] =
        (struct box){(int32_t)maths_min(at.x, ahead_x), (int32_t)maths_min(at.y, ahead_y),
                     (int32_t)fabs(ahead_x - at.x) + 1, (int32_t)fabs(ahead_y - at.y) + 1};
}

/* Draws a map with its labels, which keep off the boxes that are already in the space. */
static int draw_map(struct annotated_picture *picture, struct base_map *base, struct image *image,
                    const struct map_view *view, const struct annotated_picture_source *source,
                    struct label_space *space)
{
    struct annotated_picture_style style = style_of(picture, view);
    space->bounds =
        (struct box){view->left, view->top, (int32_t)view->width, (int32_t)view->height};
    if (annotated_picture_ground(base, image, view, source, &style) != 0)
        return -1;
    take_followed(space, view, source, style.triangle);
    legend_marks(picture, image, view, source, space);
    annotated_picture_symbols(image, view, source, &style);
    return 0;
}

/* Fills the picture outside of a box, to cover what was drawn over the box's edges. */
static void blank_around(struct image *image, struct box box)
{
    int32_t width = (int32_t)image->width, height = (int32_t)image->height;
    int32_t right = box.left + box.width, bottom = box.top + box.height;
    image_rectangle(image, 0, 0, box.left, height, rule);
    image_rectangle(image, right, 0, width - right, height, rule);
    image_rectangle(image, box.left, 0, box.width, box.top, rule);
    image_rectangle(image, box.left, bottom, box.width, height - bottom, rule);
}

static int draw_whole(struct annotated_picture *picture, struct image *image,
                      const struct annotated_picture_source *source)
{
    struct box box = picture->layout.whole, corner = {0, 0, 0, 0};
    struct map_view view =
        map_whole(picture->world->terrain.squares.world_m, box.left, box.top, (uint32_t)box.width);
    struct label_space space = {.count = 0};
    if (picture->layout.legend.width == 0) {
        corner = legend_corner(picture, &view, source);
        space.boxes[space.count++] = corner;
    }
    if (draw_map(picture, &picture->whole, image, &view, source, &space) != 0)
        return -1;
    image_rectangle(image, corner.left, corner.top, corner.width, corner.height,
                    (struct rgba){panel.r, panel.g, panel.b, 215});
    if (corner.width > 0)
        legend_symbols(picture, image, corner, false);
    blank_around(image, box);
    return 0;
}

static int draw_close_up(struct annotated_picture *picture, struct image *image,
                         const struct annotated_picture_source *source)
{
    struct box box = picture->layout.close_up;
    double x = 0.5 * picture->world->terrain.squares.world_m, z = x;
    if (source->slot != SLOT_NONE) {
        x = source->frame_view->entities->row[source->slot].x;
        z = source->frame_view->entities->row[source->slot].z;
    }
    struct map_view view = map_around(x, z, CLOSE_UP_SIDE_M / box.width, 0, 0, (uint32_t)box.width,
                                      (uint32_t)box.height);
    struct label_space space = {.count = 0};
    map_align(&view);
    if (annotated_picture_inset_resize(&picture->close_up, view.width, view.height) != 0 ||
        draw_map(picture, &picture->close_up.base, &picture->close_up.image, &view, source,
                 &space) != 0)
        return -1;
    image_copy(image, &picture->close_up.image, box.left, box.top);
    return 0;
}

int annotated_picture_map(struct annotated_picture *picture, struct image *image,
                          const struct annotated_picture_source *source)
{
    const struct map_layout *layout = &picture->layout;
    if (draw_whole(picture, image, source) != 0)
        return -1;
    if (layout->close_up.width > 0 && draw_close_up(picture, image, source) != 0)
        return -1;
    if (layout->legend.width == 0)
        return 0;
    struct box figures = layout->figures, legend = layout->legend;
    image_rectangle(image, figures.left, figures.top, figures.width, figures.height, panel);
    image_rectangle(image, legend.left, legend.top, legend.width, legend.height, panel);
    legend_figures(picture, image, figures, source);
    legend_symbols(picture, image, legend, layout->close_up.width > 0);
    return 0;
}
