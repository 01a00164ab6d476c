/* An OpenGL context without a window, on the first device or display that works. */
#ifndef JOLON_RENDERER_GL_GL_CONTEXT_H
#define JOLON_RENDERER_GL_GL_CONTEXT_H

#include "renderer/scene/back_end_interface.h"

#include <epoxy/egl.h>

#include <stdbool.h>

struct gl_request;

struct gl_context {
    EGLDisplay display;
    EGLContext context;
    bool software;
    char name[256]; /* the driver, its version and the device, for users */
};

/* Opens a context and makes it current. Tries every hardware device, then the software device, a
 * surfaceless display and the default display, each with OpenGL 4.5, then 3.3 core. A context is
 * accepted only if it fulfils the request and a pixel that it draws can be read back. Returns 0, or
 * -1 with the reason of every attempt in one line and what to do. */
int gl_context_open(struct gl_context *gl, const struct gl_request *request,
                    struct error_text *error);
void gl_context_close(struct gl_context *gl);

/* Prints every device and display with its renderer, or why it cannot draw. */
void gl_context_list(void);

#endif
