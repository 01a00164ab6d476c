/* Words on the map: scale, grid numbers, north, names, the legend, and the panel's figures. */
#ifndef JOLON_RENDERER_CHART_LEGEND_H
#define JOLON_RENDERER_CHART_LEGEND_H

#include "renderer/chart/annotated_picture.h"

/* Grid, numbers, scale bar, north arrow and names, each where it covers the fewest vehicles and
 * none of what is taken. */
void legend_marks(struct annotated_picture *picture, struct image *image,
                  const struct map_view *view, const struct annotated_picture_source *source,
                  struct label_space *space);

/* The legend in its box: as many rows as fit, the most important first; with kinds or without. */
void legend_symbols(struct annotated_picture *picture, struct image *image, struct box box,
                    bool kinds);

/* A corner of the view for a legend without a panel: that with the fewest vehicles. */
struct box legend_corner(struct annotated_picture *picture, const struct map_view *view,
                         const struct annotated_picture_source *source);

/* The followed vehicle and the world in figures, as many as fit. */
void legend_figures(struct annotated_picture *picture, struct image *image, struct box box,
                    const struct annotated_picture_source *source);

#endif
