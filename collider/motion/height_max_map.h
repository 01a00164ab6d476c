/* The highest ground in each gridsquare: who stays above it needs no look at the ground itself. */
#ifndef JOLON_COLLIDER_MOTION_HEIGHT_MAX_MAP_H
#define JOLON_COLLIDER_MOTION_HEIGHT_MAX_MAP_H

#include "world/terrain/gridsquare.h"
#include "world/terrain/terrain.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#define HEIGHT_MAX_MAP_LEAST_M (-1000.0)
#define HEIGHT_MAX_MAP_STEP_M  0.25

/* Filled as squares are asked for: a world of 50 km would take a collider's start too long. */
struct height_max_map {
    const struct terrain *terrain;
    _Atomic uint16_t
        *top; /* [GRIDSQUARE_COUNT] never below the square's ground without craters
                 [HEIGHT_MAX_MAP_STEP_M above HEIGHT_MAX_MAP_LEAST_M]; 0: not looked at yet */
};

/* 0, or -1 with errno ENOMEM. The terrain stays the caller's. */
int height_max_map_init(struct height_max_map *crest, const struct terrain *terrain);
void height_max_map_free(struct height_max_map *crest);

/* The memory that height_max_map_below will need of a way near (x, z), to be asked for. */
static inline const _Atomic uint16_t *height_max_map_at(const struct height_max_map *crest,
                                                        double x, double z)
{
    return &crest->top[gridsquare_of(x, z)];
}

/* Is a way from p to q surely above the ground and its craters, so that analytic_impact_ground() is
 * false? May be false when it is. Any thread; what it tells does not depend on what was asked
 * before. */
bool height_max_map_below(const struct height_max_map *crest, const struct crater_index *craters,
                          struct vec3 p, struct vec3 q);

#endif
