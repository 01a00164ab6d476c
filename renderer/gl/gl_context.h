/* An OpenGL context without a window, found wherever this machine has one. */
#ifndef JOLON_RENDERER_GL_GL_CONTEXT_H
#define JOLON_RENDERER_GL_GL_CONTEXT_H

#include "renderer/scene/back_end_interface.h"

#include <epoxy/egl.h>

#include <stdbool.h>

struct gl_wish;

struct gl_context {
    EGLDisplay display;
    EGLContext context;
    bool software;
    char name[256]; /* of the driver, its version and the device, for people */
};

/* Tries every hardware device, then the software device, then a surfaceless display, then the
 * default one; OpenGL 4.5, then 3.3 core on each; a context counts only when it can draw a pixel
 * and read it back, and when it is what is wished for. Makes it current. 0, or -1 with every
 * attempt's reason in one line and what to do. */
int gl_context_open(struct gl_context *gl, const struct gl_wish *wish, struct error_text *error);
void gl_context_close(struct gl_context *gl);

/* Prints every device and display with what it draws with, or why it cannot. */
void gl_context_list(void);

#endif
