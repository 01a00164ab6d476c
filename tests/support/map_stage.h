/* A world with many vehicles as a map shows it, and a test of whether a picture shows them at their
 * positions. */
#ifndef JOLON_TESTS_SUPPORT_MAP_STAGE_H
#define JOLON_TESTS_SUPPORT_MAP_STAGE_H

#include "renderer/chart/map.h"
#include "tests/support/fixture.h"

#define MAP_STAGE_SIDE 7 /* vehicles stand in so many rows and columns, shaken */

struct map_stage {
    struct fixture fixture;
    struct state state;
    struct crater_index craters;
    struct frame_view frame_view;
};

/* Makes level ground with vehicles of all forces and domains at random positions and headings. */
void map_stage_open(struct map_stage *stage, uint64_t seed);
void map_stage_close(struct map_stage *stage);

/* Returns such a stage in memory of its own. The tear-down for cmocka closes and frees it. */
struct map_stage *map_stage_new(uint64_t seed);
int map_stage_teardown(void **context);

/* Returns true if the force's colour is within a pixel of the vehicle's position by map_point(). */
bool map_stage_shows(const struct map_stage *stage, const struct image *image,
                     const struct map_view *view, uint32_t slot);

#endif
