/* The instruments over a camera's picture. */
#ifndef JOLON_RENDERER_CHART_INSTRUMENTS_H
#define JOLON_RENDERER_CHART_INSTRUMENTS_H

#include "renderer/chart/annotated_picture.h"

/* Draws the statistics bar at the foot and a small map in the corner of a camera's picture. Without
 * memory for the small map it is left out. */
void annotated_picture_instruments(struct annotated_picture *picture, struct image *image,
                                   const struct annotated_picture_source *source);

#endif
