/* Labels of the map: scale, grid numbers, north arrow, names, the legend, and the panel's figures.
 */
#ifndef JOLON_RENDERER_CHART_LEGEND_H
#define JOLON_RENDERER_CHART_LEGEND_H

#include "renderer/chart/annotated_picture.h"

/* Draws the grid with its numbers, scale bar, north arrow and names. Each label takes a free box in
 * the space, where it covers the fewest vehicles. */
void legend_marks(struct annotated_picture *picture, struct image *image,
                  const struct map_view *view, const struct annotated_picture_source *source,
                  struct label_space *space);

/* Draws as many entries of the legend as fit into the box, the most important first. kinds: with
 * the kinds of vehicles. */
void legend_symbols(struct annotated_picture *picture, struct image *image, struct box box,
                    bool kinds);

/* Returns the corner of the view with the fewest vehicles, for a legend on the map itself. */
struct box legend_corner(struct annotated_picture *picture, const struct map_view *view,
                         const struct annotated_picture_source *source);

/* Draws figures of the followed vehicle and of the world, as many as fit. */
void legend_figures(struct annotated_picture *picture, struct image *image, struct box box,
                    const struct annotated_picture_source *source);

#endif
