/* The layout of a map's picture, at any size and aspect. Pure.
 *
 * The map of the whole world is as large as possible. The panel beside or below it has the figures,
 * the legend and, if it is large enough, the close-up. A picture that is nearly square has no
 * panel: its legend is drawn on the map. */
#ifndef JOLON_RENDERER_CHART_MAP_LAYOUT_H
#define JOLON_RENDERER_CHART_MAP_LAYOUT_H

#include <stdbool.h>
#include <stdint.h>

#define MAP_LAYOUT_FONT_MIN 9u /* [pixel] a smaller font cannot be read */
#define MAP_LAYOUT_FIGURES  13 /* that a large panel has room for */
#define MAP_LAYOUT_SYMBOLS  15 /* entries of a large panel's legend */

struct box {
    int32_t left, top, width, height; /* [pixel] width 0: there is none */
};

struct map_layout {
    uint32_t font_size; /* [pixel] of ordinary labels */
    struct box whole, close_up, figures, legend;
};

void map_layout_init(struct map_layout *layout, uint32_t width, uint32_t height);

bool box_within(struct box box, struct box bounds);
bool box_overlap(struct box a, struct box b);

/* --- space for labels ------------------------------------------------------------------------- */

#define LABEL_SPACE_MAX 64u

/* The boxes of a map that labels and marks have taken, so that none overlap. */
struct label_space {
    struct box bounds;
    struct box boxes[LABEL_SPACE_MAX];
    uint32_t count;
};

/* Returns true if the box is within the bounds and overlaps no box that is taken. */
bool label_space_free(const struct label_space *space, struct box box);

/* Takes the box if it is free. Returns true if it was. */
bool label_space_take(struct label_space *space, struct box box);

#endif
