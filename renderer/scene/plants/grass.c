/* Blocks of clumps, in a table by position. */
#include "renderer/scene/plants/grass.h"

#include "renderer/scene/draw_list/draw_list.h"
#include "renderer/scene/draw_list/static_scene.h"
#include "renderer/scene/noise/value_noise.h"
#include "world/road_index.h"
#include "world/world.h"

#include <math.h>
#include <stdlib.h>

#define CELL_M        2.6 /* one clump at most */
#define BLOCK_CELLS   16  /* a side */
#define BLOCK_M       (BLOCK_CELLS * CELL_M)
#define TABLE_SIDE    16u   /* blocks a side; a power of two, more than the range */
#define FADE          0.35f /* share of the range over which clumps thin out */
#define GROWN         8.0f  /* each grows from nothing over 1 / GROWN of that */
#define ROADS_MAX     32u   /* road segments near a block */
#define ROAD_CLEAR_M  6.0   /* no clumps within this of a road's middle */
#define CRATER_MIN    -0.05 /* [m] nothing grows where the ground was dug deeper */
#define CLUMP_REACH_M 2.0f  /* radius of a ball around any clump */

struct grass_clump {
    struct draw_list_plant plant; /* at: relative to the block's centre [m] */
    float until;                  /* 0..1: shown while a smaller share of the clumps is left out */
};

struct block {
    bool made;
    int32_t column, row;
    uint32_t craters; /* number of craters considered */
    uint32_t count;
    struct vec3 middle; /* [m, world] */
    float reach;        /* radius of a ball around the block */
    struct grass_clump clump[BLOCK_CELLS * BLOCK_CELLS];
};

struct grass {
    struct block block[TABLE_SIDE * TABLE_SIDE];
};

struct road_pieces {
    const struct road_point *from[ROADS_MAX];
    uint32_t count;
};

struct grass *grass_new(void)
{
    return calloc(1, sizeof(struct grass));
}

void grass_free(struct grass *grass)
{
    free(grass);
}

/* --- a block ---------------------------------------------------------------------------------- */

static void find_roads(const struct road_index *roads, struct vec3 middle,
                       struct road_pieces *pieces)
{
    const double reach = 0.5 * BLOCK_M + ROAD_CLEAR_M;
    struct road_walk walk = road_index_walk(roads, middle.x - reach, middle.z - reach,
                                            middle.x + reach, middle.z + reach);
    uint32_t stretch;
    pieces->count = 0;
    while (pieces->count < ROADS_MAX && road_walk_next(&walk, &stretch))
        pieces->from[pieces->count++] = &roads->points[stretch];
}

static bool on_road(const struct road_pieces *pieces, double x, double z)
{
    for (uint32_t i = 0; i < pieces->count; i++) {
        const struct road_point *a = pieces->from[i], *b = a + 1;
        double dx = b->x - a->x, dz = b->z - a->z;
        double px = x - a->x, pz = z - a->z, t = maths_nearest_share(px, pz, dx, dz);
        double ox = px - t * dx, oz = pz - t * dz;
        if (ox * ox + oz * oz < ROAD_CLEAR_M * ROAD_CLEAR_M)
            return true;
    }
    return false;
}

/* Returns the share of the cells of a cover that bear a clump. */
static float clump_share(enum cover cover, float luck)
{
    switch (cover) {
    case COVER_GRASS:
    case COVER_ROAD: /* a post near a road; the road itself is kept clear by its line */
        return 0.22f + 0.40f * luck;
    case COVER_CHAPARRAL:
        return 0.75f;
    case COVER_FOREST:
        return 0.55f;
    default:
        return 0.0f;
    }
}

static void choose_look(struct grass_clump *clump, enum cover cover, float luck, int32_t column,
                        int32_t row)
{
    bool woody = cover == COVER_CHAPARRAL || cover == COVER_FOREST;
    bool brush = value_noise_unit(column, row, 25) < (woody ? 0.6f : 0.06f);
    float size = 0.6f + 0.6f * value_noise_unit(column, row, 26);
    float tone = 0.80f + 0.25f * value_noise_unit(column, row, 28);
    float green = brush ? 0.0f : cover == COVER_FOREST ? 0.30f : 0.10f * (1.0f + luck);
    uint32_t which = value_noise_hash(column, row, 27);
    clump->plant = (struct draw_list_plant){
        .width = size * (brush ? 1.5f : 0.9f),
        .height = size * (brush ? 0.85f : 0.50f),
        .picture = (float)(brush ? PLANT_IMPOSTORS_BUSH_A + which % 3
                                 : PLANT_IMPOSTORS_GRASS_A + which % 2),
        .tint = {tone * (1.0f - green), tone, tone * (0.95f - 0.5f * green)},
    };
}

static void add_clump(struct block *block, const struct world *world,
                      const struct crater_index *craters, const struct road_pieces *roads,
                      int32_t column, int32_t row)
{
    double x = (column + (double)value_noise_unit(column, row, 21)) * CELL_M;
    double z = (row + (double)value_noise_unit(column, row, 22)) * CELL_M;
    enum cover cover = terrain_cover(&world->terrain, x, z);
    float luck = value_noise_value(x / 23.0, z / 23.0, 23);
    float draw = value_noise_unit(column, row, 24), share = clump_share(cover, luck);
    if (draw >= share || on_road(roads, x, z) || earthwork_covers(&world->terrain.earthworks, x, z))
        return;
    double dug = craters != NULL ? crater_offset(craters, x, z) : 0.0;
    if (dug < CRATER_MIN)
        return;
    struct grass_clump *clump = &block->clump[block->count++];
    choose_look(clump, cover, luck, column, row);
    clump->until = draw / share;
    clump->plant.at[0] = (float)(x - block->middle.x);
    clump->plant.at[1] =
        (float)(terrain_base_height(&world->terrain, x, z) + dug - block->middle.y);
    clump->plant.at[2] = (float)(z - block->middle.z);
    static_scene_slope(&world->terrain, x, z, clump->plant.slope);
    block->reach = fmaxf(block->reach, fabsf(clump->plant.at[1]));
}

static void make_block(struct block *block, const struct world *world,
                       const struct road_index *roads, const struct crater_index *craters,
                       int32_t column, int32_t row)
{
    struct road_pieces pieces;
    block->made = true;
    block->column = column;
    block->row = row;
    block->craters = craters != NULL ? craters->count : 0;
    block->count = 0;
    block->reach = 0.0f;
    block->middle.x = (column + 0.5) * BLOCK_M;
    block->middle.z = (row + 0.5) * BLOCK_M;
    block->middle.y = terrain_base_height(&world->terrain, block->middle.x, block->middle.z);
    find_roads(roads, block->middle, &pieces);
    for (int32_t r = 0; r < BLOCK_CELLS; r++)
        for (int32_t c = 0; c < BLOCK_CELLS; c++)
            add_clump(block, world, craters, &pieces, column * BLOCK_CELLS + c,
                      row * BLOCK_CELLS + r);
    block->reach += (float)BLOCK_M * 0.75f + CLUMP_REACH_M; /* half a diagonal is 0.71 sides */
}

/* Returns true if a crater has reached into the block since it was made. */
static bool dug_since(struct block *block, const struct crater_index *craters)
{
    uint32_t count = craters != NULL ? craters->count : 0;
    bool anew = count < block->craters; /* the list of another world */
    for (uint32_t i = block->craters; i < count && !anew; i++) {
        const struct crater *crater = &craters->craters[i];
        double near = CRATER_RIM * (double)crater->radius_m + 0.5 * BLOCK_M;
        anew = fabs(crater->x - block->middle.x) < near && fabs(crater->z - block->middle.z) < near;
    }
    block->craters = count;
    return anew;
}

static const struct block *block_at(struct grass *grass, const struct world *world,
                                    const struct road_index *roads,
                                    const struct crater_index *craters, int32_t column, int32_t row)
{
    uint32_t x = (uint32_t)column % TABLE_SIDE, z = (uint32_t)row % TABLE_SIDE;
    struct block *block = &grass->block[z * TABLE_SIDE + x];
    if (!block->made || block->column != column || block->row != row || dug_since(block, craters))
        make_block(block, world, roads, craters, column, row);
    return block;
}

/* --- a picture -------------------------------------------------------------------------------- */

static uint32_t show_block(const struct block *block, const struct draw_list *list, float range_m,
                           struct draw_list_plant *plants, uint32_t room)
{
    float middle[3];
    uint32_t count = 0;
    draw_list_relative(list, block->middle, middle);
    if (!frustum_ball(&list->frustum, middle, block->reach))
        return 0;
    for (uint32_t i = 0; i < block->count && count < room; i++) {
        const struct grass_clump *clump = &block->clump[i];
        const float *off = clump->plant.at;
        float at[3] = {middle[0] + off[0], middle[1] + off[1], middle[2] + off[2]};
        float away = sqrtf(frustum_dot(at, at));
        float thin = fminf(1.0f, (range_m - away) / (FADE * range_m));
        float grown = fminf(1.0f, (thin - clump->until * (1.0f - 1.0f / GROWN)) * GROWN);
        if (grown <= 0.0f || !frustum_ball(&list->frustum, at, CLUMP_REACH_M))
            continue;
        struct draw_list_plant *plant = &plants[count++];
        *plant = clump->plant;
        for (uint32_t axis = 0; axis < 3; axis++)
            plant->at[axis] = at[axis];
        plant->width *= grown;
        plant->height *= grown;
    }
    return count;
}

uint32_t grass_show(struct grass *grass, const struct draw_list *list, const struct world *world,
                    const struct road_index *roads, const struct crater_index *craters,
                    struct draw_list_plant *plants, uint32_t room)
{
    struct vec3 eye = list->camera.eye;
    double range = GRASS_RANGE_M * sqrt((double)list->detail);
    uint32_t count = 0;
    if (eye.y - terrain_base_height(&world->terrain, eye.x, eye.z) > range)
        return 0;
    int32_t first_column = value_noise_floor((eye.x - range) / BLOCK_M);
    int32_t last_column = value_noise_floor((eye.x + range) / BLOCK_M);
    int32_t first_row = value_noise_floor((eye.z - range) / BLOCK_M);
    int32_t last_row = value_noise_floor((eye.z + range) / BLOCK_M);
    for (int32_t row = first_row; row <= last_row; row++)
        for (int32_t column = first_column; column <= last_column; column++)
            count += show_block(block_at(grass, world, roads, craters, column, row), list,
                                (float)range, plants + count, room - count);
    return count;
}
