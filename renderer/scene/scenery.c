/* The static side of a scene. */
#include "renderer/scene/scenery.h"

#include "renderer/scene/grain.h"
#include "world/square.h"

#include <stdlib.h>
#include <string.h>

struct choice {
    const char *word; /* in a kind's name */
    uint8_t first, count;
};

/* By name where the name tells; the last line takes the rest. */
static const struct choice trees[] = {
    {"pine", FOLIAGE_PINE_A, 2},
    {"fir", FOLIAGE_FIR, 1},
    {"redwood", FOLIAGE_FIR, 1},
    {"cypress", FOLIAGE_FIR, 1},
    {"valley", FOLIAGE_VALLEY_OAK_A, 2},
    {"oak", FOLIAGE_OAK_A, 3},
    {"", FOLIAGE_OAK_A, 5},
};

static uint8_t look_of(const struct kind *kind, uint32_t index)
{
    uint32_t draw = grain_hash((int32_t)index, 7, 3);
    if (kind->object_class == OBJECT_BUSH)
        return (uint8_t)(FOLIAGE_BUSH_A + draw % 3);
    if (kind->object_class != OBJECT_TREE)
        return LOOK_MODEL;
    const struct choice *choice = trees;
    while (strstr(kind->name, choice->word) == NULL)
        choice++;
    return (uint8_t)(choice->first + draw % choice->count);
}

/* The objects lie in gridsquare order. */
static void find_starts(struct scenery *scenery)
{
    const struct world *world = scenery->world;
    uint32_t next = 0;
    for (uint32_t square = 0; square < SQUARE_COUNT; square++) {
        scenery->square_start[square] = next;
        while (next < world->counts.fixed &&
               square_of(world->fixed[next].x, world->fixed[next].z) <= square)
            next++;
    }
    scenery->square_start[SQUARE_COUNT] = world->counts.fixed;
}

int scenery_init(struct scenery *scenery, const struct world *world)
{
    *scenery = (struct scenery){.world = world};
    if (ground_init(&scenery->ground, &world->terrain) != 0)
        return -1;
    scenery->square_start = malloc((SQUARE_COUNT + 1) * sizeof *scenery->square_start);
    scenery->look = malloc(world->counts.fixed + 1);
    scenery->frames = malloc((world->counts.models + 1) * sizeof *scenery->frames);
    if (scenery->square_start == NULL || scenery->look == NULL || scenery->frames == NULL) {
        scenery_free(scenery);
        return -1;
    }
    find_starts(scenery);
    for (uint32_t i = 0; i < world->counts.fixed; i++)
        scenery->look[i] = look_of(&world->kinds[world->fixed[i].kind], i);
    for (uint32_t i = 0; i < world->counts.models; i++)
        mesh_frame(&scenery->frames[i], world, i);
    return 0;
}

void scenery_free(struct scenery *scenery)
{
    ground_free(&scenery->ground);
    free(scenery->square_start);
    free(scenery->look);
    free(scenery->frames);
    *scenery = (struct scenery){.world = NULL};
}
