/* jolon-video's command line. */
#ifndef JOLON_RENDERER_VIDEO_OPTIONS_H
#define JOLON_RENDERER_VIDEO_OPTIONS_H

#include "renderer/options.h"

#include <stdint.h>

#define VIDEO_FPS_MAX 60.0 /* default: this, or the simulation's frame rate if that is lower */

struct video_options {
    struct options renderer; /* how pictures are drawn */
    const char *log, *file;
    uint64_t from, frames; /* frames 0: to the end */
};

/* Ends the process on wrong usage (exit 2) and on --help (exit 0). */
struct video_options video_options_read(int argc, char **argv);

#endif
