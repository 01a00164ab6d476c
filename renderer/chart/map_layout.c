/* The layout: all measures follow from the font size. */
#include "renderer/chart/map_layout.h"

#define PICTURE_LETTERS 48 /* font sizes in the shorter side of a picture */
#define PANEL_LEAST     9  /* font sizes: no narrower panel is made */
#define CLOSE_UP_LEAST  14 /* font sizes: no narrower close-up is made */
#define SIDE_BY_SIDE    36 /* font sizes: from this width on the close-up is beside the figures */
#define FIGURE_WIDTH    13 /* font sizes */
#define SYMBOL_WIDTH    8  /* font sizes */
#define RULE            2  /* [pixel] between the maps */
#define CLOSE_UP_MOST   65 /* [%] greatest share of a panel's height */
#define CLOSE_UP_ENOUGH 42 /* [%] least share */

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static uint32_t font_size_of(uint32_t width, uint32_t height)
{
    uint32_t font_size = (width < height ? width : height) / PICTURE_LETTERS;
    return font_size < MAP_LAYOUT_FONT_MIN ? MAP_LAYOUT_FONT_MIN : font_size;
}

static int32_t rows_for(int32_t count, int32_t width, int32_t each)
{
    int32_t columns = width / each > 1 ? width / each : 1;
    return (count + columns - 1) / columns;
}

static int32_t legend_height(int32_t em, int32_t width)
{
    return rows_for(MAP_LAYOUT_SYMBOLS, width - 2 * em, SYMBOL_WIDTH * em) * em * 7 / 5 + em;
}

static int32_t figures_height(int32_t em, int32_t width)
{
    return rows_for(MAP_LAYOUT_FIGURES, width - 2 * em, FIGURE_WIDTH * em) * em * 27 / 20 + em * 3;
}

/* Puts the figures above the legend. If they do not fit, both are made lower. */
static void stack_texts(struct map_layout *layout, struct box box)
{
    int32_t em = (int32_t)layout->font_size, legend = legend_height(em, box.width);
    if (figures_height(em, box.width) + legend > box.height)
        legend = least(legend, box.height * 9 / 20);
    layout->figures = (struct box){box.left, box.top, box.width, box.height - legend};
    layout->legend = (struct box){box.left, box.top + box.height - legend, box.width, legend};
}

/* Puts the close-up above figures and legend, in the height that they leave, within limits. */
static void stack_panel(struct map_layout *layout, struct box panel)
{
    int32_t em = (int32_t)layout->font_size;
    int32_t height =
        panel.height - figures_height(em, panel.width) - legend_height(em, panel.width);
    height = least(height, panel.height * CLOSE_UP_MOST / 100);
    if (height < panel.height * CLOSE_UP_ENOUGH / 100)
        height = panel.height * CLOSE_UP_ENOUGH / 100;
    if (panel.width >= CLOSE_UP_LEAST * em && height >= CLOSE_UP_LEAST * em / 2) {
        layout->close_up = (struct box){panel.left, panel.top, panel.width, height};
        panel.top += height;
        panel.height -= height;
    }
    stack_texts(layout, panel);
}

void map_layout_init(struct map_layout *layout, uint32_t width, uint32_t height)
{
    int32_t w = (int32_t)width, h = (int32_t)height, side = least(w, h);
    int32_t em = (int32_t)font_size_of(width, height);
    *layout = (struct map_layout){.font_size = (uint32_t)em, .whole = {0, 0, side, side}};
    if (w - side - RULE >= PANEL_LEAST * em) {
        stack_panel(layout, (struct box){side + RULE, 0, w - side - RULE, h});
    } else if (h - side - RULE >= PANEL_LEAST * em) {
        struct box panel = {0, side + RULE, w, h - side - RULE};
        if (w < SIDE_BY_SIDE * em) {
            stack_panel(layout, panel);
            return;
        }
        layout->close_up = (struct box){0, panel.top, w / 2, panel.height};
        stack_texts(layout, (struct box){w / 2, panel.top, w - w / 2, panel.height});
    } else {
        layout->whole.left = (w - side) / 2;
        layout->whole.top = (h - side) / 2;
    }
}

bool box_within(struct box box, struct box bounds)
{
    return box.left >= bounds.left && box.top >= bounds.top &&
           box.left + box.width <= bounds.left + bounds.width &&
           box.top + box.height <= bounds.top + bounds.height;
}

bool box_overlap(struct box a, struct box b)
{
    return a.left < b.left + b.width && b.left < a.left + a.width && a.top < b.top + b.height &&
           b.top < a.top + a.height;
}

bool label_space_free(const struct label_space *space, struct box box)
{
    if (!box_within(box, space->bounds))
        return false;
    for (uint32_t i = 0; i < space->count; i++)
        if (box_overlap(space->boxes[i], box))
            return false;
    return true;
}

bool label_space_take(struct label_space *space, struct box box)
{
    if (space->count == LABEL_SPACE_MAX || !label_space_free(space, box))
        return false;
    space->boxes[space->count++] = box;
    return true;
}
