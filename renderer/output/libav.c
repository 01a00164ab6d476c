/* The table of libav's functions. */
#include "renderer/output/libav.h"

#include <dlfcn.h>
#include <string.h>

struct libav libav;

#define LIBRARY(name, major) "lib" #name ".so." AV_STRINGIFY(major)

/* Copies the result of dlsym(): C has no conversion from a pointer to an object to a function. */
static int find(void *library, const char *name, void *to, size_t bytes)
{
    void *found = library != NULL ? dlsym(library, name) : NULL;
    memcpy(to, &found, bytes);
    return found != NULL ? 0 : -1;
}

int libav_open(struct error_text *error)
{
    void *avutil = dlopen(LIBRARY(avutil, LIBAVUTIL_VERSION_MAJOR), RTLD_LAZY | RTLD_LOCAL);
    void *avcodec = dlopen(LIBRARY(avcodec, LIBAVCODEC_VERSION_MAJOR), RTLD_LAZY | RTLD_LOCAL);
    void *avformat = dlopen(LIBRARY(avformat, LIBAVFORMAT_VERSION_MAJOR), RTLD_LAZY | RTLD_LOCAL);
    int missing = 0;
#define LIBAV_FIND(library, function)                                                              \
    missing += find(library, #function, &libav.function, sizeof libav.function);
    LIBAV_FUNCTIONS(LIBAV_FIND)
#undef LIBAV_FIND
    if (missing != 0)
        return error_text_set(
            error,
            "no video: " LIBRARY(
                avformat,
                LIBAVFORMAT_VERSION_MAJOR) "%s; on Debian "
                                           "and Ubuntu: apt-get install libavformat" AV_STRINGIFY(
                                               LIBAVFORMAT_VERSION_MAJOR),
            avformat != NULL ? ", or one of its kin, lacks a function" : " is not installed");
    libav.av_log_set_level(AV_LOG_QUIET); /* errors are reported by the caller */
    return 0;
}
