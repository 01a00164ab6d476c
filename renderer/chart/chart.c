/* Layout and lettering. Sizes follow from the picture's height, so that every size can be read. */
#include "renderer/chart/chart.h"

#include "world/square.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define CONTOUR_WHOLE_M 100.0
#define CONTOUR_CLOSE_M 20.0
#define CLOSE_UP_SIDE_M 6000.0
#define GRID_WHOLE_M    10000.0
#define GRID_CLOSE_M    1000.0
#define PANEL_LEAST     200u /* [pixel] a narrower side panel is left out */

static const struct rgba white = {240, 242, 238, 255};
static const struct rgba grey = {168, 176, 176, 255};
static const struct rgba green = {176, 232, 150, 255};
static const struct rgba amber = {255, 205, 96, 255};
static const struct rgba panel = {22, 26, 30, 255};

struct place {
    const char *name;
    double x, z;
};

/* Places of Fort Hunter Liggett, where its ground is what the world shows. */
static const struct place places[] = {
    {"Mission San Antonio", 25000.0, 17750.0},
    {"Jolon", 31500.0, 22450.0},
    {"Lake San Antonio", 38500.0, 29200.0},
    {"Pacific Ocean", 3200.0, 40500.0},
};

static uint32_t side_of(const struct chart *chart)
{
    return chart->height < chart->width ? chart->height : chart->width;
}

static uint32_t panel_width(const struct chart *chart)
{
    uint32_t left = chart->width - side_of(chart);
    return left >= PANEL_LEAST ? left : 0;
}

static uint32_t letters(const struct chart *chart)
{
    uint32_t size = chart->height / 48;
    return size < 9 ? 9 : size;
}

static struct map_view close_view(const struct chart *chart, double x, double z)
{
    uint32_t width = panel_width(chart);
    return map_around(x, z, CLOSE_UP_SIDE_M, (int32_t)side_of(chart), 0, width,
                      chart->height * 11 / 20);
}

int chart_open(struct chart *chart, const struct world *world, uint32_t width, uint32_t height,
               struct reason *reason)
{
    *chart = (struct chart){.world = world, .width = width, .height = height};
    uint32_t side = side_of(chart), small = side / 4;
    struct map_view whole = map_whole(0, 0, side), corner = map_whole(0, 0, small);
    struct map_view close = close_view(chart, 0.0, 0.0);
    chart->text = text_open(reason);
    if (chart->text == NULL)
        return -1;
    if (image_init(&chart->whole, side, side) == 0 &&
        image_init(&chart->small, small, small) == 0 &&
        (close.width == 0 || image_init(&chart->close_up, close.width, close.height) == 0) &&
        map_ground(&chart->whole, &whole, world, NULL, CONTOUR_WHOLE_M) == 0 &&
        map_ground(&chart->small, &corner, world, NULL, 4.0 * CONTOUR_WHOLE_M) == 0) {
        map_roads(&chart->whole, &whole, world, 1.0);
        return 0;
    }
    chart_close(chart);
    return reason_set(reason, "no memory for a %ux%u map", width, height);
}

void chart_close(struct chart *chart)
{
    text_close(chart->text);
    image_free(&chart->whole);
    image_free(&chart->small);
    image_free(&chart->close_up);
}

/* --- the map ---------------------------------------------------------------------------------- */

static void grid_numbers(struct chart *chart, struct image *image, const struct map_view *view,
                         double step_m)
{
    uint32_t size = letters(chart) * 4 / 5;
    char words[16];
    double east = view->x + view->width * view->metres - 0.3 * step_m;
    double south = view->z + view->height * view->metres - 0.3 * step_m;
    for (int32_t n = (int32_t)ceil(view->x / step_m); n * step_m < east; n++) {
        double x = n * step_m;
        snprintf(words, sizeof words, "%.0f", x / 1000.0);
        text_draw_rimmed(chart->text, image, (int32_t)map_point(view, x, 0.0).x + 3,
                         view->top + (int32_t)size, size, grey, words);
    }
    for (int32_t n = (int32_t)ceil(view->z / step_m + 0.2); n * step_m < south; n++) {
        double z = n * step_m;
        snprintf(words, sizeof words, "%.0f", z / 1000.0);
        text_draw_rimmed(chart->text, image, view->left + 3,
                         (int32_t)map_point(view, 0.0, z).y + (int32_t)size, size, grey, words);
    }
}

/* A bar of a length that is easily read, in the lower left corner. */
static void scale_bar(struct chart *chart, struct image *image, const struct map_view *view,
                      double length_m)
{
    int32_t pixels = (int32_t)(length_m / view->metres), size = (int32_t)letters(chart);
    int32_t x = view->left + size, y = view->top + (int32_t)view->height - size;
    char words[24];
    image_rectangle(image, x - 1, y - 6, pixels + 2, 7, (struct rgba){0, 0, 0, 200});
    for (int32_t i = 0; i < 4; i++)
        image_rectangle(image, x + i * pixels / 4, y - 5, pixels / 4, 5,
                        i & 1 ? (struct rgba){40, 44, 48, 255} : white);
    snprintf(words, sizeof words, "%.0f km", length_m / 1000.0);
    text_draw_rimmed(chart->text, image, x + pixels + 8, y, (uint32_t)size * 9 / 10, white, words);
}

static void north_arrow(struct chart *chart, struct image *image, int32_t x, int32_t y)
{
    double size = (double)letters(chart);
    struct point left[3] = {{x, y - 1.6 * size}, {x - 0.55 * size, y + 0.4 * size}, {x, y}};
    struct point right[3] = {{x, y - 1.6 * size}, {x + 0.55 * size, y + 0.4 * size}, {x, y}};
    image_polygon(image, left, 3, white);
    image_polygon(image, right, 3, (struct rgba){40, 44, 48, 255});
    text_draw_rimmed(chart->text, image, x - (int32_t)(0.3 * size), y + (int32_t)(1.5 * size),
                     (uint32_t)size, white, "N");
}

static void place_names(struct chart *chart, struct image *image, const struct map_view *view)
{
    if (strcmp(chart->world->params->name, "hunter-liggett") != 0)
        return;
    uint32_t size = letters(chart) * 9 / 10;
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        struct point at = map_point(view, places[i].x, places[i].z);
        if (!map_holds(view, at, -20.0))
            continue;
        bool water = i >= 2;
        if (!water)
            image_disc(image, at, 2.5, white);
        text_draw_rimmed(chart->text, image, (int32_t)at.x + 6, (int32_t)at.y - 4, size,
                         water ? (struct rgba){176, 214, 236, 255} : white, places[i].name);
    }
}

static void draw_moment(struct image *image, const struct map_view *view,
                        const struct moment *moment, const struct tracks *tracks, uint32_t slot,
                        double pixels)
{
    map_tracks(image, view, moment, tracks);
    map_vehicles(image, view, moment, pixels);
    if (slot != SLOT_NONE)
        map_followed(image, view, moment, slot, pixels);
}

static void legend_row(struct chart *chart, struct image *image, int32_t x, int32_t y,
                       enum domain domain, const char *words)
{
    double size = (double)letters(chart);
    map_symbol(image, (struct point){x + 0.5 * size, y - 0.35 * size}, domain, 0.0, 0.75 * size,
               map_force_colour(FORCE_NEUTRAL));
    text_draw(chart->text, image, x + (int32_t)(1.7 * size), y, (uint32_t)size * 17 / 20, grey,
              words);
}

static void legend(struct chart *chart, struct image *image, int32_t x, int32_t y)
{
    int32_t size = (int32_t)letters(chart), line = size * 7 / 5;
    static const struct {
        enum force force;
        const char *words;
    } forces[] = {{FORCE_BLUE, "blue"}, {FORCE_RED, "red"}, {FORCE_NEUTRAL, "neutral"}};
    for (int32_t i = 0; i < 3; i++) {
        image_rectangle(image, x, y + i * line - size * 3 / 4, size, size * 3 / 4,
                        map_force_colour(forces[i].force));
        text_draw(chart->text, image, x + size * 17 / 10, y + i * line, (uint32_t)size * 17 / 20,
                  grey, forces[i].words);
    }
    int32_t right = x + size * 8;
    legend_row(chart, image, right, y, DOMAIN_LAND, "on land");
    legend_row(chart, image, right, y + line, DOMAIN_AIR, "in the air");
    legend_row(chart, image, right, y + 2 * line, DOMAIN_SEA, "at sea");
    right += size * 10;
    legend_row(chart, image, right, y, DOMAIN_MUNITION, "munition");
    map_cross(image, (struct point){right + 0.5 * size, y + line - 0.35 * size}, size);
    text_draw(chart->text, image, right + size * 17 / 10, y + line, (uint32_t)size * 17 / 20, grey,
              "wreck");
}

/* One line of the panel: a name and its value. */
static int32_t figure(struct chart *chart, struct image *image, int32_t x, int32_t y,
                      const char *name, const char *value)
{
    uint32_t size = letters(chart);
    text_draw(chart->text, image, x, y, size, grey, name);
    text_draw(chart->text, image, x + (int32_t)size * 6, y, size, white, value);
    return y + (int32_t)size * 13 / 10;
}

static void panel_figures(struct chart *chart, struct image *image, const struct moment *moment,
                          uint32_t slot, int32_t x, int32_t y)
{
    char value[96];
    const struct state_head *head = moment->head;
    uint32_t size = letters(chart);
    if (slot != SLOT_NONE) {
        struct statistics s;
        statistics_of(&s, moment, slot);
        snprintf(value, sizeof value, "%s  (%s %s)", s.name, s.force, s.kind);
        text_draw(chart->text, image, x, y, size * 6 / 5, amber, value);
        y += (int32_t)size * 8 / 5;
        snprintf(value, sizeof value, "%.1f km/h, heading %03.0f", s.speed_kmh, s.heading_deg);
        y = figure(chart, image, x, y, "moving", value);
        snprintf(value, sizeof value, "%s, damage %s", s.behaviour, s.damage);
        y = figure(chart, image, x, y, "state", value);
        snprintf(value, sizeof value, "%u rounds, fuel %.0f %%", s.rounds, 100.0 * s.fuel_share);
        y = figure(chart, image, x, y, "carries", value);
    }
    snprintf(value, sizeof value, "%u vehicles, %u munitions in flight", head->vehicles,
             head->munitions);
    y = figure(chart, image, x, y, "world", value);
    snprintf(value, sizeof value, "%llu collisions, %llu destroyed, %u craters",
             (unsigned long long)head->tally.collisions, (unsigned long long)head->tally.destroyed,
             head->crater_count);
    y = figure(chart, image, x, y, "so far", value);
    snprintf(value, sizeof value, "%.1f s, frame %llu", world_time_s(moment->world, head),
             (unsigned long long)head->frame);
    figure(chart, image, x, y, "time", value);
}

static int draw_panel(struct chart *chart, struct image *image, const struct moment *moment,
                      const struct tracks *tracks, uint32_t slot)
{
    int32_t left = (int32_t)side_of(chart), size = (int32_t)letters(chart);
    int32_t width = (int32_t)panel_width(chart);
    double x = 0.5 * WORLD_SIDE_M, z = x;
    if (slot != SLOT_NONE) {
        x = moment->entities->x[slot];
        z = moment->entities->z[slot];
    }
    struct map_view view = close_view(chart, x, z);
    if (map_ground(&chart->close_up, &view, moment->world, moment->craters, CONTOUR_CLOSE_M) != 0)
        return -1;
    image_copy(image, &chart->close_up, view.left, view.top);
    map_roads(image, &view, moment->world, 2.0);
    map_grid(image, &view, GRID_CLOSE_M);
    map_craters(image, &view, moment->craters);
    place_names(chart, image, &view);
    draw_moment(image, &view, moment, tracks, slot, 11.0 * chart->height / 720.0);
    scale_bar(chart, image, &view, 1000.0);

    int32_t top = (int32_t)view.height;
    image_rectangle(image, left, top, width, (int32_t)chart->height - top, panel);
    image_rectangle(image, left, 0, 2, (int32_t)chart->height, (struct rgba){10, 12, 14, 255});
    panel_figures(chart, image, moment, slot, left + size, top + size * 2);
    legend(chart, image, left + size, (int32_t)chart->height - size * 4);
    return 0;
}

int chart_map(struct chart *chart, struct image *image, const struct moment *moment,
              const struct tracks *tracks, uint32_t slot)
{
    uint32_t side = side_of(chart);
    struct map_view view = map_whole(0, 0, side);
    image_rectangle(image, 0, 0, (int32_t)chart->width, (int32_t)chart->height, panel);
    image_copy(image, &chart->whole, 0, 0);
    map_grid(image, &view, GRID_WHOLE_M);
    grid_numbers(chart, image, &view, GRID_WHOLE_M);
    map_craters(image, &view, moment->craters);
    place_names(chart, image, &view);
    draw_moment(image, &view, moment, tracks, slot, 7.0 * chart->height / 720.0);
    scale_bar(chart, image, &view, 10000.0);
    north_arrow(chart, image, (int32_t)(side - letters(chart) * 2), (int32_t)letters(chart) * 3);
    if (panel_width(chart) == 0)
        return 0;
    return draw_panel(chart, image, moment, tracks, slot);
}

/* --- instruments ------------------------------------------------------------------------------ */

static void small_map(struct chart *chart, struct image *image, const struct moment *moment,
                      const struct tracks *tracks, uint32_t slot)
{
    uint32_t side = chart->small.width;
    int32_t gap = (int32_t)chart->height / 60;
    int32_t left = (int32_t)(chart->width - side) - gap;
    struct map_view view = map_whole(left, gap, side);
    image_rectangle(image, left - 2, gap - 2, (int32_t)side + 4, (int32_t)side + 4,
                    (struct rgba){10, 12, 14, 200});
    image_copy(image, &chart->small, left, gap);
    draw_moment(image, &view, moment, tracks, slot, 4.0 * chart->height / 720.0);
}

struct gauge {
    const char *name;
    char value[32];
    struct rgba colour;
    int32_t letters; /* the widest value's */
};

static uint32_t fill_gauges(struct gauge *gauges, const struct statistics *s)
{
    uint32_t n = 0;
    const struct rgba alarm = {255, 120, 90, 255};
    bool hurt = strcmp(s->damage, damage_name(DAMAGE_NONE)) != 0;
#define GAUGE(title, widest, tone, ...)                                                            \
    do {                                                                                           \
        gauges[n].name = (title);                                                                  \
        gauges[n].letters = (widest);                                                              \
        gauges[n].colour = (tone);                                                                 \
        snprintf(gauges[n].value, sizeof gauges[n].value, __VA_ARGS__);                            \
        n++;                                                                                       \
    } while (0)
    GAUGE("SPEED km/h", 7, green, "%.1f", s->speed_kmh);
    GAUGE("HEADING", 6, green, "%05.1f", s->heading_deg);
    GAUGE("PITCH", 6, green, "%+.1f", s->pitch_deg);
    GAUGE("ROLL", 6, green, "%+.1f", s->roll_deg);
    GAUGE("ALTITUDE m", 7, green, "%.0f", s->altitude_m);
    GAUGE("ROUNDS", 5, s->rounds == 0 ? alarm : green, "%u", s->rounds);
    GAUGE("FUEL", 5, s->fuel_share < 0.1 ? alarm : green, "%.0f%%", 100.0 * s->fuel_share);
    GAUGE("DAMAGE", 10, hurt ? alarm : green, "%s", s->damage);
    GAUGE("BEHAVIOUR", 9, green, "%s", s->behaviour);
    GAUGE("TIME s", 8, white, "%.2f", s->time_s);
    GAUGE("FRAME", 8, white, "%llu", (unsigned long long)s->frame);
#undef GAUGE
    return n;
}

static void statistics_bar(struct chart *chart, struct image *image, const struct statistics *s)
{
    int32_t height = (int32_t)chart->height * 7 / 100, width = (int32_t)chart->width;
    if (height < 30)
        height = 30;
    int32_t top = (int32_t)chart->height - height, x = width / 90;
    int32_t upper = top + height * 36 / 100, lower = top + height * 82 / 100;
    image_rectangle(image, 0, top, width, height, (struct rgba){12, 15, 18, 190});
    image_rectangle(image, 0, top, width, 1, (struct rgba){255, 255, 255, 60});

    struct gauge gauges[12];
    uint32_t count = fill_gauges(gauges, s);
    int32_t letters_in_all = 15; /* the name's */
    for (uint32_t i = 0; i < count; i++)
        letters_in_all += gauges[i].letters;
    int32_t step = (width - 2 * x) / letters_in_all; /* a letter's place; letters are narrower */
    uint32_t large = (uint32_t)(step < height / 4 ? step * 3 / 2 : height * 38 / 100);
    uint32_t small = large * 7 / 10;
    char words[96];
    snprintf(words, sizeof words, "%s %s", s->force, s->kind);
    text_draw(chart->text, image, x, upper, small, grey, words);
    text_draw(chart->text, image, x, lower, large, amber, s->name);
    x += 15 * step;
    for (uint32_t i = 0; i < count; i++) {
        text_draw(chart->text, image, x, upper, small, grey, gauges[i].name);
        text_draw(chart->text, image, x, lower, large, gauges[i].colour, gauges[i].value);
        x += gauges[i].letters * step;
    }
}

void chart_instruments(struct chart *chart, struct image *image, const struct moment *moment,
                       const struct tracks *tracks, uint32_t slot)
{
    small_map(chart, image, moment, tracks, slot);
    if (slot == SLOT_NONE)
        return;
    struct statistics s;
    statistics_of(&s, moment, slot);
    statistics_bar(chart, image, &s);
}
