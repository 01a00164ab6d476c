/* Draws a world in one process. */
#include "tests/bench/scene.h"

#include "ipc/frame/event_cursor.h"
#include "tests/bench/world.h"
#include "ipc/process/log.h"
#include "world/params.h"
#include "renderer/gl/gl.h"
#include "renderer/gl/gl_devices.h"
#include "renderer/soft/soft.h"

#include <errno.h>
#include <string.h>

#define EVENTS 256u

struct frame_view bench_scene_frame_view(const struct bench_scene *s)
{
    const struct state *state = &s->view.w[frame_stepper_frame(&s->stepper) & 1];
    return (struct frame_view){.world = &s->view.world,
                               .head = state->head,
                               .entities = &state->entities,
                               .fixed_damage = state->fixed_damage,
                               .craters = &s->craters,
                               .dents = &s->dents,
                               .roads = &s->static_scene.roads,
                               .articulation = &s->articulation};
}

void bench_scene_step(struct bench_scene *s)
{
    struct event events[EVENTS];
    uint32_t count;
    frame_stepper_step(&s->stepper, NULL);
    struct frame_view frame_view = bench_scene_frame_view(s);
    crater_index_update(&s->craters, frame_view.head->crater_count);
    dent_index_update(&s->dents, frame_view.head->dent_count);
    do {
        count = events_read(&s->view, &s->events, events, EVENTS);
        effects_take(&s->effects, &frame_view, events, count);
    } while (count == EVENTS);
    tracks_note(&s->tracks, &frame_view);
    articulation_note(&s->articulation, &frame_view);
}

static void open_back_end(struct bench_scene *s)
{
    const struct bench_scene_options *options = &s->scene_options;
    const struct gl_request any = {.device = NULL};
    char name[BACK_END_NAME_BYTES];
    struct error_text error;
    int opened = options->soft ? soft_open(&s->draw, &s->static_scene, options->width,
                                           options->height, options->threads, &error)
                               : gl_open(&s->draw, &s->static_scene, options->width,
                                         options->height, &any, name, &error);
    if (opened != 0)
        die_refused("%s", error.text);
}

void bench_scene_open(struct bench_scene *s, const struct bench_scene_options *options)
{
    memset(s, 0, sizeof *s);
    s->scene_options = *options;
    bench_world_open(&s->view, options->scenario, BENCH_SCENARIO_VEHICLES);
    const struct world *world = &s->view.world;
    if (frame_stepper_init(&s->stepper, &s->view, 1) != 0 ||
        crater_index_init(&s->craters, &GRIDSQUARES_DEFAULT, s->view.w[0].craters) != 0 ||
        dent_index_init(&s->dents, s->view.w[0].dents, world->params->dent_slots) != 0 ||
        tracks_init(&s->tracks, world->params->capacity) != 0 ||
        articulation_init(&s->articulation, world->params->capacity) != 0 ||
        static_scene_init(&s->static_scene, world) != 0 || scene_init(&s->list) != 0 ||
        image_init(&s->image, options->width, options->height) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    open_back_end(s);
    while (frame_stepper_frame(&s->stepper) < options->frame)
        bench_scene_step(s);
    struct follow follow = {.id = 0};
    struct frame_view frame_view = bench_scene_frame_view(s);
    s->slot = follow_choose(&follow, &frame_view, &s->effects, options->follow, true);
}

void bench_scene_close(struct bench_scene *s)
{
    s->draw.close(s->draw.self);
    image_free(&s->image);
    scene_free(&s->list);
    static_scene_free(&s->static_scene);
    articulation_free(&s->articulation);
    tracks_free(&s->tracks);
    dent_index_free(&s->dents);
    crater_index_free(&s->craters);
    frame_stepper_free(&s->stepper);
    segment_abandon(&s->view);
}

void bench_scene_build(struct bench_scene *s, const struct frame_view *frame_view)
{
    struct camera camera;
    const struct view_camera_options options = {.view = s->scene_options.view,
                                                .field_rad = CAMERA_FIELD_OF_VIEW_RAD,
                                                .width = s->image.width,
                                                .height = s->image.height,
                                                .pose = s->scene_options.pose};
    view_camera_update(&s->view_camera, &options, frame_view, s->slot, &camera);
    scene_build(&s->list, &camera, &s->static_scene, frame_view, &s->effects);
}

void bench_scene_draw(struct bench_scene *s, const struct frame_view *frame_view)
{
    struct error_text error;
    if (s->draw.picture(s->draw.self, &s->list, frame_view, &s->image, &error) != 0)
        die_refused("%s", error.text);
}
