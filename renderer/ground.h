/* The ground as patches of falling detail: which to draw for a camera, and their vertices. Pure.
 *
 * Patches form quadtrees over the 50 km square and eight more squares around it, in which the
 * edge's height goes on to the horizon. A patch of any level has GROUND_CELLS cells a side, split
 * along the diagonal of world/terrain.h: from the level at which a cell is a post's cell on, what
 * is drawn is the very ground that vehicles drive on. Skirts hide the seams between levels. */
#ifndef JOLON_RENDERER_GROUND_H
#define JOLON_RENDERER_GROUND_H

#include "renderer/camera.h"
#include "world/terrain.h"

#include <stdint.h>

#define GROUND_CELLS       25   /* 50 km / 25 / 2^6 is exactly 31.25 m */
#define GROUND_LEVEL_MAX   10   /* patches of 49 m, cells of 2 m: fine enough for craters */
#define GROUND_DIG_LEVEL   8    /* from here on cells are small enough to show a crater's bowl */
#define GROUND_PATCHES_MAX 640
#define GROUND_SPLIT       2.3  /* a patch nearer than so many of its sides is divided */
#define GROUND_RANGE_LEVEL 6    /* height ranges are kept down to this level */

/* Vertices: (GROUND_CELLS + 1)^2 on the ground, then 4 * (GROUND_CELLS + 1) of the skirt. */
#define GROUND_SIDE      (GROUND_CELLS + 1)
#define GROUND_VERTICES  (GROUND_SIDE * GROUND_SIDE + 4 * GROUND_SIDE)
#define GROUND_TRIANGLES (2 * GROUND_CELLS * GROUND_CELLS + 4 * 2 * GROUND_CELLS)

struct ground_patch {
    int32_t column, row; /* of the level's grid; negative or past its end outside the square */
    int32_t level;       /* 0: 50 km */
    double distance_m;   /* from the eye to its nearest point */
};

/* Lowest and highest ground of every patch down to GROUND_RANGE_LEVEL. */
struct ground_range {
    float low, high;
};

struct ground {
    const struct terrain *terrain;
    struct ground_range *range; /* level after level, rows from the north; owned */
};

/* 0, or -1 with errno ENOMEM. The terrain must outlive it. */
int ground_init(struct ground *ground, const struct terrain *terrain);
void ground_free(struct ground *ground);

static inline double ground_patch_side(int32_t level)
{
    return 50000.0 / (double)(1 << level);
}

/* The patches that can be seen, each place once, nearest first; how many, at most
 * GROUND_PATCHES_MAX. Nearer ground never has coarser cells than farther ground, seen from the
 * patches' nearest points. */
uint32_t ground_select(const struct ground *ground, const struct camera *camera,
                       struct ground_patch patches[GROUND_PATCHES_MAX]);

/* x, y, z of every vertex: x and z from the patch's north-west corner, y above sea level. */
void ground_vertices(const struct terrain *terrain, const struct crater_index *craters,
                     const struct ground_patch *patch, float vertices[GROUND_VERTICES][3]);

/* Three vertices a triangle; the same for every patch. */
void ground_triangles(uint16_t triangles[GROUND_TRIANGLES][3]);

#endif
