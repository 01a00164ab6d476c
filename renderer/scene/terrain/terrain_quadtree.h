/* The ground as patches of falling detail: which to draw for a camera, and their vertices. Pure.
 *
 * Patches form quadtrees over squares of 64 km, of which one begins at the world's corner and eight
 * lie around it; past the world's edges the country goes on to the horizon. 64 km is a power
 * of two of any spacing that posts may have, so a patch's cells are whole parts or multiples of a
 * post's cell, split along the same diagonal (world/terrain/terrain.h): from that level on what is
 * drawn is the very ground that vehicles drive on. Skirts hide the seams between levels. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_QUADTREE_H
#define JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_QUADTREE_H

#include "renderer/scene/camera/camera.h"
#include "world/terrain/terrain.h"

#include <stdint.h>

#define TERRAIN_QUADTREE_ROOT_M      64000.0
#define TERRAIN_QUADTREE_LEVEL_MAX   11 /* patches of 31.25 m */
#define TERRAIN_QUADTREE_DIG_LEVEL   8  /* from here on, 580 m, meshes have craters' bowls */
#define TERRAIN_QUADTREE_PATCHES_MAX 640
#define TERRAIN_QUADTREE_SPLIT       2.3 /* a patch nearer than so many of its sides is divided */
#define TERRAIN_QUADTREE_ERROR                                                                     \
    (1.0 / 800.0)                      /* of its side that a patch may be off; a pixel or less */
#define TERRAIN_QUADTREE_HAZY_LEVEL  4 /* coarser ones, from 18 km on, may be off twice as much */
#define TERRAIN_QUADTREE_SKIRT       0.02 /* of its side that a skirt hangs down */
#define TERRAIN_QUADTREE_SKIRT_MIN_M 1.5
#define TERRAIN_QUADTREE_RANGE_LEVEL 6 /* height ranges are kept down to this level */

struct terrain_quadtree_patch {
    int32_t column, row; /* of the level's grid; negative or past its end outside the square */
    int32_t level;       /* 0: 64 km */
    double distance_m;   /* from the eye to its nearest point */
};

/* Lowest and highest ground of every patch down to TERRAIN_QUADTREE_RANGE_LEVEL. */
struct terrain_quadtree_range {
    float low, high;
};

struct terrain_quadtree {
    const struct terrain *terrain;
    struct terrain_quadtree_range *range; /* level after level, rows from the north; owned */
};

/* 0, or -1 with errno ENOMEM. The terrain must outlive it. */
int terrain_quadtree_init(struct terrain_quadtree *ground, const struct terrain *terrain);
void terrain_quadtree_free(struct terrain_quadtree *ground);

static inline double terrain_quadtree_patch_side(int32_t level)
{
    return TERRAIN_QUADTREE_ROOT_M / (double)(1 << level);
}

/* How far a patch of a level may be off the ground [m], that is without craters where it shows
 * none. */
static inline double terrain_quadtree_tolerance(int32_t level)
{
    double error =
        level < TERRAIN_QUADTREE_HAZY_LEVEL ? 2.0 * TERRAIN_QUADTREE_ERROR : TERRAIN_QUADTREE_ERROR;
    return error * terrain_quadtree_patch_side(level);
}

/* How far the skirts hang below the edges of a patch [m]: further than neighbours are apart. */
static inline double terrain_quadtree_skirt(int32_t level)
{
    return maths_max(TERRAIN_QUADTREE_SKIRT_MIN_M,
                     TERRAIN_QUADTREE_SKIRT * terrain_quadtree_patch_side(level));
}

/* The place within the square whose ground is drawn at a place outside: the nearest of the edge,
 * aside by more the further out, so that the country goes on in hills and not in furrows. Places
 * inside stay as they are. */
void terrain_quadtree_beyond(const struct terrain *terrain, double *x, double *z);

/* The patches that can be seen, each place once, nearest first; how many, at most
 * TERRAIN_QUADTREE_PATCHES_MAX. A patch nearer than TERRAIN_QUADTREE_SPLIT sides is never left
 * whole, but at the deepest level or when there are too many. */
uint32_t
terrain_quadtree_select(const struct terrain_quadtree *ground, const struct camera *camera,
                        struct terrain_quadtree_patch patches[TERRAIN_QUADTREE_PATCHES_MAX]);

#endif
