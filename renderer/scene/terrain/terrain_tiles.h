/* The ground that is drawn: each patch's mesh and painting, made on the processor when the
 * patch comes into view, made again when a crater comes into it, given up when longest unseen. Both
 * back ends draw from here, so both show the same ground.
 *
 * Shapes are made at once; they are cheap. Paintings cost a hundred times more, and may be spread
 * over pictures: a patch whose own is not made yet shows the part of its nearest made ancestor's
 * that lies over it. With no bound the outcome depends on nothing but the patches and the moment.
 *
 * One thread at a time; reading what terrain_tiles_update() left is free for all. */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_TILES_H
#define JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_TILES_H

#include "renderer/scene/terrain/terrain_mesh.h"
#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TILE_TEXELS   128u /* a side of a painting */
#define TILE_MIPS     8u   /* 128, 64 .. 1 texels a side */
#define TILE_CAPACITY 768u /* tiles kept: all patches of a picture, their stand-ins, and a past */

#define TERRAIN_TILES_ALL UINT32_MAX /* no bound on what one picture may paint */

/* Bytes of a painting: RGBA of all mips, the largest first. */
#define TILE_TEXTURE_BYTES 87380u

struct tile_key {
    int32_t column, row, level; /* of the patch */
};

struct tile {
    struct tile_key key;
    uint64_t used;                          /* the update that last wanted it; 0: free */
    uint64_t mesh_version, texture_version; /* another for other contents; 0: not made */
    uint32_t mesh_craters, texture_craters; /* so many were looked at */
    uint32_t next;                          /* in its bucket, + 1 */
    bool wet;                               /* some of the painting is water */
    bool surf;                              /* of the sea: there is foam at its edge */
    bool stale;                             /* craters came since it was painted */
    float low, high;                        /* [m, world] of its ground, without the skirt */
    struct terrain_mesh mesh;               /* as terrain_mesh() makes it */
    uint8_t *texture; /* [TILE_TEXTURE_BYTES] as terrain_colour_ground() gives them */
};

/* What to draw for a patch. Texture coordinates are 0 in the middle of a painting's first texel and
 * 1 in the middle of its last: a place (x, z) metres from the patch's corner has
 * u = at_u + share * x / side, v = at_v + share * z / side, with the patch's own side. */
struct tile_view {
    const struct tile *tile;         /* its mesh is made */
    const struct tile *texture_tile; /* the same, or an ancestor; its painting is made */
    float at_u, at_v, share;
};

struct terrain_tiles {
    struct tile_view *views; /* [view_count] in the order of the patches */
    uint32_t view_count;
    uint32_t textures_made; /* tiles, by the last update */
    uint32_t waiting;       /* views that show an ancestor, or ground before a crater */
    uint64_t updates, versions;
    struct tile *tiles;       /* [TILE_CAPACITY] */
    uint32_t *buckets;        /* tile + 1 */
    float (*vertices)[3];     /* of all tiles */
    uint16_t (*triangles)[3]; /* of all tiles */
    uint8_t *textures;        /* of all tiles */
    float *light;             /* scratch */
};

/* 0, or -1 with errno ENOMEM. Memory is touched only as tiles are made. */
int terrain_tiles_init(struct terrain_tiles *tiles);
void terrain_tiles_free(struct terrain_tiles *tiles);

/* Makes views of these patches, nearest first. Paints at most so many tiles, and the few coarse
 * ancestors without which a patch would have nothing to show. */
void terrain_tiles_update(struct terrain_tiles *tiles, const struct terrain_quadtree_patch *patches,
                          uint32_t count, const struct frame_view *frame_view, uint32_t budget);

/* Which mip of a painting to show is told by distance, so that nothing jumps when a patch is
 * divided: where that happens a patch shows its largest mip, and the patches that follow it their
 * next one, whose texels are as wide. What a pixel covers along the view counts for about half,
 * or ground at a low angle would blur. Texels so wide [m] are wanted: */
#define TILE_WANTED                                                                                \
    0.003424f              /* of the distance: 1 / (TERRAIN_QUADTREE_SPLIT * (TILE_TEXELS - 1)) */
#define TILE_COVERED 0.55f /* of what a pixel covers */

/* How many of its largest mip's texels one of the wanted mip is wide. */
static inline float tile_texels(float distance_m, float covers_m, float texel_m)
{
    float wanted_m = distance_m * TILE_WANTED, covered_m = covers_m * TILE_COVERED;
    return (wanted_m > covered_m ? wanted_m : covered_m) / texel_m;
}

/* Where a mip begins in a painting, and its side. */
static inline uint32_t tile_mip_side(uint32_t mip)
{
    return TILE_TEXELS >> mip;
}

static inline size_t tile_mip_offset(uint32_t mip)
{
    size_t whole = (size_t)4 * TILE_TEXELS * TILE_TEXELS, rest = whole >> (2 * mip);
    return (whole - rest) * 4 / 3;
}

/* A tile's place in its cache, for what a back end keeps beside it. */
static inline uint32_t terrain_tiles_index(const struct terrain_tiles *tiles,
                                           const struct tile *tile)
{
    return (uint32_t)(tile - tiles->tiles);
}

#endif
