/* The ground: heights and cover at posts of a regular grid, with earthworks on it and craters in
 * it.
 *
 * Between posts the ground is two flat triangles for each cell, split along the diagonal from the
 * north-west to the south-east post; renderers that draw the same triangles draw the same ground.
 * Earthworks add their own height to that (world/terrain/earthwork.h).
 * Post (column, row) lies at x = column * spacing_m, z = row * spacing_m. Outside the square the
 * edge's height continues. Pure; any thread. */
#ifndef JOLON_WORLD_TERRAIN_TERRAIN_H
#define JOLON_WORLD_TERRAIN_TERRAIN_H

#include "world/terrain/crater.h"
#include "world/terrain/earthwork.h"
#include "world/terrain/gridsquare.h"
#include "world/maths/maths.h"

#include <stdbool.h>
#include <stdint.h>

/* The cover of the ground around a post. */
enum cover {
    COVER_GRASS,
    COVER_CHAPARRAL,
    COVER_FOREST,
    COVER_ROCK,
    COVER_SAND,
    COVER_ROAD,
    COVER_SEA,  /* height is the water's: 0 m */
    COVER_LAKE, /* height is the water's */
    COVER_COUNT
};

struct terrain {
    const float *posts;   /* [side * side, m] row by row from the north-west */
    const uint8_t *cover; /* [side * side] enum cover */
    uint32_t side;        /* posts along one edge */
    double spacing_m;
    struct earthworks earthworks;
    struct gridsquares squares; /* how the world is divided; the posts reach from edge to edge */
};

/* Asks the processor for the posts around a point, whose height is asked for soon. */
void terrain_prefetch(const struct terrain *terrain, double x, double z);

/* Height of the uncratered ground [m], with its earthworks. */
double terrain_base_height(const struct terrain *terrain, double x, double z);

/* Returns the same and the slopes of the plane through the point: tangents, upwards to the east and
 * to the south. */
double terrain_base_plane(const struct terrain *terrain, double x, double z, double *east,
                          double *south);

/* Height of the ground with its craters [m]; craters may be NULL. */
double terrain_height(const struct terrain *terrain, const struct crater_index *craters, double x,
                      double z);

/* Returns true if craters or earthworks may reach within a distance of (x, z) [m]. craters may be
 * NULL. */
bool terrain_uneven_near(const struct terrain *terrain, const struct crater_index *craters,
                         double x, double z, double reach_m);

/* Returns by how much craters and earthworks lift a vehicle over the ground under its middle [m],
 * at least 0: see crater_lift(). craters may be NULL. */
double terrain_lift(const struct terrain *terrain, const struct crater_index *craters,
                    const struct crater_footing *footing);

/* Depth of the water of a ford at (x, z) [m], 0 where there is none. Craters do not count. */
double terrain_water_depth(const struct terrain *terrain, double x, double z);

/* The first and last posts along one axis whose cells overlap the given range. */
struct terrain_posts {
    uint32_t first, last;
};
struct terrain_posts terrain_posts(const struct terrain *terrain, double from_m, double metres);

/* Unit normal of the ground with its craters, from heights one metre apart. */
struct vec3 terrain_normal(const struct terrain *terrain, const struct crater_index *craters,
                           double x, double z);

/* Cover at the nearest post. */
enum cover terrain_cover(const struct terrain *terrain, double x, double z);

static inline bool cover_is_water(enum cover cover)
{
    return cover == COVER_SEA || cover == COVER_LAKE;
}

#endif
