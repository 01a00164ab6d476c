/* The static side of a scene. */
#include "renderer/scene/draw_list/static_scene.h"

#include "renderer/scene/noise/value_noise.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct choice {
    const char *word; /* in a kind's name */
    uint8_t first, count;
};

/* By name where the name tells; the last line takes the rest. */
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

/* The objects lie in gridsquare order. */
static void find_starts(struct static_scene *scenery)
{
    const struct world *world = scenery->world;
    uint32_t next = 0;
    for (uint32_t square = 0; square < GRIDSQUARE_COUNT; square++) {
        scenery->square_start[square] = next;
        while (next < world->counts.fixed &&
               gridsquare_of(world->fixed[next].x, world->fixed[next].z) <= square)
            next++;
    }
    scenery->square_start[GRIDSQUARE_COUNT] = world->counts.fixed;
}

/* Width of a picture over its height: each fills its square differently. */
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

static void find_plant(struct static_scene *scenery, uint32_t index)
{
    const struct fixed_object *object = &scenery->world->fixed[index];
    struct static_scene_plant *plant = &scenery->plants[index];
    float tone = 0.86f + 0.28f * value_noise_unit((int32_t)index, 1, 9);
    float dry = value_noise_unit((int32_t)index, 2, 9);
    *plant = (struct static_scene_plant){
        .width = object->height_m * breadth(scenery->look[index]) * (0.9f + 0.2f * dry),
        .height = object->height_m,
        .sink = 0.02f * object->height_m,
        .tint = {tone * (0.92f + 0.22f * dry), tone, tone * (1.05f - 0.2f * dry)},
    };
    static_scene_slope(&scenery->world->terrain, object->x, object->z, plant->slope);
}

/* The order in which the plants of a gridsquare are thinned out: by chance, the same always. */
static void find_ranks(struct static_scene *scenery, uint32_t square)
{
    uint32_t first = scenery->square_start[square], end = scenery->square_start[square + 1];
    uint32_t plants = 0;
    for (uint32_t i = first; i < end; i++)
        plants += scenery->look[i] != LOOK_MODEL;
    if (plants <= STATIC_SCENE_LONELY) {
        for (uint32_t i = first; i < end; i++)
            scenery->plants[i].lone = 1.0f;
        return;
    }
    for (uint32_t i = first; i < end; i++) {
        uint32_t before = 0, own = value_noise_hash((int32_t)i, 5, 9);
        for (uint32_t j = first; j < end; j++)
            before += scenery->look[j] != LOOK_MODEL && value_noise_hash((int32_t)j, 5, 9) < own;
        scenery->plants[i].rank =
            before < STATIC_SCENE_LONELY ? 0.0f : ((float)before + 0.5f) / (float)plants;
        scenery->plants[i].lone = (float)STATIC_SCENE_LONELY / (float)plants;
    }
}

static void find_blocks(struct static_scene *scenery)
{
    const struct world *world = scenery->world;
    for (uint32_t i = 0; i < STATIC_SCENE_BLOCKS * STATIC_SCENE_BLOCKS; i++)
        scenery->blocks[i] = (struct static_scene_block){INFINITY, -INFINITY};
    for (uint32_t i = 0; i < world->counts.fixed; i++) {
        if (scenery->look[i] == LOOK_MODEL)
            continue;
        const struct fixed_object *object = &world->fixed[i];
        uint32_t column = (uint32_t)gridsquare_axis(object->x) / STATIC_SCENE_BLOCK;
        uint32_t row = (uint32_t)gridsquare_axis(object->z) / STATIC_SCENE_BLOCK;
        struct static_scene_block *block = &scenery->blocks[row * STATIC_SCENE_BLOCKS + column];
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

int static_scene_init(struct static_scene *scenery, const struct world *world)
{
    *scenery = (struct static_scene){.world = world};
    if (terrain_quadtree_init(&scenery->ground, &world->terrain) != 0)
        return -1;
    scenery->square_start = malloc((GRIDSQUARE_COUNT + 1) * sizeof *scenery->square_start);
    scenery->look = malloc(world->counts.fixed + 1);
    scenery->plants = malloc((world->counts.fixed + 1) * sizeof *scenery->plants);
    scenery->blocks = malloc(STATIC_SCENE_BLOCKS * STATIC_SCENE_BLOCKS * sizeof *scenery->blocks);
    scenery->skeletons = malloc((world->counts.models + 1) * sizeof *scenery->skeletons);
    if (scenery->square_start == NULL || scenery->look == NULL || scenery->plants == NULL ||
        scenery->blocks == NULL || scenery->skeletons == NULL) {
        static_scene_free(scenery);
        return -1;
    }
    find_starts(scenery);
    for (uint32_t i = 0; i < world->counts.fixed; i++) {
        scenery->look[i] = look_of(&world->kinds[world->fixed[i].kind], i);
        find_plant(scenery, i);
    }
    for (uint32_t square = 0; square < GRIDSQUARE_COUNT; square++)
        find_ranks(scenery, square);
    find_blocks(scenery);
    for (uint32_t i = 0; i < world->counts.models; i++)
        if (mesh_skeleton(&scenery->skeletons[i], world, i) != 0) {
            static_scene_free(scenery);
            return -1;
        }
    return 0;
}

void static_scene_free(struct static_scene *scenery)
{
    terrain_quadtree_free(&scenery->ground);
    free(scenery->square_start);
    free(scenery->look);
    free(scenery->plants);
    free(scenery->blocks);
    free(scenery->skeletons);
    *scenery = (struct static_scene){.world = NULL};
}
