/* The interface of a back end, which draws a draw list into an image. */
#ifndef JOLON_RENDERER_SCENE_BACK_END_INTERFACE_H
#define JOLON_RENDERER_SCENE_BACK_END_INTERFACE_H

#include "ipc/segment/segment.h"
#include "renderer/image/image.h"
#include "renderer/scene/scene.h"

#include <stdbool.h>
#include <stddef.h>

#define BACK_END_NAME_BYTES 256

#define BACK_END_STAGES_MAX 12u

/* Processor time of the last picture, summed over all threads. */
struct back_end_stages {
    uint32_t count;
    struct back_end_stage {
        const char *name;
        uint64_t cpu_ns;
    } stage[BACK_END_STAGES_MAX];
};

struct back_end_interface {
    void *self; /* passed to each function */
    /* Draws the list into an image no larger than the back end was opened for. frame_view: the
     * frame that the list was made from, for the ground. Returns 0, or -1 with the error set; the
     * back end can then no longer be used. */
    int (*picture)(void *self, const struct draw_list *list, const struct frame_view *frame_view,
                   struct image *image, struct error_text *error);
    /* NULL if the back end does not measure stages. */
    const struct back_end_stages *(*stages)(void *self);
    void (*close)(void *self);
};

#endif
