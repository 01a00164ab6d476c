/* A back end: something that makes a picture of a scene. */
#ifndef JOLON_RENDERER_SCENE_BACK_END_INTERFACE_H
#define JOLON_RENDERER_SCENE_BACK_END_INTERFACE_H

#include "ipc/segment/segment.h"
#include "renderer/image/image.h"
#include "renderer/scene/scene.h"

#include <stdbool.h>
#include <stddef.h>

#define BACK_END_NAME_BYTES 256

#define BACK_END_STAGES_MAX 12u

/* What the last picture cost: processor time of all threads together. */
struct back_end_stages {
    uint32_t count;
    struct back_end_stage {
        const char *name;
        uint64_t cpu_ns;
    } stage[BACK_END_STAGES_MAX];
};

struct back_end_interface {
    void *self; /* the back end's own */
    /* Draws the scene into an image no larger than it was opened for, in the image's size. craters:
     * the moment's, for the ground. 0, or -1 with the reason; the back end is of no more use then.
     */
    int (*picture)(void *self, const struct scene *scene, const struct frame_view *moment,
                   struct image *image, struct reason *reason);
    /* NULL when the back end cannot tell. */
    const struct back_end_stages *(*stages)(void *self);
    void (*close)(void *self);
};

/* Which OpenGL: all zero is the first that draws, hardware before software. */
struct gl_wish {
    const char *device; /* its number, or part of its name; NULL: any */
    bool hardware;      /* software is no good */
};

/* OpenGL 3.3 core or later without a window (EGL), on the machine's graphics hardware or in
 * software, for pictures up to width x height; name: how it is called, for people. 0, or -1 with
 * the reason, which names what is missing. Takes up to a second. */
int gl_open(struct back_end_interface *draw, const struct static_scene *scenery, uint32_t width,
            uint32_t height, const struct gl_wish *wish, char name[BACK_END_NAME_BYTES],
            struct reason *reason);

/* Does the machine look as if it had graphics hardware? Looks at device files alone and loads
 * nothing; why: what is missing. */
bool gl_hardware(char *why, size_t bytes);

/* Prints every OpenGL that there is to standard output, a line each. */
void gl_list(void);

/* Our own software, on as many threads (1 .. THREAD_POOL_MAX), for pictures up to width x height.
 * The same scene gives the same picture to the bit on every machine and any number of threads. 0,
 * or -1 with the reason: no memory, or too large a picture. */
int soft_open(struct back_end_interface *draw, const struct static_scene *scenery, uint32_t width,
              uint32_t height, uint32_t threads, struct reason *reason);

/* The vectors that it works with on this processor: "AVX2". */
const char *soft_vectors(void);

#endif
