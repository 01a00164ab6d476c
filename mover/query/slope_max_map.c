/* Squares' slopes and water, looked up once each. */
#include "mover/query/slope_max_map.h"

#include <math.h>
#include <stdlib.h>

#define BARRED       UINT8_MAX
#define SQUARES_MOST 9 /* a way over more of them is looked at itself */

int slope_max_map_init(struct slope_max_map *map, const struct terrain *terrain)
{
    map->terrain = terrain;
    map->steps = calloc(GRIDSQUARE_COUNT, sizeof *map->steps);
    return map->steps ? 0 : -1;
}

void slope_max_map_free(struct slope_max_map *map)
{
    free(map->steps);
    *map = (struct slope_max_map){0};
}

/* Square of the steeper of a cell's two triangles' slopes; post is its north-west one. */
static double steepness(const struct terrain *terrain, const float *post)
{
    double nw = (double)post[0], ne = (double)post[1];
    double sw = (double)post[terrain->side], se = (double)post[terrain->side + 1];
    double north = (ne - nw) * (ne - nw) + (se - ne) * (se - ne);
    double south = (se - sw) * (se - sw) + (sw - nw) * (sw - nw);
    return maths_max(north, south) / (terrain->spacing_m * terrain->spacing_m);
}

static uint8_t steps_of(const struct terrain *terrain, int32_t column, int32_t row)
{
    struct terrain_posts across =
        terrain_posts(terrain, GRIDSQUARE_SIDE_M * column, GRIDSQUARE_SIDE_M);
    struct terrain_posts down = terrain_posts(terrain, GRIDSQUARE_SIDE_M * row, GRIDSQUARE_SIDE_M);
    double most = 0.0;
    for (uint32_t z = down.first; z <= down.last; z++) {
        for (uint32_t x = across.first; x <= across.last; x++) {
            size_t post = (size_t)z * terrain->side + x;
            if (cover_is_water((enum cover)terrain->cover[post]))
                return BARRED;
            if (z < down.last && x < across.last)
                most = maths_max(most, steepness(terrain, terrain->posts + post));
        }
    }
    double steps = sqrt(most) / SLOPE_MAX_MAP_STEP + 2.0;
    return steps < (double)BARRED ? (uint8_t)steps : BARRED;
}

static uint8_t steps_at(const struct slope_max_map *map, int32_t column, int32_t row)
{
    _Atomic uint8_t *known = &map->steps[gridsquare_index(column, row)];
    uint8_t steps = atomic_load_explicit(known, memory_order_relaxed);
    if (steps == 0) {
        steps = steps_of(map->terrain, column, row);
        atomic_store_explicit(known, steps, memory_order_relaxed);
    }
    return steps;
}

bool slope_max_map_between(const struct slope_max_map *map, const struct ground_marks *marks,
                           double x0, double z0, double x1, double z1, double slope)
{
    struct gridsquare_box box = gridsquare_box_of(maths_min(x0, x1), maths_min(z0, z1),
                                                  maths_max(x0, x1), maths_max(z0, z1));
    if ((box.x1 - box.x0 + 1) * (box.z1 - box.z0 + 1) > SQUARES_MOST)
        return false;
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            uint8_t steps = steps_at(map, column, row);
            if (steps == BARRED || SLOPE_MAX_MAP_STEP * steps > slope ||
                ground_marks_of(marks, gridsquare_index(column, row)) & GROUND_MARKS_CRATER)
                return false;
        }
    }
    return true;
}
