/* The ground of maps, for who draws the rest of a map himself: shaded, with contours and roads, and
 * nothing that moves. One thread at a time, whichever. */
#ifndef JOLON_RENDERER_BASE_MAP_SERVICE_H
#define JOLON_RENDERER_BASE_MAP_SERVICE_H

#include "renderer/chart/base_map.h"
#include "renderer/output/stream.h"

struct base_map_service {
    struct base_map base;
};

void base_map_service_open(struct base_map_service *service, const struct world *world);
void base_map_service_close(struct base_map_service *service);

/* Paints maps with it, which must outlive that. The picture's pixels are those of the world's
 * raster at its scale, so its middle is up to half a pixel off; panning paints what comes into
 * view. */
struct stream_painter base_map_service_painter(struct base_map_service *service);

#endif
