/* Computes the static scene of a world. */
#include "renderer/scene/draw_list/static_scene.h"

#include "renderer/scene/noise/value_noise.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct choice {
    const char *word; /* in the name of a kind */
    uint8_t first, count;
};

/* Pictures by words in the name of the kind. The last row matches every name. */
static const struct choice trees[] = {
    {"pine", PLANT_IMPOSTORS_PINE_A, 2},
    {"fir", PLANT_IMPOSTORS_FIR, 1},
    {"redwood", PLANT_IMPOSTORS_FIR, 1},
    {"cypress", PLANT_IMPOSTORS_FIR, 1},
    {"valley", PLANT_IMPOSTORS_VALLEY_OAK_A, 2},
    {"oak", PLANT_IMPOSTORS_OAK_A, 3},
    {"", PLANT_IMPOSTORS_OAK_A, 5},
};

static uint8_t look_of(const struct kind *kind, uint32_t index)
{
    uint32_t draw = value_noise_hash((int32_t)index, 7, 3);
    if (kind->object_class == OBJECT_BUSH)
        return (uint8_t)(PLANT_IMPOSTORS_BUSH_A + draw % 3);
    if (kind->object_class != OBJECT_TREE)
        return LOOK_MODEL;
    const struct choice *choice = trees;
    while (strstr(kind->name, choice->word) == NULL)
        choice++;
    return (uint8_t)(choice->first + draw % choice->count);
}

/* Finds the first object of each gridsquare. The objects are in gridsquare order. */
static void find_starts(struct static_scene *static_scene)
{
    const struct world *world = static_scene->world;
    uint32_t next = 0;
    for (uint32_t square = 0; square < world->terrain.squares.count; square++) {
        static_scene->square_start[square] = next;
        while (next < world->counts.fixed &&
               gridsquare_of(&world->terrain.squares, world->fixed[next].x, world->fixed[next].z) <=
                   square)
            next++;
    }
    static_scene->square_start[world->terrain.squares.count] = world->counts.fixed;
}

/* Returns the width of a picture over its height: plants fill their squares differently. */
static float breadth(uint8_t look)
{
    switch (look) {
    case PLANT_IMPOSTORS_PINE_A:
    case PLANT_IMPOSTORS_PINE_B:
        return 0.85f;
    case PLANT_IMPOSTORS_FIR:
        return 0.60f;
    case PLANT_IMPOSTORS_BUSH_A:
    case PLANT_IMPOSTORS_BUSH_B:
    case PLANT_IMPOSTORS_BUSH_C:
        return 1.45f;
    case PLANT_IMPOSTORS_OAK_A:
    case PLANT_IMPOSTORS_OAK_B:
    case PLANT_IMPOSTORS_OAK_C:
        return 1.25f;
    default:
        return 1.05f;
    }
}

static void find_plant(struct static_scene *static_scene, uint32_t index)
{
    const struct fixed_object *object = &static_scene->world->fixed[index];
    struct static_scene_plant *plant = &static_scene->plants[index];
    float tone = 0.86f + 0.28f * value_noise_unit((int32_t)index, 1, 9);
    float dry = value_noise_unit((int32_t)index, 2, 9);
    *plant = (struct static_scene_plant){
        .width = object->height_m * breadth(static_scene->look[index]) * (0.9f + 0.2f * dry),
        .height = object->height_m,
        .sink = 0.02f * object->height_m,
        .tint = {tone * (0.92f + 0.22f * dry), tone, tone * (1.05f - 0.2f * dry)},
    };
    static_scene_slope(&static_scene->world->terrain, object->x, object->z, plant->slope);
}

/* Finds the order in which the plants of a gridsquare are thinned out. It is random, but always the
 * same. */
static void find_ranks(struct static_scene *static_scene, uint32_t square)
{
    uint32_t first = static_scene->square_start[square],
             end = static_scene->square_start[square + 1];
    uint32_t plants = 0;
    for (uint32_t i = first; i < end; i++)
        plants += static_scene->look[i] != LOOK_MODEL;
    if (plants <= STATIC_SCENE_KEPT) {
        for (uint32_t i = first; i < end; i++)
            static_scene->plants[i].kept_share = 1.0f;
        return;
    }
    for (uint32_t i = first; i < end; i++) {
        uint32_t before = 0, own = value_noise_hash((int32_t)i, 5, 9);
        for (uint32_t j = first; j < end; j++)
            before +=
                static_scene->look[j] != LOOK_MODEL && value_noise_hash((int32_t)j, 5, 9) < own;
        static_scene->plants[i].rank =
            before < STATIC_SCENE_KEPT ? 0.0f : ((float)before + 0.5f) / (float)plants;
        static_scene->plants[i].kept_share = (float)STATIC_SCENE_KEPT / (float)plants;
    }
}

static void find_blocks(struct static_scene *static_scene)
{
    const struct world *world = static_scene->world;
    const struct gridsquares *squares = &world->terrain.squares;
    for (uint32_t i = 0; i < static_scene->blocks_a_side * static_scene->blocks_a_side; i++)
        static_scene->blocks[i] = (struct static_scene_block){INFINITY, -INFINITY};
    for (uint32_t i = 0; i < world->counts.fixed; i++) {
        if (static_scene->look[i] == LOOK_MODEL)
            continue;
        const struct fixed_object *object = &world->fixed[i];
        uint32_t column = (uint32_t)gridsquare_axis(squares, object->x) / STATIC_SCENE_BLOCK;
        uint32_t row = (uint32_t)gridsquare_axis(squares, object->z) / STATIC_SCENE_BLOCK;
        struct static_scene_block *block =
            &static_scene->blocks[row * static_scene->blocks_a_side + column];
        block->low = fminf(block->low, object->y);
        block->high = fmaxf(block->high, object->y + object->height_m);
    }
}

void static_scene_slope(const struct terrain *terrain, double x, double z, float slope[2])
{
    double here = terrain_base_height(terrain, x, z);
    slope[0] = (float)(terrain_base_height(terrain, x + 2.0, z) - here) * 0.5f;
    slope[1] = (float)(terrain_base_height(terrain, x, z + 2.0) - here) * 0.5f;
}

int static_scene_init(struct static_scene *static_scene, const struct world *world)
{
    *static_scene = (struct static_scene){.world = world};
    if (terrain_quadtree_init(&static_scene->ground, &world->terrain) != 0)
        return -1;
    if (road_index_make(&static_scene->roads, world->road_points, world->counts.road_points,
                        world->terrain.squares.world_m) != 0) {
        static_scene_free(static_scene);
        return -1;
    }
    static_scene->square_start =
        calloc((size_t)world->terrain.squares.count + 1, sizeof *static_scene->square_start);
    static_scene->look = calloc(world->counts.fixed + 1, 1);
    static_scene->plants = calloc(world->counts.fixed + 1, sizeof *static_scene->plants);
    static_scene->blocks_a_side =
        ((uint32_t)world->terrain.squares.per_side + STATIC_SCENE_BLOCK - 1) / STATIC_SCENE_BLOCK;
    static_scene->blocks = calloc((size_t)static_scene->blocks_a_side * static_scene->blocks_a_side,
                                  sizeof *static_scene->blocks);
    static_scene->skeletons = malloc((world->counts.models + 1) * sizeof *static_scene->skeletons);
    if (static_scene->square_start == NULL || static_scene->look == NULL ||
        static_scene->plants == NULL || static_scene->blocks == NULL ||
        static_scene->skeletons == NULL) {
        static_scene_free(static_scene);
        return -1;
    }
    find_starts(static_scene);
    for (uint32_t i = 0; i < world->counts.fixed; i++) {
        static_scene->look[i] = look_of(&world->kinds[world->fixed[i].kind], i);
        find_plant(static_scene, i);
    }
    for (uint32_t square = 0; square < world->terrain.squares.count; square++)
        find_ranks(static_scene, square);
    find_blocks(static_scene);
    for (uint32_t i = 0; i < world->counts.models; i++)
        if (mesh_skeleton(&static_scene->skeletons[i], world, i) != 0) {
            static_scene_free(static_scene);
            return -1;
        }
    return 0;
}

void static_scene_free(struct static_scene *static_scene)
{
    terrain_quadtree_free(&static_scene->ground);
    free(static_scene->square_start);
    free(static_scene->look);
    free(static_scene->plants);
    free(static_scene->blocks);
    free(static_scene->skeletons);
    road_index_free(&static_scene->roads);
    *static_scene = (struct static_scene){.world = NULL};
}
