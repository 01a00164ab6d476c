/* Placing and drawing the map's labels. */
#include "renderer/chart/legend.h"

#include "renderer/chart/statistics_bar.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define GRID_LETTERS   6.0  /* font sizes between two lines, at least */
#define SCALE_SHARE    0.24 /* greatest width of the scale bar in the view's */
#define CROWD_STEP     3u   /* a better place for a label is worth covering so many vehicles */
#define SMALL_FONT_MIN 8u   /* [pixel] a smaller font cannot be read */
#define LEGEND_COLUMN  8    /* font sizes */
#define FIGURE_COLUMN  13
#define FIGURE_NAME    6 /* font sizes of a figure's name */
#define FIGURES_MAX    24u

static const struct rgba white = {240, 242, 238, 255};
static const struct rgba grey = {172, 180, 180, 255};
static const struct rgba amber = {255, 205, 96, 255};
static const struct rgba ink = {40, 44, 48, 255};
static const struct rgba water_name = {176, 214, 236, 255};

struct place {
    const char *name;
    double x, z;
    bool water;
};

/* Places of Fort Hunter Liggett, shown where the world has its terrain. */
static const struct place places[] = {
    {"Mission San Antonio", 25000.0, 17750.0, false},
    {"Jolon", 31500.0, 22450.0, false},
    {"Lake San Antonio", 44600.0, 33300.0, true},
    {"Pacific Ocean", 4600.0, 45800.0, true},
};

static uint32_t small_font_size(const struct annotated_picture *picture, uint32_t percent)
{
    uint32_t size = picture->layout.font_size * percent / 100;
    return size < SMALL_FONT_MIN ? SMALL_FONT_MIN : size;
}

static int32_t em_of(const struct annotated_picture *picture)
{
    return (int32_t)picture->layout.font_size;
}

/* Returns how many vehicles a box would touch. */
static uint32_t vehicles_under(const struct map_view *view,
                               const struct annotated_picture_source *source, struct box box)
{
    const struct entities *e = source->frame_view->entities;
    int32_t edge = box.height / 3; /* about half a symbol */
    box =
        (struct box){box.left - edge, box.top - edge, box.width + 2 * edge, box.height + 2 * edge};
    uint32_t count = 0;
    for (uint32_t i = 0; i < source->frame_view->head->used; i++) {
        struct point at = map_point(view, e->row[i].x, e->row[i].z);
        count += e->row[i].state != ENTITY_FREE && at.x >= box.left && at.y >= box.top &&
                 at.x < box.left + box.width && at.y < box.top + box.height;
    }
    return count;
}

/* Returns the index of the free box with the fewest vehicles in steps of CROWD_STEP, the first of
 * equals; -1 when none is free. */
static int32_t best_box(const struct map_view *view, const struct annotated_picture_source *source,
                        const struct label_space *space, const struct box *boxes, uint32_t count)
{
    int32_t best = -1;
    uint32_t fewest = UINT32_MAX;
    for (uint32_t i = 0; i < count; i++) {
        if (!label_space_free(space, boxes[i]))
            continue;
        uint32_t hidden = vehicles_under(view, source, boxes[i]) / CROWD_STEP;
        if (hidden < fewest) {
            fewest = hidden;
            best = (int32_t)i;
        }
    }
    return best;
}

/* --- marks ------------------------------------------------------------------------------------ */

static void format_length(char *label, size_t bytes, double metres)
{
    if (metres >= 1000.0)
        snprintf(label, bytes, "%.0f km", metres / 1000.0);
    else
        snprintf(label, bytes, "%.0f m", metres);
}

/* Draws a scale bar of a round length in a lower corner, with the contours' interval above it. */
static void scale_bar(struct annotated_picture *picture, struct image *image,
                      const struct map_view *view, const struct annotated_picture_source *source,
                      struct label_space *space)
{
    int32_t em = em_of(picture), thick = em / 3 > 3 ? em / 3 : 3;
    uint32_t size = small_font_size(picture, 90), fine = small_font_size(picture, 75);
    double length = map_round_down(SCALE_SHARE * view->width * view->metres);
    int32_t pixels = (int32_t)(length / view->metres);
    char label[24], interval[40];
    format_length(label, sizeof label, length);
    snprintf(interval, sizeof interval, "contours %.0f m", base_map_contour_m(view->metres));
    int32_t beside = text_width(picture->text, size, label) + em / 2;
    int32_t width = pixels + beside, over = text_width(picture->text, fine, interval);
    width = (width > over ? width : over) + 2;
    int32_t height = em * 2, left = view->left + em,
            top = view->top + (int32_t)view->height - em / 2;
    int32_t right = view->left + (int32_t)view->width - em - width;
    const struct box boxes[] = {{left, top - height, width, height},
                                {right, top - height, width, height}};
    int32_t best = best_box(view, source, space, boxes, 2);
    if (best < 0)
        return;
    label_space_take(space, boxes[best]);
    int32_t x = boxes[best].left, y = top - 2;
    image_rectangle(image, x - 1, y - thick - 1, pixels + 2, thick + 2,
                    (struct rgba){0, 0, 0, 210});
    for (int32_t i = 0; i < 4; i++)
        image_rectangle(image, x + i * pixels / 4, y - thick, (i + 1) * pixels / 4 - i * pixels / 4,
                        thick, i & 1 ? ink : white);
    text_draw_rimmed(picture->text, image, x + pixels + em / 2, y, size, white, label);
    /* The interval is drawn above the bar, and also above the length's text if it is so wide. */
    int32_t lift = over > pixels && thick + em / 3 < (int32_t)size ? (int32_t)size : thick + em / 3;
    text_draw_rimmed(picture->text, image, x, y - lift, fine, white, interval);
}

static void north_arrow(struct annotated_picture *picture, struct image *image,
                        const struct map_view *view, const struct annotated_picture_source *source,
                        struct label_space *space)
{
    int32_t em = em_of(picture), width = 2 * em, height = 7 * em / 2;
    int32_t top = view->top + em / 2, right = view->left + (int32_t)view->width - width - em / 2;
    const struct box boxes[] = {{right, top, width, height},
                                {view->left + 2 * em, top + em, width, height}};
    int32_t best = best_box(view, source, space, boxes, 2);
    if (best < 0)
        return;
    label_space_take(space, boxes[best]);
    double size = em, x = boxes[best].left + size, y = boxes[best].top + 1.7 * size;
    struct point left[3] = {{x, y - 1.6 * size}, {x - 0.55 * size, y + 0.4 * size}, {x, y}};
    struct point east[3] = {{x, y - 1.6 * size}, {x + 0.55 * size, y + 0.4 * size}, {x, y}};
    image_polygon(image, left, 3, white);
    image_polygon(image, east, 3, ink);
    int32_t half = text_width(picture->text, picture->layout.font_size, "N") / 2;
    text_draw_rimmed(picture->text, image, (int32_t)x - half, (int32_t)(y + 1.5 * size),
                     picture->layout.font_size, white, "N");
}

/* Draws a number of the grid beside its line, if there is room. */
static void grid_number(struct annotated_picture *picture, struct image *image,
                        struct label_space *space, int32_t x, int32_t y, double metres,
                        double step_m)
{
    uint32_t size = small_font_size(picture, 80);
    char label[16];
    snprintf(label, sizeof label, "%.*f", step_m < 1000.0 ? 1 : 0, metres / 1000.0);
    struct box box = {x, y, text_width(picture->text, size, label) + 3, (int32_t)size + 2};
    if (label_space_take(space, box))
        text_draw_rimmed(picture->text, image, x + 2, y + (int32_t)size, size, white, label);
}

static void grid_numbers(struct annotated_picture *picture, struct image *image,
                         const struct map_view *view, struct label_space *space, double step_m)
{
    const double side_m = picture->world->terrain.squares.world_m;
    double east = fmin(view->x + view->width * view->metres, side_m);
    double south = fmin(view->z + view->height * view->metres, side_m);
    for (int32_t n = (int32_t)ceil(fmax(view->x, 0.0) / step_m); n * step_m < east; n++)
        grid_number(picture, image, space, (int32_t)map_point(view, n * step_m, 0.0).x + 1,
                    view->top, n * step_m, step_m);
    for (int32_t n = (int32_t)ceil(fmax(view->z, 0.0) / step_m); n * step_m < south; n++)
        grid_number(picture, image, space, view->left,
                    (int32_t)map_point(view, 0.0, n * step_m).y + 1, n * step_m, step_m);
}

#define NAME_BOXES_MAX 14u

/* Fills the boxes that a name may take, the best first: beside its place, then farther away. The
 * name of a lake or sea lies on it. Returns how many there are. */
static uint32_t name_boxes(struct box boxes[NAME_BOXES_MAX], struct point at, bool water,
                           int32_t width, int32_t height, int32_t gap)
{
    /* The name's centre from its place, in widths and heights of the name; distance in gaps. */
    static const double beside[][3] = {
        {0.5, -0.5, 1.0}, {-0.5, -0.5, 1.0}, {0.5, 0.5, 1.0},   {-0.5, 0.5, 1.0},
        {0.0, 0.5, 2.0},  {0.0, -0.5, 2.0},  {0.5, -0.5, 6.0},  {-0.5, -0.5, 6.0},
        {0.5, 0.5, 6.0},  {-0.5, 0.5, 6.0},  {0.5, -0.5, 11.0}, {-0.5, -0.5, 11.0},
        {0.5, 0.5, 11.0}, {-0.5, 0.5, 11.0},
    };
    static const double upon[][3] = {{0.0, 0.0, 0.0}, {0.0, -1.5, 0.0}, {0.0, 1.5, 0.0}};
    const double(*places_of)[3] = water ? upon : beside;
    uint32_t count = water ? sizeof upon / sizeof upon[0] : NAME_BOXES_MAX;
    for (uint32_t i = 0; i < count; i++) {
        double x = places_of[i][0], y = places_of[i][1], out = places_of[i][2] * gap;
        double across = x > 0.0 ? out : x < 0.0 ? -out : 0.0;
        double down = y > 0.0 ? out : y < 0.0 ? -out : 0.0;
        boxes[i] = (struct box){(int32_t)(at.x + (x - 0.5) * width + across),
                                (int32_t)(at.y + (y - 0.5) * height + down), width, height};
    }
    return count;
}

/* Marks a place with a dot, and a line to a name that is far away. */
static void place_mark(struct annotated_picture *picture, struct image *image, struct point at,
                       struct box name)
{
    double left = name.left, right = left + name.width;
    double top = name.top, bottom = top + name.height;
    struct point to = {maths_clamp(at.x, left, right), maths_clamp(at.y, top, bottom)};
    double radius = 0.22 * em_of(picture);
    if (vec3_length((struct vec3){to.x - at.x, to.y - at.y, 0.0}) > em_of(picture) * 1.5) {
        double stroke = maths_max(em_of(picture) / 13.0, 1.2);
        image_line(image, at, to, stroke + 1.2, (struct rgba){ink.r, ink.g, ink.b, 150});
        image_line(image, at, to, stroke, white);
    }
    image_disc(image, at, radius + 1.0, ink);
    image_disc(image, at, radius, white);
}

static void place_name(struct annotated_picture *picture, struct image *image,
                       const struct map_view *view, const struct annotated_picture_source *source,
                       struct label_space *space, const struct place *place)
{
    uint32_t size = small_font_size(picture, 90);
    struct point at = map_point(view, place->x, place->z);
    struct box boxes[NAME_BOXES_MAX];
    int32_t width = text_width(picture->text, size, place->name) + 2;
    uint32_t count =
        name_boxes(boxes, at, place->water, width, (int32_t)size * 5 / 4, em_of(picture) / 3);
    int32_t best = best_box(view, source, space, boxes, count);
    if (!map_contains(view, at, 0.0) || best < 0)
        return;
    label_space_take(space, boxes[best]);
    if (!place->water)
        place_mark(picture, image, at, boxes[best]);
    text_draw_rimmed(picture->text, image, boxes[best].left + 1,
                     boxes[best].top + (int32_t)size * 19 / 20, size,
                     place->water ? water_name : white, place->name);
}

void legend_marks(struct annotated_picture *picture, struct image *image,
                  const struct map_view *view, const struct annotated_picture_source *source,
                  struct label_space *space)
{
    double step_m = map_round_down(GRID_LETTERS * 2.0 * picture->layout.font_size * view->metres);
    map_grid(image, view, picture->world->terrain.squares.world_m, step_m);
    scale_bar(picture, image, view, source, space);
    north_arrow(picture, image, view, source, space);
    if (strcmp(picture->world->params->name, "hunter-liggett") == 0)
        for (size_t i = 0; i < sizeof places / sizeof places[0]; i++)
            place_name(picture, image, view, source, space, &places[i]);
    grid_numbers(picture, image, view, space, step_m);
}

/* --- the legend ------------------------------------------------------------------------------- */

enum entry_symbol {
    ENTRY_VEHICLE,
    ENTRY_WRECK,
    ENTRY_FIRE,
    ENTRY_BLAST,
    ENTRY_MUNITION,
    ENTRY_CRATER
};

struct entry {
    const char *label;
    enum entry_symbol symbol;
    enum force force;
    enum symbol_shape shape;
};

/* By importance. */
static const struct entry entries[MAP_LAYOUT_SYMBOLS] = {
    {"blue", ENTRY_VEHICLE, FORCE_BLUE, SYMBOL_LAND},
    {"red", ENTRY_VEHICLE, FORCE_RED, SYMBOL_LAND},
    {"neutral", ENTRY_VEHICLE, FORCE_NEUTRAL, SYMBOL_LAND},
    {"wreck", ENTRY_WRECK, FORCE_NEUTRAL, SYMBOL_LAND},
    {"on fire", ENTRY_FIRE, FORCE_NEUTRAL, SYMBOL_LAND},
    {"detonation", ENTRY_BLAST, FORCE_NEUTRAL, SYMBOL_LAND},
    {"munition", ENTRY_MUNITION, FORCE_NEUTRAL, SYMBOL_LAND},
    {"crater", ENTRY_CRATER, FORCE_NEUTRAL, SYMBOL_LAND},
    {"tank", ENTRY_VEHICLE, FORCE_NEUTRAL, SYMBOL_TANK},
    {"carrier", ENTRY_VEHICLE, FORCE_NEUTRAL, SYMBOL_CARRIER},
    {"truck", ENTRY_VEHICLE, FORCE_NEUTRAL, SYMBOL_TRUCK},
    {"jeep", ENTRY_VEHICLE, FORCE_NEUTRAL, SYMBOL_JEEP},
    {"helicopter", ENTRY_VEHICLE, FORCE_NEUTRAL, SYMBOL_HELICOPTER},
    {"jet", ENTRY_VEHICLE, FORCE_NEUTRAL, SYMBOL_JET},
    {"ship", ENTRY_VEHICLE, FORCE_NEUTRAL, SYMBOL_SHIP},
};

#define ENTRIES_WITHOUT_KINDS 8

static void draw_entry(struct image *image, const struct entry *entry, struct point at,
                       double pixels)
{
    switch (entry->symbol) {
    case ENTRY_VEHICLE:
        symbol_vehicle(image, at, entry->shape, 0.0, pixels, entry->force);
        break;
    case ENTRY_WRECK:
        symbol_wreck(image, at, pixels);
        break;
    case ENTRY_FIRE:
        symbol_fire(image, at, pixels);
        break;
    case ENTRY_BLAST:
        symbol_blast(image, at, 0.0, 0.8 * pixels);
        break;
    case ENTRY_MUNITION:
        symbol_munition(image, at, 0.8, pixels);
        break;
    case ENTRY_CRATER:
        symbol_crater(image, at, 0.28 * pixels);
        break;
    }
}

static int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

void legend_symbols(struct annotated_picture *picture, struct image *image, struct box box,
                    bool kinds)
{
    int32_t em = em_of(picture), line = em * 7 / 5;
    int32_t columns = most((box.width - em) / (LEGEND_COLUMN * em), 1);
    int32_t fit = most((box.height - em / 2) / line, 0);
    int32_t count = kinds ? MAP_LAYOUT_SYMBOLS : ENTRIES_WITHOUT_KINDS;
    int32_t rows = (count + columns - 1) / columns;
    if (rows > fit) {
        rows = fit;
        count = columns * fit;
    }
    uint32_t size = small_font_size(picture, 85);
    for (int32_t i = 0; i < count && rows > 0; i++) {
        int32_t x = box.left + em + i / rows * ((box.width - em) / columns);
        int32_t y = box.top + em + i % rows * line;
        draw_entry(image, &entries[i], (struct point){x + 0.4 * em, y - 0.02 * em}, 0.8 * em);
        text_draw(picture->text, image, x + em * 8 / 5, y + em * 3 / 10, size, grey,
                  entries[i].label);
    }
}

struct box legend_corner(struct annotated_picture *picture, const struct map_view *view,
                         const struct annotated_picture_source *source)
{
    int32_t em = em_of(picture), width = em + 2 * LEGEND_COLUMN * em;
    int32_t height = em + ENTRIES_WITHOUT_KINDS / 2 * em * 7 / 5 - em / 3, gap = em / 2;
    int32_t right = view->left + (int32_t)view->width - width - gap;
    int32_t bottom = view->top + (int32_t)view->height - height - gap;
    const struct label_space none = {
        .bounds = {view->left, view->top, (int32_t)view->width, (int32_t)view->height}};
    const struct box boxes[] = {{right, bottom, width, height},
                                {view->left + gap, bottom, width, height},
                                {view->left + 2 * em, view->top + 2 * em, width, height}};
    int32_t best = best_box(view, source, &none, boxes, 3);
    return best < 0 ? (struct box){0, 0, 0, 0} : boxes[best];
}

/* --- figures ---------------------------------------------------------------------------------- */

struct figure {
    const char *name;
    char value[40];
    struct rgba colour;
};

static uint32_t world_figures(struct figure *figures, const struct frame_view *frame_view)
{
    const struct state_head *head = frame_view->head;
    const struct {
        const char *name;
        uint64_t number;
    } counts[] = {
        {"vehicles", head->vehicles},           {"in flight", head->munitions},
        {"collisions", head->tally.collisions}, {"destroyed", head->tally.destroyed},
        {"craters", head->crater_count},
    };
    uint32_t n = sizeof counts / sizeof counts[0];
    for (uint32_t i = 0; i < n; i++) {
        figures[i] = (struct figure){.name = counts[i].name, .colour = white};
        snprintf(figures[i].value, sizeof figures[i].value, "%llu",
                 (unsigned long long)counts[i].number);
    }
    return n;
}

static uint32_t vehicle_figures(struct figure *figures, const struct statistics *s)
{
    uint32_t n = 0;
#define FIGURE(title, ...)                                                                         \
    do {                                                                                           \
        figures[n] = (struct figure){.name = (title), .colour = white};                            \
        snprintf(figures[n].value, sizeof figures[n].value, __VA_ARGS__);                          \
        n++;                                                                                       \
    } while (0)
    FIGURE("speed", "%.1f km/h", s->speed_kmh);
    FIGURE("heading", "%05.1f", s->heading_deg);
    FIGURE("altitude", "%.0f m", s->altitude_m);
    FIGURE("damage", "%s", s->damage);
    FIGURE("behaviour", "%s", s->behaviour);
    FIGURE("rounds", "%u", s->rounds);
    FIGURE("fuel", "%.0f%%", 100.0 * s->fuel_share);
#undef FIGURE
    return n;
}

/* Draws the vehicle's name, and force and kind if there is room. Returns where the figures begin.
 */
static int32_t title(struct annotated_picture *picture, struct image *image, struct box box,
                     const struct statistics *s)
{
    int32_t em = em_of(picture), y = box.top + em * 17 / 10, width = box.width - 2 * em;
    uint32_t large = picture->layout.font_size * 6 / 5;
    char name[sizeof s->name], label[64];
    snprintf(name, sizeof name, "%s", s->name);
    snprintf(label, sizeof label, "%s %s", s->force, s->kind);
    annotated_picture_shorten(picture, name, large, width);
    int32_t end = text_draw(picture->text, image, box.left + em, y, large, amber, name) + em;
    if (end + text_width(picture->text, picture->layout.font_size, label) <=
        box.left + box.width - em)
        text_draw(picture->text, image, end, y, picture->layout.font_size, grey, label);
    return y + em * 7 / 5;
}

void legend_figures(struct annotated_picture *picture, struct image *image, struct box box,
                    const struct annotated_picture_source *source)
{
    const struct frame_view *frame_view = source->frame_view;
    struct figure figures[FIGURES_MAX];
    uint32_t count = 1, size = picture->layout.font_size * 19 / 20;
    int32_t em = em_of(picture), line = em * 27 / 20, y = box.top + em * 3 / 2;
    figures[0] = (struct figure){.name = "time", .colour = white};
    snprintf(figures[0].value, sizeof figures[0].value, "%.2f s", frame_view_time_s(frame_view));
    if (source->slot != SLOT_NONE) {
        struct statistics s;
        statistics_of(&s, frame_view, source->slot);
        y = title(picture, image, box, &s);
        count += vehicle_figures(figures + count, &s);
    }
    count += world_figures(figures + count, frame_view);
    int32_t columns = most((box.width - 2 * em) / (FIGURE_COLUMN * em), 1);
    int32_t rows = most((box.top + box.height - y + em) / line, 0);
    if (rows * columns > (int32_t)count)
        rows = ((int32_t)count + columns - 1) / columns;
    for (int32_t i = 0; i < (int32_t)count && i < rows * columns; i++) {
        int32_t x = box.left + em + i / rows * ((box.width - 2 * em) / columns);
        int32_t at = y + i % rows * line;
        text_draw(picture->text, image, x, at, size, grey, figures[i].name);
        text_draw(picture->text, image, x + em * FIGURE_NAME, at, size, figures[i].colour,
                  figures[i].value);
    }
}
