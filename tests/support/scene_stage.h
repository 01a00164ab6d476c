/* A world in the test's own memory from which scenes are made, without mover and collider. The test
 * chooses the kinds, the ground and the objects. A failure in here fails the calling cmocka test.
 */
#ifndef JOLON_TESTS_SUPPORT_SCENE_STAGE_H
#define JOLON_TESTS_SUPPORT_SCENE_STAGE_H

#include "renderer/scene/scene.h"
#include "world/params.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <stdbool.h>
#include <stdint.h>

#define SCENE_STAGE_POSTS   401u
#define SCENE_STAGE_CRATERS 4u
#define SCENE_STAGE_DENTS   64u

struct scene_stage {
    struct params params;
    struct world world;
    struct state_head head;
    struct entities entities;
    void *columns;
    float *posts; /* [SCENE_STAGE_POSTS * SCENE_STAGE_POSTS], as cover */
    uint8_t *cover;
    uint32_t *reach_start;
    struct fixed_object *fixed;
    uint8_t *fixed_damage;
    struct crater craters[SCENE_STAGE_CRATERS];
    struct crater_index index;
    struct dent dent[SCENE_STAGE_DENTS];
    struct dent_index dents;
    struct effects effects;
    struct static_scene static_scene;
    struct draw_list list;
    struct frame_view frame_view;
};

/* Returns a world with room for capacity entities and so many fixed objects. Everything is zero but
 * the parameter capacity, the terrain, and the arrays that the world points to. */
struct scene_stage *scene_stage_new(uint32_t capacity, uint32_t fixed);

/* Adds an active blue entity of a kind at (x, z), at height 0. Returns its slot. */
uint32_t scene_stage_put(struct scene_stage *stage, uint16_t kind, double x, double z,
                         double heading);

/* Prepares the scenes, when the test has filled the world. */
void scene_stage_ready(struct scene_stage *stage);

/* Tear-down for cmocka: frees the stage that *context points to. */
int scene_stage_teardown(void **context);

/* Returns true if a place is in the camera's picture, by the matrix that pictures are drawn with.
 */
bool scene_stage_in_picture(const struct camera *camera, struct vec3 place);

#endif
