/* A world in this process's memory and everything needed to draw it frame by frame, for measuring
 * and comparing pictures. Single-threaded except for the back end. An error ends the process with a
 * message (exit code 1). */
#ifndef JOLON_TESTS_BENCH_SCENE_H
#define JOLON_TESTS_BENCH_SCENE_H

#include "ipc/frame/event_cursor.h"
#include "ipc/segment/segment.h"
#include "renderer/chart/track.h"
#include "renderer/scene/back_end_interface.h"
#include "renderer/scene/camera/view_camera.h"
#include "renderer/scene/camera/follow.h"
#include "recorder/replay/frame_stepper.h"

#include <stdbool.h>
#include <stdint.h>

struct bench_scene_options {
    const char *scenario;         /* as for jolon run; NULL: Hunter-Liggett */
    uint64_t frame;               /* first frame that is drawn */
    uint32_t width, height;       /* [pixel] of the largest picture */
    uint32_t threads;             /* of the software back end */
    bool soft;                    /* software back end, otherwise OpenGL */
    uint32_t follow;              /* entity id, 0: the most active vehicle */
    enum view_mode view;          /* not VIEW_MAP */
    struct view_camera_pose pose; /* camera of VIEW_FREE */
};

struct bench_scene {
    struct bench_scene_options scene_options;
    struct view view;
    struct frame_stepper stepper;
    struct crater_index craters;
    struct dent_index dents;
    struct tracks tracks;
    struct articulation articulation;
    struct effects effects;
    struct event_cursor events;
    struct view_camera view_camera;
    struct static_scene static_scene;
    struct draw_list list;
    struct back_end_interface draw;
    struct image image;
    uint32_t slot; /* of the followed vehicle, or SLOT_NONE */
};

void bench_scene_open(struct bench_scene *s, const struct bench_scene_options *scene_options);
void bench_scene_close(struct bench_scene *s);

/* Computes one frame and updates what a renderer keeps from earlier frames. */
void bench_scene_step(struct bench_scene *s);

/* Returns the committed frame. It is valid until the next step. */
struct frame_view bench_scene_frame_view(const struct bench_scene *s);

/* The two halves of drawing a frame, into s->list and s->image. */
void bench_scene_build(struct bench_scene *s, const struct frame_view *frame_view);
void bench_scene_draw(struct bench_scene *s, const struct frame_view *frame_view);

#endif
