/* What the areas and rivers of maps make of the ground: cover, level lakes, and plants. Main thread
 * only. */
#ifndef JOLON_SUPERVISOR_GROUND_MAP_COVER_H
#define JOLON_SUPERVISOR_GROUND_MAP_COVER_H

#include "supervisor/ground/features.h"

struct terrain;

/* Makes posts in lakes water at the height of the lowest of them, and posts in woods and scrub
 * forest and chaparral. Posts of water stay water. 0; -1: no memory. */
int map_cover_areas(const struct features *features, const struct post_grid *grid, float *posts,
                    uint8_t *cover);

/* What was made of coastlines. */
struct map_cover_sea {
    uint64_t posts;          /* that are sea */
    uint32_t torn;           /* places along rows and the first column where two coastlines
                              * contradict each other */
    double torn_x, torn_z;   /* [m] the first such place */
    bool coast;              /* a coastline has a place in the square */
    double coast_x, coast_z; /* [m] the first such place */
};

/* Makes what lies on the right of coastlines sea, level at 0 m. Where no line says what a post is,
 * it is what the next one along its row is, or, in a row without coastlines, along the first
 * column. Nothing changes where no coastline crosses a row or the first column. 0; -1: no memory.
 */
int map_cover_coasts(const struct features *features, const struct post_grid *grid, float *posts,
                     uint8_t *cover, struct map_cover_sea *sea);

/* Makes posts in and along rivers water. A river is at least as wide as the posts are apart. 0; -1:
 * no memory. */
int map_cover_rivers(const struct features *features, const struct post_grid *grid, uint8_t *cover);

/* Plants that are to be a ground's objects. */
struct map_cover_plants {
    struct ground_object *object; /* in the order of a ground file */
    uint32_t count;
    uint32_t left_out;     /* for which there was no room */
    double planted_per_ha; /* in woods and scrub, before any were left out */
};

/* Plants trees in woods and bushes in scrub, per_ha a hectare, away from water, roads and
 * buildings, and adds the objects that stand in the maps. At most GROUND_OBJECTS_MAX less the
 * buildings are kept; of planted ones those are left out that a random order puts last. 0; -1: no
 * memory. */
int map_cover_plant(struct map_cover_plants *plants, const struct features *features,
                    const struct post_grid *grid, const struct terrain *terrain,
                    const struct ground_road_point *roads, uint32_t road_points, double per_ha,
                    uint64_t seed);
void map_cover_free(struct map_cover_plants *plants);

#endif
