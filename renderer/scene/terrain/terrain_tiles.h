/* A cache of ground tiles: the mesh and the texture of each patch. They are made when the patch
 * comes into view and again after a new crater; the tile unused longest is replaced. Both back ends
 * draw these tiles, so both show the same ground.
 *
 * Meshes are cheap and made at once. Textures cost a hundred times more and may be spread over
 * several pictures: until its own is made, a patch shows its part of the nearest ancestor's
 * texture. Without a budget the result depends only on the patches and the frame.
 *
 * One thread at a time may update. Any number may read after terrain_tiles_update(). */
#ifndef JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_TILES_H
#define JOLON_RENDERER_SCENE_TERRAIN_TERRAIN_TILES_H

#include "renderer/scene/terrain/terrain_mesh.h"
#include "renderer/scene/frame/frame_view.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TILE_TEXELS   128u /* side of a texture */
#define TILE_MIPS     8u   /* sides of 128, 64 .. 1 texels */
#define TILE_CAPACITY 768u /* those of a picture, stand-ins, recent ones */

#define TERRAIN_TILES_ALL UINT32_MAX /* no limit to the textures that one picture may make */

/* Bytes of a texture: RGBA of all mips, the largest first. */
#define TILE_TEXTURE_BYTES 87380u

struct tile_key {
    int32_t column, row, level; /* of the patch */
};

struct tile {
    struct tile_key key;
    uint64_t used;                          /* number of the last update that used it; 0: free */
    uint64_t mesh_version, texture_version; /* change with the contents; 0: not made */
    uint32_t mesh_craters, texture_craters; /* number of craters considered */
    uint32_t next;                          /* next of its bucket, + 1 */
    bool wet;                               /* part of the texture is water */
    bool surf;                              /* part of it is sea: foam at its edge */
    bool stale;                             /* there are newer craters than the texture */
    float low, high;                        /* [m, world] of the ground, without the skirt */
    struct terrain_mesh mesh;               /* made by terrain_mesh() */
    uint8_t *texture; /* [TILE_TEXTURE_BYTES] made by terrain_colour_ground() */
};

/* What to draw for a patch. Texture coordinates are 0 in the middle of the first texel and 1 in the
 * middle of the last. A point (x, z) metres from the patch's corner has u = at_u + share * x / side
 * and v = at_v + share * z / side, with the patch's own side. */
struct tile_view {
    const struct tile *tile;         /* its mesh is made */
    const struct tile *texture_tile; /* the tile itself or an ancestor; its texture is made */
    float at_u, at_v, share;
};

struct terrain_tiles {
    struct tile_view *views; /* [view_count] in the order of the patches */
    uint32_t view_count;
    uint32_t textures_made; /* by the last update */
    uint32_t waiting; /* views that show an ancestor's texture, or do not show a new crater yet */
    uint64_t updates, versions;
    struct tile *tiles;       /* [TILE_CAPACITY] */
    uint32_t *buckets;        /* tile + 1 */
    float (*vertices)[3];     /* of all tiles */
    uint16_t (*triangles)[3]; /* of all tiles */
    uint8_t *textures;        /* of all tiles */
    float *light;             /* scratch */
};

/* Returns 0, or -1 with errno ENOMEM. Memory is touched only when tiles are made. */
int terrain_tiles_init(struct terrain_tiles *tiles);
void terrain_tiles_free(struct terrain_tiles *tiles);

/* Makes the views of these patches, given the nearest first. Makes at most `budget` textures, plus
 * those coarse ancestors without which a patch would have nothing to show. */
void terrain_tiles_update(struct terrain_tiles *tiles, const struct terrain_quadtree_patch *patches,
                          uint32_t count, const struct frame_view *frame_view, uint32_t budget);

/* The mip to show depends on the distance, so that nothing jumps when a patch is divided: at that
 * distance the patch shows its largest mip, and its parts show their second one, whose texels are
 * as wide. The length that a pixel covers along the view counts about half, because otherwise
 * ground at a low angle would blur. Wanted width of a texel [m]: */
#define TILE_WANTED                                                                                \
    0.003424f /* times the distance: 1 / (TERRAIN_QUADTREE_SPLIT * (TILE_TEXELS - 1)) */
#define TILE_COVERED 0.55f /* times the length that a pixel covers */

/* Returns the width of a texel of the wanted mip, in texels of the largest mip. */
static inline float tile_texels(float distance_m, float covers_m, float texel_m)
{
    float wanted_m = distance_m * TILE_WANTED, covered_m = covers_m * TILE_COVERED;
    return (wanted_m > covered_m ? wanted_m : covered_m) / texel_m;
}

/* Offset of a mip in a texture, and its side. */
static inline uint32_t tile_mip_side(uint32_t mip)
{
    return TILE_TEXELS >> mip;
}

static inline size_t tile_mip_offset(uint32_t mip)
{
    size_t whole = (size_t)4 * TILE_TEXELS * TILE_TEXELS, rest = whole >> (2 * mip);
    return (whole - rest) * 4 / 3;
}

/* Returns the index of a tile in its cache, for data that a back end keeps for the tile. */
static inline uint32_t terrain_tiles_index(const struct terrain_tiles *tiles,
                                           const struct tile *tile)
{
    return (uint32_t)(tile - tiles->tiles);
}

#endif
