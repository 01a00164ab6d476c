/* The cache of ground tiles. */
#include "renderer/scene/terrain/terrain_tiles.h"

#include "renderer/scene/frame/light.h"
#include "renderer/scene/terrain/terrain_colour.h"
#include "world/world.h"

#include <stdlib.h>

#define BUCKETS 1024u

/* A stand-in is at most so many levels above its patch: its texels are eight times as wide. */
#define COARSER 3

_Static_assert(TILE_PAINT_BYTES == 4 * (((size_t)1 << 2 * TILE_MIPS) - 1) / 3, "all mips, no more");
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
    tiles->paint = malloc((size_t)TILE_CAPACITY * TILE_PAINT_BYTES);
    tiles->light = malloc((size_t)TILE_TEXELS * TILE_TEXELS * sizeof *tiles->light);
    if (tiles->tiles == NULL || tiles->buckets == NULL || tiles->views == NULL ||
        tiles->vertices == NULL || tiles->triangles == NULL || tiles->paint == NULL ||
        tiles->light == NULL) {
        terrain_tiles_free(tiles);
        return -1;
    }
    for (size_t i = 0; i < TILE_CAPACITY; i++) {
        tiles->tiles[i].mesh.vertices = tiles->vertices + i * GROUND_VERTICES_MAX;
        tiles->tiles[i].mesh.triangles = tiles->triangles + i * GROUND_TRIANGLES_MAX;
        tiles->tiles[i].paint = tiles->paint + i * TILE_PAINT_BYTES;
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
    free(tiles->paint);
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

/* The place of the tile that was longest unseen, for another; NULL when this update wants all. */
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
    *oldest =
        (struct tile){.key = *key, .next = *bucket, .mesh = oldest->mesh, .paint = oldest->paint};
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

/* Is there one among the craters from number `from` on that reaches into the tile? */
static bool dug_since(const struct tile *tile, const struct crater_index *craters, uint32_t from,
                      double radii)
{
    double side = terrain_quadtree_patch_side(tile->key.level);
    double x0 = tile->key.column * side, z0 = tile->key.row * side;
    if (from > craters->count)
        return true; /* those that it shows are gone */
    for (uint32_t i = from; i < craters->count; i++) {
        const struct crater *crater = &craters->craters[i];
        double reach = radii * (double)crater->radius_m;
        if (crater->x + reach > x0 && crater->x - reach < x0 + side && crater->z + reach > z0 &&
            crater->z - reach < z0 + side)
            return true;
    }
    return false;
}

static void shape(struct terrain_tiles *tiles, struct tile *tile, const struct frame_view *moment)
{
    const struct terrain_quadtree_patch patch = {
        .column = tile->key.column, .row = tile->key.row, .level = tile->key.level};
    terrain_mesh(&moment->world->terrain, moment->craters, &patch, &tile->mesh);
    tile->low = tile->high = tile->mesh.vertices[0][1];
    for (uint32_t i = 1; i < tile->mesh.top_vertices; i++) {
        float y = tile->mesh.vertices[i][1];
        tile->low = y < tile->low ? y : tile->low;
        tile->high = y > tile->high ? y : tile->high;
    }
    tile->shape_version = ++tiles->versions;
}

/* Keeps the shape up with the craters. */
static void update_shape(struct terrain_tiles *tiles, struct tile *tile,
                         const struct frame_view *moment)
{
    if (tile->shape_version == 0 ||
        (tile->shape_craters != moment->craters->count &&
         tile->key.level >= TERRAIN_QUADTREE_DIG_LEVEL &&
         dug_since(tile, moment->craters, tile->shape_craters, CRATER_RIM)))
        shape(tiles, tile, moment);
    tile->shape_craters = moment->craters->count;
}

/* Each mip's texel is the mean of four of the one before. */
static void fill_mips(uint8_t *paint)
{
    for (uint32_t mip = 1; mip < TILE_MIPS; mip++) {
        const uint8_t *from = paint + tile_mip_offset(mip - 1);
        uint8_t *to = paint + tile_mip_offset(mip);
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

static void paint(struct terrain_tiles *tiles, struct tile *tile, const struct frame_view *moment)
{
    double side = terrain_quadtree_patch_side(tile->key.level);
    struct terrain_colour_tile painting = {
        .x = tile->key.column * side,
        .z = tile->key.row * side,
        .step_m = side / (TILE_TEXELS - 1),
        .columns = TILE_TEXELS,
        .rows = TILE_TEXELS,
        .sun = light_sun(),
        .relief = 1.0,
        .rgba = tile->paint,
        .light = tiles->light,
    };
    tile->surf = terrain_colour_ground(moment->world, moment->craters, &painting);
    fill_mips(tile->paint);
    tile->wet = has_water(tile->paint);
    tile->stale = false;
    tile->paint_craters = moment->craters->count;
    tile->paint_version = ++tiles->versions;
    tiles->painted++;
}

/* Notes whether craters have come into the painting. */
static void look_at_craters(struct tile *tile, const struct frame_view *moment)
{
    if (tile->paint_version == 0 || tile->paint_craters == moment->craters->count)
        return;
    if (dug_since(tile, moment->craters, tile->paint_craters, TERRAIN_COLOUR_CRATER_REACH))
        tile->stale = true;
    tile->paint_craters = moment->craters->count;
}

/* --- updating --------------------------------------------------------------------------------- */

static struct tile_key ancestor(const struct tile_key *key, int32_t up)
{
    /* Arithmetic shift rounds down, which is what finds the parent of a negative index. */
    return (struct tile_key){key->column >> up, key->row >> up, key->level - up};
}

/* The nearest tile with a painting that will do, its own or an ancestor's; NULL: none. */
static struct tile *nearest_painting(const struct terrain_tiles *tiles, const struct tile_key *key)
{
    for (int32_t up = 0; up <= COARSER && up <= key->level; up++) {
        struct tile_key above = ancestor(key, up);
        struct tile *tile = find(tiles, &above);
        if (tile != NULL && tile->paint_version != 0)
            return tile;
    }
    return NULL;
}

/* Paints it something to show: the coarsest stand-in that will do, or its own. */
static struct tile *paint_stand_in(struct terrain_tiles *tiles, struct tile *own,
                                   const struct frame_view *moment)
{
    int32_t up = own->key.level < COARSER ? own->key.level : COARSER;
    struct tile_key key = ancestor(&own->key, up);
    struct tile *tile = want(tiles, &key);
    if (tile == NULL)
        tile = own;
    paint(tiles, tile, moment);
    return tile;
}

static void make_view(struct terrain_tiles *tiles, struct tile_view *view, struct tile *own,
                      const struct frame_view *moment)
{
    struct tile *shown = nearest_painting(tiles, &own->key);
    if (shown == NULL)
        shown = paint_stand_in(tiles, own, moment);
    look_at_craters(shown, moment);
    shown->used = tiles->updates;
    int32_t parts = 1 << (own->key.level - shown->key.level);
    *view = (struct tile_view){
        .shape = own,
        .paint = shown,
        .at_u = (float)(own->key.column & (parts - 1)) / (float)parts,
        .at_v = (float)(own->key.row & (parts - 1)) / (float)parts,
        .share = 1.0f / (float)parts,
    };
}

/* How badly a view wants its own painting: the most for one that shows ground before a crater. */
static int32_t need(const struct tile_view *view)
{
    if (view->paint != view->shape)
        return view->shape->key.level - view->paint->key.level;
    return view->paint->stale ? COARSER + 1 : 0;
}

/* The worst first, and of these the nearest. */
static void paint_views(struct terrain_tiles *tiles, const struct frame_view *moment,
                        uint32_t budget)
{
    for (int32_t worst = COARSER + 1; worst > 0; worst--)
        for (uint32_t i = 0; i < tiles->view_count; i++) {
            struct tile_view *view = &tiles->views[i];
            if (need(view) != worst)
                continue;
            if (tiles->painted >= budget) {
                tiles->waiting++;
                continue;
            }
            struct tile *own = &tiles->tiles[terrain_tiles_index(tiles, view->shape)];
            paint(tiles, own, moment);
            *view = (struct tile_view){.shape = own, .paint = own, .share = 1.0f};
        }
}

void terrain_tiles_update(struct terrain_tiles *tiles, const struct terrain_quadtree_patch *patches,
                          uint32_t count, const struct frame_view *moment, uint32_t budget)
{
    tiles->updates++;
    tiles->view_count = tiles->painted = tiles->waiting = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct terrain_quadtree_patch *patch = &patches[i];
        struct tile *own = want(tiles, &(struct tile_key){patch->column, patch->row, patch->level});
        if (own == NULL)
            break; /* never: there is room for all patches of a picture */
        update_shape(tiles, own, moment);
        /* With no bound everything is painted in any case, and needs no stand-in. */
        if (budget == TERRAIN_TILES_ALL && own->paint_version == 0)
            paint(tiles, own, moment);
        tiles->views[tiles->view_count++].shape = own;
    }
    for (uint32_t i = 0; i < tiles->view_count; i++)
        make_view(tiles, &tiles->views[i],
                  &tiles->tiles[terrain_tiles_index(tiles, tiles->views[i].shape)], moment);
    paint_views(tiles, moment, budget);
}
