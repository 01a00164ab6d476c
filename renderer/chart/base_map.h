/* The base map: shaded ground with contours and roads. It never changes, so painted pixels are
 * kept: a map that follows a vehicle paints only the strips that come into view. Pure.
 *
 * The world is a raster of pixels that begins at its north-west corner. Painted pixels lie in a
 * ring buffer of two dimensions: a raster pixel is found there at its coordinates modulo the
 * buffer's size. */
#ifndef JOLON_RENDERER_CHART_BASE_MAP_H
#define JOLON_RENDERER_CHART_BASE_MAP_H

#include "renderer/chart/map.h"
#include "renderer/image/image.h"
#include "world/road_index.h"

#include <stdint.h>

/* A rectangle of the raster [pixel]; x1 and y1 are exclusive. */
struct base_map_part {
    int64_t x0, y0, x1, y1;
};

struct base_map {
    const struct world *world; /* borrowed */
    struct image ring;
    double metres;             /* [m] a pixel; 0: nothing is painted yet */
    struct base_map_part held; /* the painted part in the ring */
    uint64_t painted;          /* [pixel] painted since it was opened */
    struct road_index roads;   /* made when a scale first needs it; owned */
    bool has_roads;
};

void base_map_open(struct base_map *base, const struct world *world);
void base_map_close(struct base_map *base);

/* Copies the base map into the view's rectangle, which must lie in the image, and paints what is
 * missing. The view must be aligned (map_align). A change of scale paints everything anew. Returns
 * 0, or -1 with errno ENOMEM. */
int base_map_draw(struct base_map *base, struct image *image, const struct map_view *view);

/* Returns the height between two contours [m] on a map of so many metres a pixel. */
double base_map_contour_m(double metres);

#endif
