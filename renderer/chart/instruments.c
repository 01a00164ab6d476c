/* The instruments over a camera's picture: the small map and the statistics bar. */
#include "renderer/chart/instruments.h"

#include "renderer/chart/statistics_bar.h"

#include <stdio.h>
#include <string.h>

#define BAR_LETTERS   38  /* font sizes in a picture's height */
#define BAR_ACROSS    64  /* font sizes in its width; the smaller font is taken */
#define BAR_LEAST     11u /* [pixel] smaller values cannot be read at a glance */
#define NAME_LEAST    8u
#define ROWS_MOST     2u
#define ROW_LESS_THAN 280u /* [pixel] a lower picture has one row of fields */
#define SMALL_SHARE   4    /* the picture's shorter side by the small map's side */
#define SMALL_SYMBOL  4.0  /* [pixel] at a height of 720 */

static const struct rgba white = {240, 242, 238, 255};
static const struct rgba grey = {176, 184, 184, 255};
static const struct rgba amber = {255, 205, 96, 255};
static const struct rgba back = {12, 15, 18, 190};

static void small_map(struct annotated_picture *picture, struct image *image,
                      const struct annotated_picture_source *source)
{
    uint32_t side =
        (picture->width < picture->height ? picture->width : picture->height) / SMALL_SHARE;
    int32_t gap = (int32_t)side / 15, left = (int32_t)(picture->width - side) - gap;
    struct map_view view = map_whole(picture->world->terrain.squares.world_m, 0, 0, side);
    struct annotated_picture_style style = {.symbol = maths_max(SMALL_SYMBOL * side / 180.0, 3.0),
                                            .triangle = 0.25 * side};
    if (annotated_picture_inset_resize(&picture->small, side, side) != 0 ||
        annotated_picture_ground(&picture->small.base, &picture->small.image, &view, source,
                                 &style) != 0)
        return;
    annotated_picture_symbols(&picture->small.image, &view, source, &style);
    image_rectangle(image, left - 2, gap - 2, (int32_t)side + 4, (int32_t)side + 4,
                    (struct rgba){10, 12, 14, 200});
    image_copy(image, &picture->small.image, left, gap);
}

/* --- the bar ---------------------------------------------------------------------------------- */

struct cell {
    const struct statistics_bar_field *field; /* NULL: left out */
    int32_t width;                            /* with the gap behind it */
    uint32_t row;
};

struct bar {
    uint32_t large, small; /* [pixel] font sizes of values and of names */
    int32_t margin, row_height, name_width;
    uint32_t rows, count;
    struct cell cells[STATISTICS_BAR_MAX];
};

static int32_t cell_width(struct annotated_picture *picture, const struct bar *bar,
                          const struct statistics_bar_field *field, int32_t gap)
{
    int32_t name = text_width(picture->text, bar->small, field->name);
    int32_t widest = text_width(picture->text, bar->large, field->widest);
    int32_t value = text_width(picture->text, bar->large, field->value);
    value = value > widest ? value : widest;
    return (name > value ? name : value) + gap;
}

/* Distributes the cells over rows. Returns false if they do not fit. */
static bool fill_rows(struct bar *bar, int32_t width, uint32_t rows)
{
    int32_t room = width - 2 * bar->margin - bar->name_width, x = 0, total = 0;
    uint32_t row = 0;
    for (uint32_t i = 0; i < bar->count; i++)
        total += bar->cells[i].field != NULL ? bar->cells[i].width : 0;
    /* Rows of about equal length look better than a full one above a short one. */
    int32_t target = rows == 1 ? room : total / (int32_t)rows;
    for (uint32_t i = 0; i < bar->count; i++) {
        struct cell *cell = &bar->cells[i];
        if (cell->field == NULL)
            continue;
        if (x > 0 && (x + cell->width > room || (x + cell->width / 2 > target && row + 1 < rows))) {
            row++;
            x = 0;
        }
        if (row == rows || x + cell->width > room)
            return false;
        cell->row = row;
        x += cell->width;
    }
    bar->rows = rows;
    return true;
}

/* Leaves out the least important field, if its rank is at least this. */
static void leave_out_one(struct bar *bar, uint32_t rank)
{
    struct cell *last = NULL;
    for (uint32_t i = 0; i < bar->count; i++)
        if (bar->cells[i].field != NULL && bar->cells[i].field->rank >= rank &&
            (last == NULL || bar->cells[i].field->rank > last->field->rank))
            last = &bar->cells[i];
    if (last != NULL)
        last->field = NULL;
}

/* Gives every field a cell of its width and the gap. */
static void measure(struct annotated_picture *picture, struct bar *bar,
                    const struct statistics_bar_field *fields, int32_t gap)
{
    for (uint32_t i = 0; i < bar->count; i++)
        bar->cells[i] =
            (struct cell){.field = &fields[i], .width = cell_width(picture, bar, &fields[i], gap)};
}

/* Takes one row if the fields fit, perhaps with a smaller gap and without the spare field; else
 * two. If they do not fit either, the least important fields are left out. */
static void choose_rows(struct annotated_picture *picture, struct bar *bar,
                        const struct statistics_bar_field *fields)
{
    int32_t width = (int32_t)picture->width, large = (int32_t)bar->large;
    measure(picture, bar, fields, large * 3 / 4);
    if (fill_rows(bar, width, 1))
        return;
    measure(picture, bar, fields, large / 2);
    if (fill_rows(bar, width, 1))
        return;
    leave_out_one(bar, STATISTICS_BAR_RANK_SPARE);
    if (fill_rows(bar, width, 1))
        return;
    uint32_t most = picture->height < ROW_LESS_THAN ? 1 : ROWS_MOST;
    if (most > 1)
        measure(picture, bar, fields, large * 3 / 4);
    while (!fill_rows(bar, width, most))
        leave_out_one(bar, 0);
}

/* Widens the cells of each row by the room that is left, to a limit. */
static void spread(struct bar *bar, int32_t width)
{
    for (uint32_t row = 0; row < bar->rows; row++) {
        int32_t left = width - 2 * bar->margin - bar->name_width, count = 0;
        for (uint32_t i = 0; i < bar->count; i++)
            if (bar->cells[i].field != NULL && bar->cells[i].row == row) {
                left -= bar->cells[i].width;
                count++;
            }
        int32_t more = count > 0 ? left / count : 0, most = (int32_t)bar->large * 3 / 2;
        for (uint32_t i = 0; i < bar->count; i++)
            if (bar->cells[i].row == row)
                bar->cells[i].width += more < most ? more : most;
    }
}

static void arrange(struct annotated_picture *picture, struct bar *bar,
                    const struct statistics_bar_field *fields, uint32_t count,
                    const struct statistics *s)
{
    uint32_t height = picture->height / BAR_LETTERS, across = picture->width / BAR_ACROSS;
    char label[64];
    bar->large = height < across ? height : across;
    bar->large = bar->large < BAR_LEAST ? BAR_LEAST : bar->large;
    bar->small = bar->large * 2 / 3 < NAME_LEAST ? NAME_LEAST : bar->large * 2 / 3;
    bar->margin = (int32_t)bar->large * 2 / 3;
    bar->row_height = (int32_t)(bar->large + bar->small) * 4 / 3;
    snprintf(label, sizeof label, "%s %s", s->force, s->kind);
    int32_t kind = text_width(picture->text, bar->small, label);
    int32_t name = text_width(picture->text, bar->large, s->name),
            most_name = (int32_t)picture->width / 5;
    bar->name_width = (name > kind ? name : kind) + (int32_t)bar->large;
    if (bar->name_width > most_name)
        bar->name_width = most_name;
    bar->count = count;
    choose_rows(picture, bar, fields);
    spread(bar, (int32_t)picture->width);
}

static void draw_cell(struct annotated_picture *picture, struct image *image, const struct bar *bar,
                      const struct statistics_bar_field *field, int32_t x, int32_t top)
{
    static const struct rgba colours[] = {[STATISTICS_BAR_GOOD] = {176, 232, 150, 255},
                                          [STATISTICS_BAR_PLAIN] = {240, 242, 238, 255},
                                          [STATISTICS_BAR_WARNING] = {255, 214, 92, 255},
                                          [STATISTICS_BAR_ALARM] = {255, 255, 255, 255}};
    int32_t small = (int32_t)bar->small, large = (int32_t)bar->large;
    int32_t upper = top + small * 11 / 10, lower = upper + large * 11 / 10;
    /* Alarms can be told without colour: an alarm has a red background, a warning an underline. */
    if (field->state >= STATISTICS_BAR_WARNING) {
        int32_t width = text_width(picture->text, bar->large, field->value);
        int32_t height = field->state == STATISTICS_BAR_ALARM ? large * 108 / 100 : 1 + large / 16;
        int32_t foot = lower + large * 2 / 10;
        image_rectangle(image, x - large / 6, foot - height, width + large / 3, height,
                        field->state == STATISTICS_BAR_ALARM ? (struct rgba){196, 36, 20, 255}
                                                             : colours[STATISTICS_BAR_WARNING]);
    }
    text_draw(picture->text, image, x, upper, bar->small, grey, field->name);
    text_draw(picture->text, image, x, lower, bar->large, colours[field->state], field->value);
}

static void draw_name(struct annotated_picture *picture, struct image *image, const struct bar *bar,
                      const struct statistics *s, int32_t top)
{
    int32_t small = (int32_t)bar->small, upper = top + small * 11 / 10;
    char name[sizeof s->name], label[64];
    snprintf(name, sizeof name, "%s", s->name);
    snprintf(label, sizeof label, "%s %s", s->force, s->kind);
    annotated_picture_shorten(picture, name, bar->large, bar->name_width - (int32_t)bar->large / 2);
    annotated_picture_shorten(picture, label, bar->small,
                              bar->name_width - (int32_t)bar->large / 2);
    text_draw(picture->text, image, bar->margin, upper, bar->small, grey, label);
    text_draw(picture->text, image, bar->margin, upper + (int32_t)bar->large * 11 / 10, bar->large,
              amber, name);
}

static void statistics_bar(struct annotated_picture *picture, struct image *image,
                           const struct statistics *s, double fps)
{
    struct statistics_bar_field fields[STATISTICS_BAR_MAX];
    struct bar bar = {.rows = 0};
    arrange(picture, &bar, fields, statistics_bar_of(fields, s, fps), s);
    int32_t width = (int32_t)picture->width, pad = (int32_t)bar.small / 3;
    int32_t height = (int32_t)bar.rows * bar.row_height + pad;
    int32_t top = (int32_t)picture->height - height;
    image_rectangle(image, 0, top, width, height, back);
    image_rectangle(image, 0, top, width, 1, (struct rgba){white.r, white.g, white.b, 60});
    draw_name(picture, image, &bar, s, top + pad);
    int32_t x = 0;
    uint32_t row = 0;
    for (uint32_t i = 0; i < bar.count; i++) {
        const struct cell *cell = &bar.cells[i];
        if (cell->field == NULL)
            continue;
        if (cell->row != row)
            x = 0;
        row = cell->row;
        draw_cell(picture, image, &bar, cell->field, bar.margin + bar.name_width + x,
                  top + pad + (int32_t)row * bar.row_height);
        x += cell->width;
    }
}

void annotated_picture_instruments(struct annotated_picture *picture, struct image *image,
                                   const struct annotated_picture_source *source)
{
    small_map(picture, image, source);
    if (source->slot == SLOT_NONE)
        return;
    struct statistics s;
    statistics_of(&s, source->frame_view, source->slot);
    statistics_bar(picture, image, &s, source->fps);
}
