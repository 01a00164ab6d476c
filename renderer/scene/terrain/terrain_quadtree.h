/* The ground as a quadtree of patches at falling levels of detail: which of them to draw for a
 * camera. Pure.
 *
 * Each quadtree lies over a square of 64 km. The first begins at the world's corner, others follow
 * where a world is larger, and a ring of them lies around, where the ground continues to the
 * horizon. 64 km is the spacing of posts times
 * a power of two, so a patch's cells are fractions or multiples of a post's cell. They are split
 * along the same diagonal (world/terrain/terrain.h). From the level of the posts on, the ground
 * drawn is the ground that vehicles drive on. Skirts hide the seams between levels. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_QUADTREE_H
#define JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_QUADTREE_H

#include "renderer/scene/camera/camera.h"
#include "world/terrain/terrain.h"

#include <stdint.h>

#define TERRAIN_QUADTREE_ROOT_M      64000.0
#define TERRAIN_QUADTREE_LEVEL_MAX   11 /* patches of 31.25 m */
#define TERRAIN_QUADTREE_DIG_LEVEL   8  /* from this level on, 580 m, meshes show craters */
#define TERRAIN_QUADTREE_PATCHES_MAX 640
#define TERRAIN_QUADTREE_SPLIT       2.3 /* a patch nearer than this many of its sides is divided */
#define TERRAIN_QUADTREE_ERROR       (1.0 / 800.0) /* tolerance over the side; a pixel or less */
#define TERRAIN_QUADTREE_HAZY_LEVEL  4             /* coarser levels have twice the tolerance */
#define TERRAIN_QUADTREE_SKIRT       0.02          /* height of a skirt over the side */
#define TERRAIN_QUADTREE_SKIRT_MIN_M 1.5
#define TERRAIN_QUADTREE_RANGE_LEVEL 6 /* height ranges are kept down to this level */

struct terrain_quadtree_patch {
    int32_t column, row; /* in the level's grid; negative or past its end outside the square */
    int32_t level;       /* 0: 64 km */
    double distance_m;   /* from the eye to its nearest point */
};

/* Lowest and highest ground of every patch down to TERRAIN_QUADTREE_RANGE_LEVEL. */
struct terrain_quadtree_range {
    float low, high;
};

struct terrain_quadtree {
    const struct terrain *terrain;
    int32_t roots; /* along an edge of the world */
    /* With one root; else NULL, and ranges are found when they are needed. One level after another,
     * rows from the north; owned */
    struct terrain_quadtree_range *range;
};

/* Returns 0, or -1 with errno ENOMEM. The terrain must outlive the quadtree. */
int terrain_quadtree_init(struct terrain_quadtree *ground, const struct terrain *terrain);
void terrain_quadtree_free(struct terrain_quadtree *ground);

static inline double terrain_quadtree_patch_side(int32_t level)
{
    return TERRAIN_QUADTREE_ROOT_M / (double)(1 << level);
}

/* Returns the tolerance of a level [m]: how far a patch may be off the ground, craters left out
 * where the level does not show them. */
static inline double terrain_quadtree_tolerance(int32_t level)
{
    double error =
        level < TERRAIN_QUADTREE_HAZY_LEVEL ? 2.0 * TERRAIN_QUADTREE_ERROR : TERRAIN_QUADTREE_ERROR;
    return error * terrain_quadtree_patch_side(level);
}

/* Returns the height of the skirts of a level [m], which is more than the gap between
 * neighbours. */
static inline double terrain_quadtree_skirt(int32_t level)
{
    return maths_max(TERRAIN_QUADTREE_SKIRT_MIN_M,
                     TERRAIN_QUADTREE_SKIRT * terrain_quadtree_patch_side(level));
}

/* Maps a place outside the square to the place inside whose ground is drawn there: the nearest at
 * the edge, shifted sideways by more the farther out it is, so that the ground continues as hills
 * and not as furrows. Places inside are not changed. */
void terrain_quadtree_beyond(const struct terrain *terrain, double *x, double *z);

/* Fills in the patches in view, which do not overlap, the nearest first, and returns their number.
 * A patch nearer than TERRAIN_QUADTREE_SPLIT sides is divided, except at the deepest level or if
 * there is no room. */
uint32_t
terrain_quadtree_select(const struct terrain_quadtree *ground, const struct camera *camera,
                        struct terrain_quadtree_patch patches[TERRAIN_QUADTREE_PATCHES_MAX]);

#endif
