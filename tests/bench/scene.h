/* A world of this process's own and all that it takes to draw it, frame by frame: what pictures are
 * measured and compared on. Single-threaded but for the back end. Whatever fails ends the process
 * with the reason (exit 1). */
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

struct bench_scene_wish {
    const char *scenario;         /* as for jolon run; NULL: Hunter-Liggett */
    uint64_t frame;               /* to begin with */
    uint32_t width, height;       /* [pixel], the largest picture */
    uint32_t threads;             /* of the software back end */
    bool soft;                    /* else OpenGL */
    uint32_t follow;              /* entity id, 0: the liveliest */
    enum view_mode view;          /* not VIEW_MAP */
    struct view_camera_pose pose; /* of VIEW_FREE */
};

struct bench_scene {
    struct bench_scene_wish wish;
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
    uint32_t slot; /* of the followed vehicle; SLOT_NONE: there is none */
};

void bench_scene_open(struct bench_scene *s, const struct bench_scene_wish *wish);
void bench_scene_close(struct bench_scene *s);

/* One frame of simulation, and what a renderer remembers of it. */
void bench_scene_go_on(struct bench_scene *s);

/* The committed frame; lives until the next. */
struct frame_view bench_scene_moment(const struct bench_scene *s);

/* The two halves of a picture of it, into s->list and s->image. */
void bench_scene_build(struct bench_scene *s, const struct frame_view *frame_view);
void bench_scene_draw(struct bench_scene *s, const struct frame_view *frame_view);

#endif
