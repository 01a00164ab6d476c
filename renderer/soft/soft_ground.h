/* What soft_ground.c and the ground's kernels share. Private to them. */
#ifndef JOLON_RENDERER_SOFT_SOFT_GROUND_H
#define JOLON_RENDERER_SOFT_SOFT_GROUND_H

#include "renderer/scene/frame/light.h"
#include "renderer/scene/terrain/terrain_tiles.h"
#include "renderer/soft/band_lists.h"
#include "renderer/soft/soft_texture.h"

#include <string.h>

/* The code of a ground pixel, from which it is shaded later: the patch in the lowest bits, then the
 * slope of the depth, as its logarithm in halves of a power of two. The slope gives the area of
 * ground that the pixel covers. */
#define SOFT_PATCH_BITS 10
#define SOFT_STEEP_BITS 6
#define SOFT_STEEP_LOW  26 /* the least slope is 2^-26 */

_Static_assert(TERRAIN_QUADTREE_PATCHES_MAX <= 1 << SOFT_PATCH_BITS,
               "patches that no pixel can name");

/* Returns the slope of a code that is shifted right by SOFT_PATCH_BITS; higher bits are ignored. */
static inline float soft_steepness(uint32_t code)
{
    uint32_t bits = (((code & ((1u << SOFT_STEEP_BITS) - 1)) + 2 * (127 - SOFT_STEEP_LOW)) << 22);
    float steep;
    memcpy(&steep, &bits, sizeof steep);
    return steep;
}

/* The number of a patch's vertices, rounded up to whole vectors. */
#define SOFT_PATCH_VERTICES ((GROUND_VERTICES_MAX + 64u) / 64u * 64u)

/* Waves use the detail texture, too. */
#define SOFT_RIPPLES_PER_M (5.7f / WAVES_M)
#define SOFT_SWELL_PER_M   (1.7f / WAVES_M)

/* A patch, for shading. */
struct soft_patch {
    const uint8_t *texture; /* RGBA, all mips, the largest first */
    /* The point (x, z) from the eye has the texel at_u + per_m * x, at_v + per_m * z of the largest
     * mip. */
    float at_u, at_v, per_m;
    bool wet, surf;
};

struct soft_ground_triangle {
    struct triangle_edges edges;
    struct triangle_plane depth;
    float least, most; /* the range of depth at its corners, within which rounding must stay */
    uint32_t code;
};

struct soft_ground {
    const struct static_scene *static_scene;
    struct terrain_tiles tiles;
    struct soft_patch patches[TERRAIN_QUADTREE_PATCHES_MAX];
    struct soft_ground_triangle *list;
    size_t list_room;
    struct band_rows *rows;
    size_t rows_room;
    uint32_t count;
    struct band_lists lists;
    float *projected; /* scratch: x, y, depth of a patch's vertices; owned */
    struct soft_detail detail;
    uint8_t *clouds; /* see soft_clouds_make(); owned */
    /* The eye's position in the detail texture and in the two wave textures [period]; the swell's
     * axes are exchanged. */
    float fine_at[2], ripples_at[2], swell_at[2];
};

/* Returns NULL with the reason on failure. */
struct soft_ground *soft_ground_open(const struct static_scene *static_scene,
                                     struct error_text *error);
void soft_ground_close(struct soft_ground *ground);
/* Returns the detail texture, which the bodies use too. */
const struct soft_detail *soft_ground_detail(const struct soft_ground *ground);
/* Updates the tiles of the picture's patches. The drawing thread calls it before
 * soft_ground_prepare(). */
void soft_ground_update(struct soft_ground *ground, const struct soft_frame *frame);
/* Sorts the ground's triangles into the bands. May run in a thread of its own. Returns 0, or -1
 * with errno ENOMEM. */
int soft_ground_prepare(struct soft_ground *ground, const struct soft_frame *frame);

#endif
