/* A world of this process's own and all that it takes to draw it, frame by frame: what pictures are
 * measured and compared on. Single-threaded but for the back end. Whatever fails ends the process
 * with the reason (exit 1). */
#ifndef JOLON_BENCH_SCENE_H
#define JOLON_BENCH_SCENE_H

#include "ipc/segment.h"
#include "ipc/snapshot.h"
#include "renderer/chart/track.h"
#include "renderer/draw.h"
#include "renderer/scene/aim.h"
#include "renderer/scene/follow.h"
#include "replay/player.h"

#include <stdbool.h>
#include <stdint.h>

struct bench_scene_wish {
    const char *scenario;   /* as for jolon run; NULL: Hunter-Liggett */
    uint64_t frame;         /* to begin with */
    uint32_t width, height; /* [pixel], the largest picture */
    uint32_t threads;       /* of the software back end */
    bool soft;              /* else OpenGL */
    uint32_t follow;        /* entity id, 0: the liveliest */
    enum view_mode view;    /* not VIEW_MAP */
    struct aim_stand stand; /* of VIEW_FREE */
};

struct bench_scene {
    struct bench_scene_wish wish;
    struct view view;
    struct player player;
    struct crater_index craters;
    struct dents dents;
    struct tracks tracks;
    struct gear gear;
    struct effects effects;
    struct event_cursor events;
    struct aim aim;
    struct scenery scenery;
    struct scene scene;
    struct draw draw;
    struct image image;
    uint32_t slot; /* of the followed vehicle; SLOT_NONE: there is none */
};

void bench_scene_open(struct bench_scene *s, const struct bench_scene_wish *wish);
void bench_scene_close(struct bench_scene *s);

/* One frame of simulation, and what a renderer remembers of it. */
void bench_scene_go_on(struct bench_scene *s);

/* The committed frame; lives until the next. */
struct moment bench_scene_moment(const struct bench_scene *s);

/* The two halves of a picture of it, into s->scene and s->image. */
void bench_scene_build(struct bench_scene *s, const struct moment *moment);
void bench_scene_draw(struct bench_scene *s, const struct moment *moment);

#endif
