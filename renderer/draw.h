/* A back end: something that makes a picture of a scene. */
#ifndef JOLON_RENDERER_DRAW_H
#define JOLON_RENDERER_DRAW_H

#include "ipc/segment.h"
#include "renderer/image/image.h"
#include "renderer/scene/scene.h"

struct draw {
    void *self; /* the back end's own */
    /* Draws the scene into an image of the size it was opened for. craters: the moment's, for the
     * ground. 0, or -1 with the reason; the back end is of no more use then. */
    int (*picture)(void *self, const struct scene *scene, const struct moment *moment,
                   struct image *image, struct reason *reason);
    void (*close)(void *self);
};

/* OpenGL 3.3 core or later without a window (EGL), on the machine's graphics hardware or in
 * software. 0, or -1 with the reason, which names what is missing. Takes up to a second. */
int gl_open(struct draw *draw, const struct scenery *scenery, uint32_t width, uint32_t height,
            struct reason *reason);

#endif
