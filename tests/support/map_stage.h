/* A world full of vehicles as a map sees it, and whether a picture shows them where they are. */
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

/* Level ground with vehicles of all forces and domains all over the square, headings at random. */
void map_stage_open(struct map_stage *stage, uint64_t seed);
void map_stage_close(struct map_stage *stage);

/* Is the force's colour where map_point says that the vehicle is? Within a pixel.
 */
bool map_stage_shows(const struct map_stage *stage, const struct image *image,
                     const struct map_view *view, uint32_t slot);

#endif
