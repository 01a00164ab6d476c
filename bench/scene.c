/* Drawing a world in one process. */
#include "bench/scene.h"

#include "bench/world.h"
#include "ipc/log.h"

#include <errno.h>
#include <string.h>

#define EVENTS 256u

struct moment bench_scene_moment(const struct bench_scene *s)
{
    const struct state *state = &s->view.w[player_frame(&s->player) & 1];
    return (struct moment){.world = &s->view.world,
                           .head = state->head,
                           .entities = &state->entities,
                           .fixed_damage = state->fixed_damage,
                           .craters = &s->craters,
                           .dents = &s->dents,
                           .gear = &s->gear};
}

void bench_scene_go_on(struct bench_scene *s)
{
    struct event events[EVENTS];
    uint32_t count;
    player_step(&s->player, NULL);
    struct moment moment = bench_scene_moment(s);
    crater_index_update(&s->craters, moment.head->crater_count);
    dents_update(&s->dents, moment.head->dent_count);
    do {
        count = events_read(&s->view, &s->events, events, EVENTS);
        effects_take(&s->effects, &moment, events, count);
    } while (count == EVENTS);
    tracks_note(&s->tracks, &moment);
    gear_note(&s->gear, &moment);
}

static void open_back_end(struct bench_scene *s)
{
    const struct bench_scene_wish *wish = &s->wish;
    const struct gl_wish any = {.device = NULL};
    char name[DRAW_NAME_BYTES];
    struct reason reason;
    int opened =
        wish->soft
            ? soft_open(&s->draw, &s->scenery, wish->width, wish->height, wish->threads, &reason)
            : gl_open(&s->draw, &s->scenery, wish->width, wish->height, &any, name, &reason);
    if (opened != 0)
        die_refused("%s", reason.text);
}

void bench_scene_open(struct bench_scene *s, const struct bench_scene_wish *wish)
{
    memset(s, 0, sizeof *s);
    s->wish = *wish;
    bench_world_open(&s->view, wish->scenario, BENCH_SCENARIO_VEHICLES);
    const struct world *world = &s->view.world;
    if (player_init(&s->player, &s->view, 1) != 0 ||
        crater_index_init(&s->craters, s->view.w[0].craters) != 0 ||
        dents_init(&s->dents, s->view.w[0].dents, world->params->dent_slots) != 0 ||
        tracks_init(&s->tracks, world->params->capacity) != 0 ||
        gear_init(&s->gear, world->params->capacity) != 0 ||
        scenery_init(&s->scenery, world) != 0 || scene_init(&s->scene) != 0 ||
        image_init(&s->image, wish->width, wish->height) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    open_back_end(s);
    while (player_frame(&s->player) < wish->frame)
        bench_scene_go_on(s);
    struct follow follow = {.id = 0};
    struct moment moment = bench_scene_moment(s);
    s->slot = follow_choose(&follow, &moment, &s->effects, wish->follow, true);
}

void bench_scene_close(struct bench_scene *s)
{
    s->draw.close(s->draw.self);
    image_free(&s->image);
    scene_free(&s->scene);
    scenery_free(&s->scenery);
    gear_free(&s->gear);
    tracks_free(&s->tracks);
    dents_free(&s->dents);
    crater_index_free(&s->craters);
    player_free(&s->player);
    segment_abandon(&s->view);
}

void bench_scene_build(struct bench_scene *s, const struct moment *moment)
{
    struct camera camera;
    const struct aim_wish wish = {.view = s->wish.view,
                                  .field_rad = CAMERA_FIELD_OF_VIEW_RAD,
                                  .width = s->image.width,
                                  .height = s->image.height,
                                  .stand = s->wish.stand};
    aim_camera(&s->aim, &wish, moment, s->slot, &camera);
    scene_build(&s->scene, &camera, &s->scenery, moment, &s->effects);
}

void bench_scene_draw(struct bench_scene *s, const struct moment *moment)
{
    struct reason reason;
    if (s->draw.picture(s->draw.self, &s->scene, moment, &s->image, &reason) != 0)
        die_refused("%s", reason.text);
}
