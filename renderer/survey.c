/* Maps on demand. */
#include "renderer/survey.h"

#include "renderer/chart/map.h"

void survey_open(struct survey *survey, const struct world *world)
{
    base_open(&survey->base, world);
}

void survey_close(struct survey *survey)
{
    base_close(&survey->base);
}

static int paint(void *self, const struct query_map *map, struct image *image)
{
    struct survey *survey = self;
    struct map_view view =
        map_around(map->x, map->z, map->metres / map->width, 0, 0, image->width, image->height);
    map_align(&view);
    return base_draw(&survey->base, image, &view);
}

struct stream_painter survey_painter(struct survey *survey)
{
    return (struct stream_painter){.self = survey, .paint = paint};
}
