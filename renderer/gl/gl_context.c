/* The search for a usable OpenGL. The commonest complaints about off-screen rendering are that
 * only the first device was tried, that no cause was given, and that pictures were silently black;
 * so every candidate is tried, every failure is named, and a known pixel must come back. */
#include "renderer/gl/gl_context.h"

#include "ipc/log.h"

#include <epoxy/gl.h>

#include <dlfcn.h>
#include <errno.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define DEVICES_MAX    16
#define CANDIDATES_MAX (DEVICES_MAX + 2)

struct candidate {
    EGLDeviceEXT device;
    EGLenum platform; /* 0: the default display */
    bool software;
    char name[48];
};

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

static bool has_word(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = list; at != NULL && (at = strstr(at, word)) != NULL; at += length)
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0'))
            return true;
    return false;
}

/* Adds "name: what; " to the reason, as far as there is room. */
static void note(struct reason *reason, const char *name, const char *what)
{
    size_t used = strlen(reason->text);
    snprintf(reason->text + used, sizeof reason->text - used, "%s%.40s: %.60s",
             used > 0 ? "; " : "", name, what);
}

static uint32_t find_devices(struct candidate *candidates, bool software)
{
    EGLDeviceEXT devices[DEVICES_MAX];
    EGLint count = 0;
    uint32_t found = 0;
    if (!eglQueryDevicesEXT(DEVICES_MAX, devices, &count))
        return 0;
    for (EGLint i = 0; i < count; i++) {
        const char *extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
        if (has_word(extensions, "EGL_MESA_device_software") != software)
            continue;
        struct candidate *c = &candidates[found++];
        *c = (struct candidate){
            .platform = EGL_PLATFORM_DEVICE_EXT, .device = devices[i], .software = software};
        snprintf(c->name, sizeof c->name, "%s device %d", software ? "software" : "hardware", i);
    }
    return found;
}

static uint32_t find_candidates(struct candidate candidates[CANDIDATES_MAX])
{
    const char *client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    bool platforms = has_word(client, "EGL_EXT_platform_base");
    bool devices = platforms && has_word(client, "EGL_EXT_platform_device") &&
                   (has_word(client, "EGL_EXT_device_base") ||
                    (has_word(client, "EGL_EXT_device_enumeration") &&
                     has_word(client, "EGL_EXT_device_query")));
    uint32_t count = 0;
    if (devices) {
        count = find_devices(candidates, false);
        count += find_devices(candidates + count, true);
    }
    if (platforms && has_word(client, "EGL_MESA_platform_surfaceless"))
        candidates[count++] =
            (struct candidate){.name = "surfaceless", .platform = EGL_PLATFORM_SURFACELESS_MESA};
    candidates[count++] = (struct candidate){.name = "default display"};
    return count;
}

/* A green that no cleared, lost or uninitialised memory looks like must come back. */
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

/* A current context on an initialised display; NULL, or why there is none. */
static const char *make_context(struct gl_context *gl)
{
    const char *extensions = eglQueryString(gl->display, EGL_EXTENSIONS);
    if (!has_word(extensions, "EGL_KHR_surfaceless_context"))
        return "it cannot draw without a window";
    if (!eglBindAPI(EGL_OPENGL_API))
        return "it has OpenGL ES alone";
    EGLConfig config = NULL; /* EGL_NO_CONFIG_KHR */
    if (!has_word(extensions, "EGL_KHR_no_config_context")) {
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                                 EGL_PBUFFER_BIT, EGL_NONE};
        EGLint found = 0;
        if (!eglChooseConfig(gl->display, wanted, &config, 1, &found) || found == 0)
            return "it has no configuration for OpenGL";
    }
    const char *why = "no context";
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
            why = egl_error();
            continue;
        }
        if (!eglMakeCurrent(gl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, gl->context))
            why = egl_error();
        else if (draws_a_pixel())
            return NULL;
        else
            why = "it draws, but nothing comes back";
        eglMakeCurrent(gl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(gl->display, gl->context);
    }
    return why;
}

static const char *try_candidate(struct gl_context *gl, const struct candidate *candidate)
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
    const char *why = make_context(gl);
    if (why != NULL)
        eglTerminate(gl->display);
    return why;
}

/* Why graphics hardware that is there may not be usable; "" when nothing is known. */
static const char *hardware_hint(void)
{
    const char *hint = "";
    glob_t nodes;
    if (glob("/dev/dri/renderD*", 0, NULL, &nodes) == 0) {
        for (size_t i = 0; i < nodes.gl_pathc; i++)
            if (access(nodes.gl_pathv[i], R_OK | W_OK) != 0 && errno == EACCES)
                hint = " (no permission for /dev/dri/renderD*: add the user to the group render)";
        globfree(&nodes);
    }
    glob_t vendor;
    if (access("/dev/nvidiactl", F_OK) == 0) {
        if (glob("/usr/share/glvnd/egl_vendor.d/*nvidia*", 0, NULL, &vendor) != 0)
            hint = " (an NVIDIA device is here, but its EGL vendor file is not installed)";
        else
            globfree(&vendor);
    }
    return hint;
}

int gl_context_open(struct gl_context *gl, struct reason *reason)
{
    /* epoxy ends the process when it finds no libEGL, so it is asked only when there is one. */
    void *library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL);
    if (library == NULL)
        return reason_set(reason, "no OpenGL: libEGL.so.1 is not installed; on Debian and Ubuntu: "
                                  "apt-get install libegl1 libgl1-mesa-dri");
    setenv("EGL_LOG_LEVEL", "fatal", 0);

    struct candidate candidates[CANDIDATES_MAX];
    uint32_t count = find_candidates(candidates);
    struct reason failures = {.text = ""};
    for (uint32_t i = 0; i < count; i++) {
        const char *why = try_candidate(gl, &candidates[i]);
        if (why != NULL) {
            note(&failures, candidates[i].name, why);
            continue;
        }
        const char *renderer = (const char *)glGetString(GL_RENDERER);
        bool software = candidates[i].software || strstr(renderer, "llvmpipe") != NULL ||
                        strstr(renderer, "softpipe") != NULL || strstr(renderer, "swrast") != NULL;
        log_info("drawing with %s, OpenGL %s, on %s (%s)%s", renderer,
                 (const char *)glGetString(GL_VERSION), candidates[i].name,
                 software ? "software" : "hardware", software ? hardware_hint() : "");
        return 0;
    }
    return reason_set(reason,
                      "no usable OpenGL 3.3%s; tried: %.300s; on Debian and Ubuntu: apt-get "
                      "install libgl1-mesa-dri (it draws in software)",
                      hardware_hint(), failures.text);
}

void gl_context_close(struct gl_context *gl)
{
    eglMakeCurrent(gl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(gl->display, gl->context);
    eglTerminate(gl->display);
}
