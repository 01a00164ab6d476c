/* What the ground's kernels share with soft_ground.c. Private to them. */
#ifndef JOLON_RENDERER_SOFT_SOFT_GROUND_H
#define JOLON_RENDERER_SOFT_SOFT_GROUND_H

#include "renderer/scene/frame/light.h"
#include "renderer/scene/terrain/terrain_tiles.h"
#include "renderer/soft/band_lists.h"
#include "renderer/soft/soft_texture.h"

#include <string.h>

/* A ground pixel's promise: the patch in the lowest bits, then how steeply its depth falls off, in
 * halves of a power of two: from it, how much ground the pixel covers. */
#define SOFT_PATCH_BITS 10
#define SOFT_STEEP_BITS 6
#define SOFT_STEEP_LOW  26 /* the least steepness told is 2^-26 */

_Static_assert(TERRAIN_QUADTREE_PATCHES_MAX <= 1 << SOFT_PATCH_BITS,
               "patches that no pixel can name");

/* What a code says, whatever stands in its higher bits. */
static inline float soft_steepness(uint32_t code)
{
    uint32_t bits = (((code & ((1u << SOFT_STEEP_BITS) - 1)) + 2 * (127 - SOFT_STEEP_LOW)) << 22);
    float steep;
    memcpy(&steep, &bits, sizeof steep);
    return steep;
}

/* A patch's vertices, in whole vectors. */
#define SOFT_SEEN_ROOM ((GROUND_VERTICES_MAX + 64u) / 64u * 64u)

/* Waves are the fine texture, too. */
#define SOFT_RIPPLES_PER_M (5.7f / WAVES_M)
#define SOFT_SWELL_PER_M   (1.7f / WAVES_M)

/* What resolve knows of a patch. */
struct soft_patch {
    const uint8_t *paint; /* RGBA, mip after mip */
    /* A place (x, z) from the eye has the texel at_u + per_m * x, at_v + per_m * z of the largest
     * mip. */
    float at_u, at_v, per_m;
    bool wet, surf;
};

struct soft_ground_triangle {
    struct triangle_edges edges;
    struct triangle_plane depth;
    float least, most; /* depth at its corners: rounding must not lead outside */
    uint32_t promise;
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
    float *seen; /* scratch: x, y, depth of a patch's vertices */
    struct soft_detail detail;
    uint8_t *clouds; /* laid out likewise; owned */
    /* The eye's place in the fine texture and in the waves; the swell's axes are exchanged. */
    float fine_at[2], ripples_at[2], swell_at[2];
};

/* NULL with the reason. */
struct soft_ground *soft_ground_open(const struct static_scene *static_scene,
                                     struct error_text *error);
void soft_ground_close(struct soft_ground *ground);
/* The fine texture, for others too. */
const struct soft_detail *soft_ground_detail(const struct soft_ground *ground);
/* In the drawing thread, before prepare: brings the tiles of the scene's patches. */
void soft_ground_bring(struct soft_ground *ground, const struct soft_frame *frame);
/* Sorts the triangles of the ground into the bands. 0, or -1 with errno ENOMEM. */
int soft_ground_prepare(struct soft_ground *ground, const struct soft_frame *frame);

#endif
