/* Where the parts of a map picture go, at any size and aspect. Pure.
 *
 * The whole square is as large as fits. What is left beside or below it holds the close-up, the
 * figures and the legend, the close-up only where it is large enough to be worth it; a picture that
 * is nearly square has the legend alone, on the map itself. */
#ifndef JOLON_RENDERER_CHART_MAP_LAYOUT_H
#define JOLON_RENDERER_CHART_MAP_LAYOUT_H

#include <stdbool.h>
#include <stdint.h>

#define MAP_LAYOUT_FONT_MIN 9u /* [pixel] smaller ones cannot be read */
#define MAP_LAYOUT_FIGURES  13 /* that the panel has room for, if it is large */
#define MAP_LAYOUT_SYMBOLS  15 /* in the legend, likewise */

struct box {
    int32_t left, top, width, height; /* [pixel]; width 0: not there */
};

struct map_layout {
    uint32_t font_size; /* [pixel] size of ordinary words */
    struct box whole, close_up, figures, legend;
};

void map_layout_map(struct map_layout *layout, uint32_t width, uint32_t height);

bool box_within(struct box box, struct box bounds);
bool box_overlap(struct box a, struct box b);

/* --- places for words ------------------------------------------------------------------------- */

#define LABEL_SPACE_MAX 64u

/* What of a map is taken by words and marks, so that nothing is written over another. */
struct label_space {
    struct box bounds;
    struct box boxes[LABEL_SPACE_MAX];
    uint32_t count;
};

/* Is the box free and within the bounds? */
bool label_space_free(const struct label_space *space, struct box box);

/* Takes the box if it is free. */
bool label_space_take(struct label_space *space, struct box box);

#endif
