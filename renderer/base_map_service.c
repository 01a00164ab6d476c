/* Painting a map that a client requests. */
#include "renderer/base_map_service.h"

#include "renderer/chart/map.h"

static int paint(void *self, const struct query_map *map, struct image *image)
{
    struct map_view view =
        map_around(map->x, map->z, map->metres / map->width, 0, 0, image->width, image->height);
    map_align(&view);
    return base_map_draw(self, image, &view);
}

struct stream_painter base_map_service_painter(struct base_map *base)
{
    return (struct stream_painter){
        .side_m = base->world->terrain.squares.world_m, .self = base, .paint = paint};
}
