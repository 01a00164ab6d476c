/* An OpenGL context without a window, found wherever this machine has one. */
#ifndef JOLON_RENDERER_GL_CONTEXT_H
#define JOLON_RENDERER_GL_CONTEXT_H

#include "ipc/segment.h"

#include <epoxy/egl.h>

#include <stdbool.h>

struct gl_context {
    EGLDisplay display;
    EGLContext context;
};

/* Tries every hardware device, then the software device, then a surfaceless display, then the
 * default one; OpenGL 4.5, then 3.3 core on each; a context counts only when it can draw a pixel
 * and read it back. Makes it current and logs which it is. 0, or -1 with every attempt's reason in
 * one line and what to install. */
int gl_context_open(struct gl_context *gl, struct reason *reason);
void gl_context_close(struct gl_context *gl);

#endif
