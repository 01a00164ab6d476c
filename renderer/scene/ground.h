/* The ground as patches of falling detail: which to draw for a camera, and their vertices. Pure.
 *
 * Patches form quadtrees over squares of 64 km, of which one begins at the world's corner and eight
 * lie around it; past the world's edges the edge's height goes on to the horizon. 64 km is a power
 * of two of any spacing that posts may have, so a patch's cells are whole parts or multiples of a
 * post's cell, split along the same diagonal (world/terrain.h): from that level on what is drawn is
 * the very ground that vehicles drive on. Skirts hide the seams between levels. */
#ifndef JOLON_RENDERER_GROUND_H
#define JOLON_RENDERER_GROUND_H

#include "renderer/scene/camera.h"
#include "world/terrain.h"

#include <stdint.h>

#define GROUND_ROOT_M      64000.0
#define GROUND_CELLS_MAX   32u /* a side of a patch; a power of two */
#define GROUND_LEVEL_MAX   10  /* patches of 62.5 m */
#define GROUND_DIG_LEVEL   9   /* from here on 32 cells are small enough to show a crater's bowl */
#define GROUND_PATCHES_MAX 640
#define GROUND_SPLIT       2.3           /* a patch nearer than so many of its sides is divided */
#define GROUND_ERROR       (1.0 / 600.0) /* of its side that a patch may be off; a pixel or less */
#define GROUND_RANGE_LEVEL 6             /* height ranges are kept down to this level */

/* Of a patch of so many cells a side: (cells + 1)^2 vertices on the ground, then 4 * (cells + 1) of
 * the skirt. */
#define GROUND_VERTICES(cells)  (((cells) + 1u) * ((cells) + 1u) + 4u * ((cells) + 1u))
#define GROUND_TRIANGLES(cells) (2u * (cells) * (cells) + 8u * (cells))

struct ground_patch {
    int32_t column, row; /* of the level's grid; negative or past its end outside the square */
    int32_t level;       /* 0: 64 km */
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
    return GROUND_ROOT_M / (double)(1 << level);
}

/* The patches that can be seen, each place once, nearest first; how many, at most
 * GROUND_PATCHES_MAX. A patch nearer than GROUND_SPLIT sides is never left whole, but at the
 * deepest level or when there are too many. */
uint32_t ground_select(const struct ground *ground, const struct camera *camera,
                       struct ground_patch patches[GROUND_PATCHES_MAX]);

/* Cells a side that the patch needs: as few as keep within GROUND_ERROR, at most as fine as the
 * posts; where craters show, GROUND_CELLS_MAX. */
uint32_t ground_cells(const struct terrain *terrain, const struct crater_index *craters,
                      const struct ground_patch *patch);

/* x, y, z of its GROUND_VERTICES(cells) vertices: x and z from the patch's north-west corner, y
 * above sea level. */
void ground_vertices(const struct terrain *terrain, const struct crater_index *craters,
                     const struct ground_patch *patch, uint32_t cells, float (*vertices)[3]);

/* Its GROUND_TRIANGLES(cells) triangles, counter-clockwise from above and from outside. */
void ground_triangles(uint32_t cells, uint16_t (*triangles)[3]);

#endif
