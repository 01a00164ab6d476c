/* What the renderer computes once about the fixed objects of a world: where they are by gridsquare,
 * what each looks like, the index of roads, and the ground's quadtree. Pure. */
#ifndef JOLON_RENDERER_SCENE_DRAW_LIST_STATIC_SCENE_H
#define JOLON_RENDERER_SCENE_DRAW_LIST_STATIC_SCENE_H

#include "renderer/scene/model/plant_impostors.h"
#include "renderer/scene/terrain/terrain_quadtree.h"
#include "renderer/scene/model/mesh.h"
#include "world/road_index.h"
#include "world/terrain/gridsquare.h"

#include <stdint.h>

struct terrain;
struct world;

/* How a fixed object is drawn. */
#define LOOK_MODEL 255u /* drawn by the polygons of its kind; lower: enum plant_impostors */

#define STATIC_SCENE_BLOCK 8u /* side of a block, by which plants are culled [gridsquares] */
#define STATIC_SCENE_KEPT  4u /* so few plants of a gridsquare are never thinned out */

/* The constant properties of a fixed object that is a plant. */
struct static_scene_plant {
    float width, height, sink; /* [m] sink: depth of the foot in the ground */
    float slope[2], tint[3];   /* see struct draw_list_plant */
    float rank;       /* 0..1: the plant is left out while a smaller share of its wood is shown */
    float kept_share; /* share of its wood that is never thinned out */
};

/* Lowest foot and highest top of the plants of a block; low > high if it has none. */
struct static_scene_block {
    float low, high;
};

struct static_scene {
    const struct world *world;
    struct terrain_quadtree ground;
    uint32_t *square_start; /* [gridsquares + 1] into world->fixed; owned */
    uint8_t *look;          /* [world->counts.fixed] enum plant_impostors or LOOK_MODEL; owned */
    struct static_scene_plant *plants; /* [world->counts.fixed]; owned */
    uint32_t blocks_a_side;
    struct static_scene_block *blocks; /* [blocks_a_side * blocks_a_side] row by row; owned */
    struct mesh_skeleton *skeletons;   /* [world->counts.models]; owned */
    struct road_index roads;           /* of world->road_points; owned */
};

/* Returns 0, or -1 with errno ENOMEM. The world must outlive the static scene. */
int static_scene_init(struct static_scene *static_scene, const struct world *world);
void static_scene_free(struct static_scene *static_scene);

/* Sets slope to the ground's rise a metre to the east and to the south, without craters. */
void static_scene_slope(const struct terrain *terrain, double x, double z, float slope[2]);

#endif
