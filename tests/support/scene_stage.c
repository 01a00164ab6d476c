/* The world of the tests of scenes. */
#include "tests/support/scene_stage.h"

#include "world/terrain/gridsquare.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct scene_stage *scene_stage_new(uint32_t capacity, uint32_t fixed)
{
    struct scene_stage *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->posts = calloc(SCENE_STAGE_POSTS * SCENE_STAGE_POSTS, sizeof *s->posts);
    s->cover = calloc(SCENE_STAGE_POSTS, SCENE_STAGE_POSTS);
    s->reach_start = calloc(GRIDSQUARES_DEFAULT.count + 1, sizeof *s->reach_start);
    s->fixed = calloc(fixed, sizeof *s->fixed);
    s->fixed_damage = calloc(fixed, 1);
    s->columns = aligned_alloc(TABLE_ALIGN, entities_bytes(capacity));
    assert_true(s->posts && s->cover && s->reach_start && s->fixed && s->fixed_damage &&
                s->columns);
    memset(s->columns, 0, entities_bytes(capacity));
    entities_bind(&s->entities, capacity, s->columns);
    s->params.capacity = capacity;
    s->world = (struct world){.params = &s->params,
                              .counts = {.posts_side = SCENE_STAGE_POSTS},
                              .terrain = {s->posts, s->cover, SCENE_STAGE_POSTS,
                                          WORLD_SIDE_DEFAULT_M / (SCENE_STAGE_POSTS - 1),
                                          .squares = GRIDSQUARES_DEFAULT_INIT},
                              .fixed = s->fixed,
                              .reach_start = s->reach_start};
    return s;
}

uint32_t scene_stage_put(struct scene_stage *stage, uint16_t kind, double x, double z,
                         double heading)
{
    uint32_t slot = stage->head.used++;
    const struct entities *e = &stage->entities;
    e->row[slot].id = slot + 1;
    e->row[slot].state = ENTITY_ACTIVE;
    e->row[slot].kind = kind;
    e->row[slot].force = FORCE_BLUE;
    e->row[slot].x = x;
    e->row[slot].z = z;
    e->row[slot].heading = heading;
    return slot;
}

void scene_stage_ready(struct scene_stage *stage)
{
    assert_int_equal(crater_index_init(&stage->index, &GRIDSQUARES_DEFAULT, stage->craters), 0);
    assert_int_equal(dent_index_init(&stage->dents, stage->dent, SCENE_STAGE_DENTS), 0);
    assert_int_equal(static_scene_init(&stage->static_scene, &stage->world), 0);
    assert_int_equal(scene_init(&stage->list), 0);
    stage->frame_view = (struct frame_view){.world = &stage->world,
                                            .head = &stage->head,
                                            .entities = &stage->entities,
                                            .fixed_damage = stage->fixed_damage,
                                            .craters = &stage->index,
                                            .dents = &stage->dents,
                                            .roads = &stage->static_scene.roads};
}

int scene_stage_teardown(void **context)
{
    struct scene_stage *s = *context;
    scene_free(&s->list);
    static_scene_free(&s->static_scene);
    crater_index_free(&s->index);
    dent_index_free(&s->dents);
    free(s->columns);
    free(s->fixed);
    free(s->fixed_damage);
    free(s->reach_start);
    free(s->posts);
    free(s->cover);
    free(s);
    return 0;
}

bool scene_stage_in_picture(const struct camera *camera, struct vec3 place)
{
    struct vec3 p = vec3_sub(place, camera->eye);
    double clip[4];
    for (int i = 0; i < 4; i++)
        clip[i] = (double)camera->matrix[i] * p.x + (double)camera->matrix[4 + i] * p.y +
                  (double)camera->matrix[8 + i] * p.z + (double)camera->matrix[12 + i];
    return clip[3] > 0.0 && fabs(clip[0]) <= clip[3] && fabs(clip[1]) <= clip[3] &&
           fabs(clip[2]) <= clip[3];
}
