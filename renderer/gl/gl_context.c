/* The search for a usable OpenGL. Users of off-screen rendering mostly complain that only the first
 * device was tried, that no cause was given, and that pictures were silently black. Therefore every
 * candidate is tried, every failure is reported, and a known pixel must be read back. */
#include "renderer/gl/gl_context.h"

#include "renderer/gl/gl_devices.h"

#include <epoxy/gl.h>

#include <stdio.h>
#include <string.h>

struct version {
    EGLint major, minor;
};

static const struct version versions[] = {{4, 5}, {3, 3}};

static const char *egl_error(void)
{
    switch (eglGetError()) {
    case EGL_NOT_INITIALIZED:
        return "not initialized";
    case EGL_BAD_ALLOC:
        return "no resources";
    case EGL_BAD_MATCH:
        return "version not supported";
    case EGL_BAD_CONFIG:
        return "no such configuration";
    case EGL_BAD_DISPLAY:
        return "no display";
    case EGL_SUCCESS:
        return "no reason given";
    default:
        return "refused by the driver";
    }
}

/* Appends "name: what" to the reason, if there is space. */
static void append_failure(struct error_text *error, const char *name, const char *what)
{
    size_t used = strlen(error->text);
    snprintf(error->text + used, sizeof error->text - used, "%s%.40s: %.60s", used > 0 ? "; " : "",
             name, what);
}

/* Draws a pixel and reads it back. No cleared or uninitialised memory has this green. */
static bool draws_a_pixel(void)
{
    GLuint buffer, frame;
    uint8_t pixel[4] = {0, 0, 0, 0};
    glGenRenderbuffers(1, &buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, 4, 4);
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    glClearColor(51.0f / 255.0f, 204.0f / 255.0f, 102.0f / 255.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    glReadPixels(1, 1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &frame);
    glDeleteRenderbuffers(1, &buffer);
    return pixel[0] == 51 && pixel[1] == 204 && pixel[2] == 102 && pixel[3] == 255;
}

/* Makes a context current on an initialised display. Returns NULL, or the reason. */
static const char *make_context(struct gl_context *gl)
{
    const char *extensions = eglQueryString(gl->display, EGL_EXTENSIONS);
    if (!gl_has_word(extensions, "EGL_KHR_surfaceless_context"))
        return "it cannot draw without a window";
    if (!eglBindAPI(EGL_OPENGL_API))
        return "it has OpenGL ES alone";
    EGLConfig config = NULL; /* EGL_NO_CONFIG_KHR */
    if (!gl_has_word(extensions, "EGL_KHR_no_config_context")) {
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                                 EGL_PBUFFER_BIT, EGL_NONE};
        EGLint found = 0;
        if (!eglChooseConfig(gl->display, wanted, &config, 1, &found) || found == 0)
            return "it has no configuration for OpenGL";
    }
    const char *detail = "no context";
    for (size_t i = 0; i < sizeof versions / sizeof versions[0]; i++) {
        const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 versions[i].major,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 versions[i].minor,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
        gl->context = eglCreateContext(gl->display, config, EGL_NO_CONTEXT, wanted);
        if (gl->context == EGL_NO_CONTEXT) {
            detail = egl_error();
            continue;
        }
        if (!eglMakeCurrent(gl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, gl->context))
            detail = egl_error();
        else if (draws_a_pixel())
            return NULL;
        else
            detail = "it draws, but nothing comes back";
        eglMakeCurrent(gl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(gl->display, gl->context);
    }
    return detail;
}

static const char *try_candidate(struct gl_context *gl, const struct gl_candidate *candidate)
{
    if (candidate->platform == 0)
        gl->display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    else
        gl->display = eglGetPlatformDisplayEXT(candidate->platform, candidate->device, NULL);
    if (gl->display == EGL_NO_DISPLAY)
        return "no display";
    EGLint major, minor;
    if (!eglInitialize(gl->display, &major, &minor))
        return egl_error();
    const char *detail = make_context(gl);
    if (detail != NULL)
        eglTerminate(gl->display);
    return detail;
}

/* Finds whether the context is on hardware, and its name. */
static void describe(struct gl_context *gl, const struct gl_candidate *candidate)
{
    const char *renderer = (const char *)glGetString(GL_RENDERER);
    gl->software = candidate->software || strstr(renderer, "llvmpipe") != NULL ||
                   strstr(renderer, "softpipe") != NULL || strstr(renderer, "swrast") != NULL;
    snprintf(gl->name, sizeof gl->name, "%.80s, OpenGL %.40s, on %s (%s)", renderer,
             (const char *)glGetString(GL_VERSION), candidate->name,
             gl->software ? "software" : "hardware");
}

/* Opens a context on the candidate if it fulfils the request. Returns NULL, or the reason. */
static const char *try_if_requested(struct gl_context *gl, const struct gl_candidate *candidate,
                                    const struct gl_request *request)
{
    if (!gl_may_be(candidate, request))
        return "not asked for";
    if (request->hardware && candidate->software)
        return "draws in software";
    const char *detail = try_candidate(gl, candidate);
    if (detail != NULL)
        return detail;
    describe(gl, candidate);
    if (request->hardware && gl->software)
        detail = "draws in software";
    else if (!gl_is_called(candidate, gl->name, request))
        detail = "has another name";
    if (detail != NULL)
        gl_context_close(gl);
    return detail;
}

int gl_context_open(struct gl_context *gl, const struct gl_request *request,
                    struct error_text *error)
{
    if (gl_library(error) != 0)
        return -1;
    struct gl_candidate candidates[GL_CANDIDATES_MAX];
    uint32_t count = gl_find_candidates(candidates);
    struct error_text failures = {.text = ""};
    for (uint32_t i = 0; i < count; i++) {
        const char *detail = try_if_requested(gl, &candidates[i], request);
        if (detail == NULL)
            return 0;
        append_failure(&failures, candidates[i].name, detail);
    }
    if (request->device != NULL)
        return error_text_set(error,
                              "--device %.40s: no OpenGL of that number or name; tried: %.300s; "
                              "jolon-renderer --list-devices lists the devices",
                              request->device, failures.text);
    if (request->hardware)
        return error_text_set(error, "no usable OpenGL 3.3 on it%s; tried: %.300s",
                              gl_hardware_hint(), failures.text);
    return error_text_set(error,
                          "no usable OpenGL 3.3%s; tried: %.300s; on Debian and Ubuntu: apt-get "
                          "install libgl1-mesa-dri (it draws in software)",
                          gl_hardware_hint(), failures.text);
}

void gl_context_list(void)
{
    struct error_text error;
    struct gl_candidate candidates[GL_CANDIDATES_MAX];
    if (gl_library(&error) != 0) {
        printf("-  %s\n", error.text);
        return;
    }
    uint32_t count = gl_find_candidates(candidates);
    for (uint32_t i = 0; i < count; i++) {
        struct gl_context gl;
        char number[12] = "-";
        if (candidates[i].number >= 0)
            snprintf(number, sizeof number, "%d", candidates[i].number);
        const char *detail = try_candidate(&gl, &candidates[i]);
        if (detail != NULL) {
            printf("%s  %s: %s\n", number, candidates[i].name, detail);
            continue;
        }
        describe(&gl, &candidates[i]);
        printf("%s  %s\n", number, gl.name);
        gl_context_close(&gl);
    }
}

void gl_context_close(struct gl_context *gl)
{
    eglMakeCurrent(gl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(gl->display, gl->context);
    eglTerminate(gl->display);
}
