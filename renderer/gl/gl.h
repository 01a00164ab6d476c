/* The OpenGL back end. */
#ifndef JOLON_RENDERER_GL_GL_H
#define JOLON_RENDERER_GL_GL_H

#include "renderer/scene/back_end_interface.h"

struct gl_request;

/* Opens OpenGL 3.3 core or later without a window (EGL), on the machine's graphics hardware or in
 * software, for pictures up to width x height. name: a description for users. Returns 0, or -1 with
 * the reason, which names what is missing. Takes up to a second. */
int gl_open(struct back_end_interface *draw, const struct static_scene *static_scene,
            uint32_t width, uint32_t height, const struct gl_request *request,
            char name[BACK_END_NAME_BYTES], struct error_text *error);

#endif
