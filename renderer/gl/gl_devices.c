/* Devices that EGL lists, and what the system reports about them. */
#include "renderer/gl/gl_devices.h"

#include "world/runtime/parse_number.h"

#include <dlfcn.h>
#include <errno.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef EGL_DRM_RENDER_NODE_FILE_EXT
#define EGL_DRM_RENDER_NODE_FILE_EXT 0x3377 /* EGL_EXT_device_drm_render_node, of 2021 */
#endif

#define DEVICES_MAX (GL_CANDIDATES_MAX - 2)

bool gl_has_word(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = list; at != NULL && (at = strstr(at, word)) != NULL; at += length)
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0'))
            return true;
    return false;
}

static uint32_t find_devices(struct gl_candidate *candidates, bool software)
{
    EGLDeviceEXT devices[DEVICES_MAX];
    EGLint count = 0;
    uint32_t found = 0;
    if (!eglQueryDevicesEXT(DEVICES_MAX, devices, &count))
        return 0;
    for (EGLint i = 0; i < count; i++) {
        const char *extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
        if (gl_has_word(extensions, "EGL_MESA_device_software") != software)
            continue;
        struct gl_candidate *c = &candidates[found++];
        *c = (struct gl_candidate){.platform = EGL_PLATFORM_DEVICE_EXT,
                                   .device = devices[i],
                                   .number = i,
                                   .software = software};
        const char *node = NULL;
        if (gl_has_word(extensions, "EGL_EXT_device_drm_render_node"))
            node = eglQueryDeviceStringEXT(devices[i], EGL_DRM_RENDER_NODE_FILE_EXT);
        if (node == NULL && gl_has_word(extensions, "EGL_EXT_device_drm"))
            node = eglQueryDeviceStringEXT(devices[i], EGL_DRM_DEVICE_FILE_EXT);
        snprintf(c->name, sizeof c->name, "%s device %d%s%.60s", software ? "software" : "hardware",
                 i, node != NULL ? " " : "", node != NULL ? node : "");
    }
    return found;
}

uint32_t gl_find_candidates(struct gl_candidate candidates[GL_CANDIDATES_MAX])
{
    const char *client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    bool platforms = gl_has_word(client, "EGL_EXT_platform_base");
    bool devices = platforms && gl_has_word(client, "EGL_EXT_platform_device") &&
                   (gl_has_word(client, "EGL_EXT_device_base") ||
                    (gl_has_word(client, "EGL_EXT_device_enumeration") &&
                     gl_has_word(client, "EGL_EXT_device_query")));
    uint32_t count = 0;
    if (devices) {
        count = find_devices(candidates, false);
        count += find_devices(candidates + count, true);
    }
    if (platforms && gl_has_word(client, "EGL_MESA_platform_surfaceless"))
        candidates[count++] = (struct gl_candidate){
            .name = "surfaceless", .number = -1, .platform = EGL_PLATFORM_SURFACELESS_MESA};
    candidates[count++] = (struct gl_candidate){.name = "default display", .number = -1};
    return count;
}

const char *gl_hardware_hint(void)
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

bool gl_hardware(char *detail, size_t bytes)
{
    static const char *const nodes[] = {"/dev/dri/renderD*", "/dev/dri/card*", "/dev/nvidiactl",
                                        "/dev/dxg"};
    for (size_t i = 0; i < sizeof nodes / sizeof nodes[0]; i++) {
        glob_t found;
        if (glob(nodes[i], 0, NULL, &found) == 0) {
            globfree(&found);
            return true;
        }
    }
    snprintf(detail, bytes, "there is no /dev/dri, /dev/nvidiactl or /dev/dxg");
    return false;
}

int gl_library(struct error_text *error)
{
    /* epoxy ends the process when there is no libEGL, so this is checked first. */
    if (dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL) == NULL)
        return error_text_set(error,
                              "no OpenGL: libEGL.so.1 is not installed; on Debian and Ubuntu: "
                              "apt-get install libegl1 libgl1-mesa-dri");
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    return 0;
}

/* Returns the device's number if the text is a number, else -1. */
static int number_of(const char *device)
{
    uint64_t number;
    return parse_whole(device, 0, GL_CANDIDATES_MAX - 1, &number) ? (int)number : -1;
}

bool gl_may_be(const struct gl_candidate *candidate, const struct gl_request *request)
{
    return request->device == NULL || number_of(request->device) < 0 ||
           number_of(request->device) == candidate->number;
}

bool gl_is_called(const struct gl_candidate *candidate, const char *name,
                  const struct gl_request *request)
{
    if (request->device == NULL)
        return true;
    int number = number_of(request->device);
    return number >= 0 ? number == candidate->number : strcasestr(name, request->device) != NULL;
}
