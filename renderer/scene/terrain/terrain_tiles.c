/* The cache of ground tiles. */
#include "renderer/scene/terrain/terrain_tiles.h"

#include "renderer/scene/frame/light.h"
#include "renderer/scene/terrain/terrain_colour.h"
#include "world/world.h"

#include <stdlib.h>

#define BUCKETS 1024u

/* most levels from a patch up to its stand-in, whose texels are then eight times as wide */
#define COARSER 3

_Static_assert(TILE_TEXTURE_BYTES == 4 * (((size_t)1 << 2 * TILE_MIPS) - 1) / 3,
               "all mips, no more");
_Static_assert(TILE_CAPACITY > TERRAIN_QUADTREE_PATCHES_MAX,
               "the patches of a picture are kept together");

int terrain_tiles_init(struct terrain_tiles *tiles)
{
    *tiles = (struct terrain_tiles){.view_count = 0};
    tiles->tiles = calloc(TILE_CAPACITY, sizeof *tiles->tiles);
    tiles->buckets = calloc(BUCKETS, sizeof *tiles->buckets);
    tiles->views = calloc(TERRAIN_QUADTREE_PATCHES_MAX, sizeof *tiles->views);
    tiles->vertices = malloc(TILE_CAPACITY * GROUND_VERTICES_MAX * sizeof *tiles->vertices);
    tiles->triangles = malloc(TILE_CAPACITY * GROUND_TRIANGLES_MAX * sizeof *tiles->triangles);
    tiles->textures = malloc((size_t)TILE_CAPACITY * TILE_TEXTURE_BYTES);
    tiles->light = malloc((size_t)TILE_TEXELS * TILE_TEXELS * sizeof *tiles->light);
    if (tiles->tiles == NULL || tiles->buckets == NULL || tiles->views == NULL ||
        tiles->vertices == NULL || tiles->triangles == NULL || tiles->textures == NULL ||
        tiles->light == NULL) {
        terrain_tiles_free(tiles);
        return -1;
    }
    for (size_t i = 0; i < TILE_CAPACITY; i++) {
        tiles->tiles[i].mesh.vertices = tiles->vertices + i * GROUND_VERTICES_MAX;
        tiles->tiles[i].mesh.triangles = tiles->triangles + i * GROUND_TRIANGLES_MAX;
        tiles->tiles[i].texture = tiles->textures + i * TILE_TEXTURE_BYTES;
    }
    return 0;
}

void terrain_tiles_free(struct terrain_tiles *tiles)
{
    free(tiles->tiles);
    free(tiles->buckets);
    free(tiles->views);
    free(tiles->vertices);
    free(tiles->triangles);
    free(tiles->textures);
    free(tiles->light);
    *tiles = (struct terrain_tiles){.view_count = 0};
}

/* --- finding ---------------------------------------------------------------------------------- */

static uint32_t *bucket_of(const struct terrain_tiles *tiles, const struct tile_key *key)
{
    uint32_t hash = (uint32_t)key->column * 0x8da6b343u ^ (uint32_t)key->row * 0xd8163841u ^
                    (uint32_t)key->level * 0xcb1ab31fu;
    return &tiles->buckets[(hash ^ hash >> 13) % BUCKETS];
}

static struct tile *find(const struct terrain_tiles *tiles, const struct tile_key *key)
{
    for (uint32_t at = *bucket_of(tiles, key); at != 0; at = tiles->tiles[at - 1].next) {
        struct tile *tile = &tiles->tiles[at - 1];
        if (tile->key.column == key->column && tile->key.row == key->row &&
            tile->key.level == key->level)
            return tile;
    }
    return NULL;
}

static void unlink_tile(struct terrain_tiles *tiles, const struct tile *tile)
{
    uint32_t *link = bucket_of(tiles, &tile->key);
    while (*link != terrain_tiles_index(tiles, tile) + 1)
        link = &tiles->tiles[*link - 1].next;
    *link = tile->next;
}

/* Replaces the tile that was unused longest. Returns NULL if the current update uses all. */
static struct tile *claim(struct terrain_tiles *tiles, const struct tile_key *key)
{
    struct tile *oldest = &tiles->tiles[0];
    for (uint32_t i = 1; i < TILE_CAPACITY && oldest->used != 0; i++)
        if (tiles->tiles[i].used < oldest->used)
            oldest = &tiles->tiles[i];
    if (oldest->used == tiles->updates)
        return NULL;
    if (oldest->used != 0)
        unlink_tile(tiles, oldest);
    uint32_t *bucket = bucket_of(tiles, key);
    *oldest = (struct tile){
        .key = *key, .next = *bucket, .mesh = oldest->mesh, .texture = oldest->texture};
    *bucket = terrain_tiles_index(tiles, oldest) + 1;
    return oldest;
}

static struct tile *want(struct terrain_tiles *tiles, const struct tile_key *key)
{
    struct tile *tile = find(tiles, key);
    if (tile == NULL)
        tile = claim(tiles, key);
    if (tile != NULL)
        tile->used = tiles->updates;
    return tile;
}

/* --- making ----------------------------------------------------------------------------------- */

/* Returns true if one of the craters from number `from` on reaches into the tile. */
static bool dug_since(const struct tile *tile, const struct crater_index *craters, uint32_t from,
                      double radii)
{
    double side = terrain_quadtree_patch_side(tile->key.level);
    double x0 = tile->key.column * side, z0 = tile->key.row * side;
    if (from > craters->count)
        return true; /* craters that it shows are gone */
    for (uint32_t i = from; i < craters->count; i++) {
        const struct crater *crater = &craters->craters[i];
        double reach = radii * (double)crater->radius_m;
        if (crater->x + reach > x0 && crater->x - reach < x0 + side && crater->z + reach > z0 &&
            crater->z - reach < z0 + side)
            return true;
    }
    return false;
}

static void make_mesh(struct terrain_tiles *tiles, struct tile *tile,
                      const struct frame_view *frame_view)
{
    const struct terrain_quadtree_patch patch = {
        .column = tile->key.column, .row = tile->key.row, .level = tile->key.level};
    terrain_mesh(&frame_view->world->terrain, frame_view->craters, &patch, &tile->mesh);
    tile->low = tile->high = tile->mesh.vertices[0][1];
    for (uint32_t i = 1; i < tile->mesh.top_vertices; i++) {
        float y = tile->mesh.vertices[i][1];
        tile->low = y < tile->low ? y : tile->low;
        tile->high = y > tile->high ? y : tile->high;
    }
    tile->mesh_version = ++tiles->versions;
}

/* Makes the mesh, or makes it again after a new crater. */
static void update_mesh(struct terrain_tiles *tiles, struct tile *tile,
                        const struct frame_view *frame_view)
{
    if (tile->mesh_version == 0 ||
        (tile->mesh_craters != frame_view->craters->count &&
         tile->key.level >= TERRAIN_QUADTREE_DIG_LEVEL &&
         dug_since(tile, frame_view->craters, tile->mesh_craters, CRATER_RIM)))
        make_mesh(tiles, tile, frame_view);
    tile->mesh_craters = frame_view->craters->count;
}

/* Each texel of a mip is the mean of four of the larger mip. */
static void fill_mips(uint8_t *texture)
{
    for (uint32_t mip = 1; mip < TILE_MIPS; mip++) {
        const uint8_t *from = texture + tile_mip_offset(mip - 1);
        uint8_t *to = texture + tile_mip_offset(mip);
        uint32_t side = tile_mip_side(mip), stride = side * 8;
        for (uint32_t row = 0; row < side; row++, from += stride)
            for (uint32_t column = 0; column < side; column++, from += 8, to += 4)
                for (uint32_t i = 0; i < 4; i++)
                    to[i] = (uint8_t)((from[i] + from[i + 4] + from[i + stride] +
                                       from[i + stride + 4] + 2) /
                                      4);
    }
}

static bool has_water(const uint8_t *rgba)
{
    for (size_t i = 0; i < (size_t)TILE_TEXELS * TILE_TEXELS; i++)
        if (rgba[i * 4 + 3] < TERRAIN_COLOUR_GROUND_ALPHA - 8)
            return true;
    return false;
}

static void make_texture(struct terrain_tiles *tiles, struct tile *tile,
                         const struct frame_view *frame_view)
{
    double side = terrain_quadtree_patch_side(tile->key.level);
    struct terrain_colour_tile request = {
        .x = tile->key.column * side,
        .z = tile->key.row * side,
        .step_m = side / (TILE_TEXELS - 1),
        .columns = TILE_TEXELS,
        .rows = TILE_TEXELS,
        .sun = light_sun(),
        .relief = 1.0,
        .rgba = tile->texture,
        .light = tiles->light,
        .roads = frame_view->roads,
    };
    tile->surf = terrain_colour_ground(frame_view->world, frame_view->craters, &request);
    fill_mips(tile->texture);
    tile->wet = has_water(tile->texture);
    tile->stale = false;
    tile->texture_craters = frame_view->craters->count;
    tile->texture_version = ++tiles->versions;
    tiles->textures_made++;
}

/* Notes whether new craters reach into the texture. */
static void look_at_craters(struct tile *tile, const struct frame_view *frame_view)
{
    if (tile->texture_version == 0 || tile->texture_craters == frame_view->craters->count)
        return;
    if (dug_since(tile, frame_view->craters, tile->texture_craters, TERRAIN_COLOUR_CRATER_REACH))
        tile->stale = true;
    tile->texture_craters = frame_view->craters->count;
}

/* --- updating --------------------------------------------------------------------------------- */

static struct tile_key ancestor(const struct tile_key *key, int32_t up)
{
    /* An arithmetic shift rounds down, so it finds the parent of a negative index too. */
    return (struct tile_key){key->column >> up, key->row >> up, key->level - up};
}

/* Returns the nearest tile with a texture, the tile itself or an ancestor, or NULL. */
static struct tile *nearest_texture(const struct terrain_tiles *tiles, const struct tile_key *key)
{
    for (int32_t up = 0; up <= COARSER && up <= key->level; up++) {
        struct tile_key above = ancestor(key, up);
        struct tile *tile = find(tiles, &above);
        if (tile != NULL && tile->texture_version != 0)
            return tile;
    }
    return NULL;
}

/* Makes a texture for a tile that has nothing to show: of the coarsest possible ancestor, or its
 * own. */
static struct tile *make_stand_in(struct terrain_tiles *tiles, struct tile *own,
                                  const struct frame_view *frame_view)
{
    int32_t up = own->key.level < COARSER ? own->key.level : COARSER;
    struct tile_key key = ancestor(&own->key, up);
    struct tile *tile = want(tiles, &key);
    if (tile == NULL)
        tile = own;
    make_texture(tiles, tile, frame_view);
    return tile;
}

static void make_view(struct terrain_tiles *tiles, struct tile_view *view, struct tile *own,
                      const struct frame_view *frame_view)
{
    struct tile *shown = nearest_texture(tiles, &own->key);
    if (shown == NULL)
        shown = make_stand_in(tiles, own, frame_view);
    look_at_craters(shown, frame_view);
    shown->used = tiles->updates;
    int32_t parts = 1 << (own->key.level - shown->key.level);
    *view = (struct tile_view){
        .tile = own,
        .texture_tile = shown,
        .at_u = (float)(own->key.column & (parts - 1)) / (float)parts,
        .at_v = (float)(own->key.row & (parts - 1)) / (float)parts,
        .share = 1.0f / (float)parts,
    };
}

/* Returns how urgently a view needs its own texture. Views that do not show a new crater yet are
 * most urgent. */
static int32_t need(const struct tile_view *view)
{
    if (view->texture_tile != view->tile)
        return view->tile->key.level - view->texture_tile->key.level;
    return view->texture_tile->stale ? COARSER + 1 : 0;
}

/* The most urgent first, then the nearest. */
static void make_textures(struct terrain_tiles *tiles, const struct frame_view *frame_view,
                          uint32_t budget)
{
    for (int32_t worst = COARSER + 1; worst > 0; worst--)
        for (uint32_t i = 0; i < tiles->view_count; i++) {
            struct tile_view *view = &tiles->views[i];
            if (need(view) != worst)
                continue;
            if (tiles->textures_made >= budget) {
                tiles->waiting++;
                continue;
            }
            struct tile *own = &tiles->tiles[terrain_tiles_index(tiles, view->tile)];
            make_texture(tiles, own, frame_view);
            *view = (struct tile_view){.tile = own, .texture_tile = own, .share = 1.0f};
        }
}

void terrain_tiles_update(struct terrain_tiles *tiles, const struct terrain_quadtree_patch *patches,
                          uint32_t count, const struct frame_view *frame_view, uint32_t budget)
{
    tiles->updates++;
    tiles->view_count = tiles->textures_made = tiles->waiting = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct terrain_quadtree_patch *patch = &patches[i];
        struct tile *own = want(tiles, &(struct tile_key){patch->column, patch->row, patch->level});
        if (own == NULL)
            break; /* cannot happen: there is room for all patches of a picture */
        update_mesh(tiles, own, frame_view);
        /* Without a budget every texture is made at once, and no stand-in is needed. */
        if (budget == TERRAIN_TILES_ALL && own->texture_version == 0)
            make_texture(tiles, own, frame_view);
        tiles->views[tiles->view_count++].tile = own;
    }
    for (uint32_t i = 0; i < tiles->view_count; i++)
        make_view(tiles, &tiles->views[i],
                  &tiles->tiles[terrain_tiles_index(tiles, tiles->views[i].tile)], frame_view);
    make_textures(tiles, frame_view, budget);
}
