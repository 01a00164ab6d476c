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
    int (*picture)(void *self, const struct draw_list *list, const struct frame_view *frame_view,
                   struct image *image, struct error_text *error);
    /* NULL when the back end cannot tell. */
    const struct back_end_stages *(*stages)(void *self);
    void (*close)(void *self);
};

#endif
