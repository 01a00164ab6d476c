/* The instruments over a camera's picture. */
#ifndef JOLON_RENDERER_CHART_INSTRUMENTS_H
#define JOLON_RENDERER_CHART_INSTRUMENTS_H

#include "renderer/chart/annotated_picture.h"

/* The statistics bar below and a small map in the corner of a camera's picture. A small map that
 * there is no memory for is left out. */
void annotated_picture_instruments(struct annotated_picture *picture, struct image *image,
                                   const struct annotated_picture_source *source);

#endif
