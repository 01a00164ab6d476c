/* Base maps for clients of the stream that draw vehicles themselves, such as the console's page. */
#ifndef JOLON_RENDERER_BASE_MAP_SERVICE_H
#define JOLON_RENDERER_BASE_MAP_SERVICE_H

#include "renderer/chart/base_map.h"
#include "renderer/output/stream.h"

/* Returns a painter that draws with the base map, which must outlive it. Only one thread may paint
 * at a time. A map's pixels are aligned to the world's raster (map_align), so its centre is up to
 * half a pixel off. */
struct stream_painter base_map_service_painter(struct base_map *base);

#endif
