/* The base map: shaded ground with contours and roads, under everything that moves. It never
 * changes, so what was painted is kept: a map that follows a vehicle paints the strips that come
 * into view and no more, a map that stands still paints nothing. Pure.
 *
 * The world is a raster of pixels, the first at its north-west corner. What is painted of it lies
 * in a ring buffer in both directions: a raster pixel's place in it is its number modulo the
 * buffer's size. */
#ifndef JOLON_RENDERER_CHART_BASE_MAP_H
#define JOLON_RENDERER_CHART_BASE_MAP_H

#include "renderer/chart/map.h"
#include "renderer/image/image.h"

#include <stdint.h>

/* Pixels of the raster, exclusive at the end. */
struct base_map_part {
    int64_t x0, y0, x1, y1;
};

struct base_map {
    const struct world *world; /* borrowed */
    struct image ring;
    double metres;             /* a pixel; 0: nothing is painted yet */
    struct base_map_part held; /* painted, in the ring */
    uint64_t painted;          /* pixels painted since it was opened */
};

/* Paints nothing yet. */
void base_map_open(struct base_map *base, const struct world *world);
void base_map_close(struct base_map *base);

/* Lays the base map into the view's rectangle, which must lie in the image; the view must be
 * aligned (map_align). A change of scale paints all of it anew. 0, or -1 with errno ENOMEM. */
int base_map_draw(struct base_map *base, struct image *image, const struct map_view *view);

/* Metres of height between two contours on a map of this scale; every fifth is stronger. */
double base_map_contour_m(double metres);

#endif
