/* Squares' highest posts, looked up once each. */
#include "collider/motion/height_max_map.h"

#include <stdlib.h>

#define SLACK_M      0.01 /* more than rounding moves a way */
#define NEVER        UINT16_MAX
#define SQUARES_MOST 9 /* a way over more of them is looked at itself */

int height_max_map_init(struct height_max_map *crest, const struct terrain *terrain)
{
    crest->terrain = terrain;
    crest->top = calloc(GRIDSQUARE_COUNT, sizeof *crest->top);
    return crest->top ? 0 : -1;
}

void height_max_map_free(struct height_max_map *crest)
{
    free(crest->top);
    *crest = (struct height_max_map){0};
}

static double highest(const struct terrain *terrain, int32_t column, int32_t row)
{
    struct terrain_posts across =
        terrain_posts(terrain, GRIDSQUARE_SIDE_M * column, GRIDSQUARE_SIDE_M);
    struct terrain_posts down = terrain_posts(terrain, GRIDSQUARE_SIDE_M * row, GRIDSQUARE_SIDE_M);
    float top = terrain->posts[(size_t)down.first * terrain->side + across.first];
    for (uint32_t z = down.first; z <= down.last; z++) {
        for (uint32_t x = across.first; x <= across.last; x++) {
            float post = terrain->posts[(size_t)z * terrain->side + x];
            top = post > top ? post : top;
        }
    }
    return (double)top + SLACK_M;
}

/* Up to the next step; what lies below them all is at the first, what is above them all nobody is
 * above. */
static uint16_t steps_of(double metres)
{
    double steps = maths_max(0.0, (metres - HEIGHT_MAX_MAP_LEAST_M) / HEIGHT_MAX_MAP_STEP_M) + 1.0;
    return steps < (double)NEVER ? (uint16_t)steps : NEVER;
}

static bool above(const struct height_max_map *crest, double low_m, int32_t column, int32_t row)
{
    _Atomic uint16_t *known = &crest->top[gridsquare_index(column, row)];
    uint16_t top = atomic_load_explicit(known, memory_order_relaxed);
    if (top == 0) {
        top = steps_of(highest(crest->terrain, column, row));
        atomic_store_explicit(known, top, memory_order_relaxed);
    }
    return top < NEVER && low_m > HEIGHT_MAX_MAP_LEAST_M + HEIGHT_MAX_MAP_STEP_M * top;
}

bool height_max_map_below(const struct height_max_map *crest, const struct crater_index *craters,
                          struct vec3 p, struct vec3 q)
{
    struct gridsquare_box box = gridsquare_box_of(maths_min(p.x, q.x), maths_min(p.z, q.z),
                                                  maths_max(p.x, q.x), maths_max(p.z, q.z));
    double low = maths_min(p.y, q.y) - (craters ? craters->rim_m : 0.0);
    if ((box.x1 - box.x0 + 1) * (box.z1 - box.z0 + 1) > SQUARES_MOST)
        return false;
    for (int32_t row = box.z0; row <= box.z1; row++) {
        for (int32_t column = box.x0; column <= box.x1; column++) {
            if (!above(crest, low, column, row))
                return false;
        }
    }
    return true;
}
