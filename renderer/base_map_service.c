/* Maps on demand. */
#include "renderer/base_map_service.h"

#include "renderer/chart/map.h"

void base_map_service_open(struct base_map_service *service, const struct world *world)
{
    base_map_open(&service->base, world);
}

void base_map_service_close(struct base_map_service *service)
{
    base_map_close(&service->base);
}

static int paint(void *self, const struct query_map *map, struct image *image)
{
    struct base_map_service *service = self;
    struct map_view view =
        map_around(map->x, map->z, map->metres / map->width, 0, 0, image->width, image->height);
    map_align(&view);
    return base_map_draw(&service->base, image, &view);
}

struct stream_painter base_map_service_painter(struct base_map_service *service)
{
    return (struct stream_painter){.self = service, .paint = paint};
}
