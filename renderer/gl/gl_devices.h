/* Which devices could give an OpenGL context, before one is asked for. Private to gl*.c. */
#ifndef JOLON_RENDERER_GL_GL_DEVICES_H
#define JOLON_RENDERER_GL_GL_DEVICES_H

#include "renderer/scene/back_end_interface.h"

#include <epoxy/egl.h>

#include <stdbool.h>
#include <stdint.h>

#define GL_CANDIDATES_MAX 18

struct gl_candidate {
    EGLDeviceEXT device;
    EGLenum platform; /* 0: the default display */
    int number;       /* as EGL counts devices; below 0: none */
    bool software;
    char name[96];
};

/* Which OpenGL: all zero is the first that draws, hardware before software. */
struct gl_wish {
    const char *device; /* its number, or part of its name; NULL: any */
    bool hardware;      /* software is no good */
};

/* Finds libEGL, which must be there before any call of it. 0, or -1 with what to install. */
int gl_library(struct error_text *error);

/* Every hardware device, then software devices, a surfaceless and the default display; how many. */
uint32_t gl_find_candidates(struct gl_candidate candidates[GL_CANDIDATES_MAX]);

/* Can it be the one wished for, as far as can be told without a context? */
bool gl_may_be(const struct gl_candidate *candidate, const struct gl_wish *wish);

/* And with one, by its full name? */
bool gl_is_called(const struct gl_candidate *candidate, const char *name,
                  const struct gl_wish *wish);

/* Is the word in the list, which has blanks between words? NULL is an empty list. */
bool gl_has_word(const char *list, const char *word);

/* Does the machine look as if it had graphics hardware? Looks at device files alone and loads
 * nothing; why: what is missing. */
bool gl_hardware(char *detail, size_t bytes);

/* Why graphics hardware that is there may not be usable; "" when nothing is known. */
const char *gl_hardware_hint(void);

#endif
