/* The devices and displays that may offer an OpenGL context. Private to gl*.c. */
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
    int number;       /* EGL's number of the device; below 0: not a device */
    bool software;
    char name[96];
};

/* The OpenGL device that the user has chosen. All zero: the first that draws, hardware before
 * software. */
struct gl_request {
    const char *device; /* its number, or a part of its name; NULL: any */
    bool hardware;      /* software is refused */
};

/* Loads libEGL, which must precede any EGL call. Returns 0, or -1 with what to install. */
int gl_library(struct error_text *error);

/* Lists the hardware devices, then software devices, a surfaceless and the default display. Returns
 * their number. */
uint32_t gl_find_candidates(struct gl_candidate candidates[GL_CANDIDATES_MAX]);

/* Returns false if the candidate's number excludes it. No context is needed. */
bool gl_may_be(const struct gl_candidate *candidate, const struct gl_request *request);

/* Returns true if the candidate is the requested device, by its number or the context's name. */
bool gl_is_called(const struct gl_candidate *candidate, const char *name,
                  const struct gl_request *request);

/* Returns true if the word is in a list that is separated by blanks; NULL is an empty list. */
bool gl_has_word(const char *list, const char *word);

/* Returns true if the machine seems to have graphics hardware. It looks only at device files and
 * loads nothing. detail: what is missing. */
bool gl_hardware(char *detail, size_t bytes);

/* Returns why graphics hardware may be unusable, or "" when no reason is known. */
const char *gl_hardware_hint(void);

#endif
