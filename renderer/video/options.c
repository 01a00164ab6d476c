/* Reading the command line: a few options of its own; the others are the renderer's. */
#include "renderer/video/options.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ARGUMENTS_MAX 64

static const char usage_text[] =
    "usage: jolon-video [options] LOG FILE\n"
    "Plays a recorded run again (LOG: commands.log of its --out) and makes a video of it: FILE "
    "ends\n"
    "in .mkv, .mp4 or .webm. A second of it is a second of simulation. A FILE in .png is its last\n"
    "picture alone.\n"
    "      --from FRAME    the first frame of it (default: the run's)\n"
    "      --frames N      so many frames of the run (default: to its end)\n"
    "      --fps F         pictures a second (default: one for each frame, at most 60); where "
    "that\n"
    "                      is not so many frames each, they show what is between two\n"
    "      --threads N     of the simulation (default 1) and of the own rasteriser\n"
    "      --view V, --vehicle ID, --size WxH, --eye X,Z,HEIGHT ...\n"
    "                      and all else that jolon-renderer --help says of drawing\n";

/* Takes an option of ours with its value; false when it is none. */
static bool take_own(struct video_options *options, const char *name, const char *value)
{
    if (strcmp(name, "--from") == 0)
        options->from = process_whole("from", value, 0, UINT64_MAX / 2);
    else if (strcmp(name, "--frames") == 0)
        options->frames = process_whole("frames", value, 1, UINT64_MAX / 2);
    else
        return false;
    return true;
}

struct video_options video_options_read(int argc, char **argv)
{
    static char out[] = "--out=.", view[] = "--view=chase";
    struct video_options options = {.frames = 0};
    char *passed[ARGUMENTS_MAX + 4] = {argv[0], out, view};
    int count = 3;
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            fputs(usage_text, stdout);
            exit(EXIT_OK);
        }
    if (argc < 3 || argv[argc - 2][0] == '-' || argv[argc - 1][0] == '-')
        die_usage("wants a LOG and a FILE, at the end; see --help");
    if (argc > ARGUMENTS_MAX)
        die_usage("more than %d arguments", ARGUMENTS_MAX);
    options.log = argv[argc - 2];
    options.file = argv[argc - 1];
    for (int i = 1; i < argc - 2; i++) {
        if (i + 1 < argc - 2 && take_own(&options, argv[i], argv[i + 1]))
            i++;
        else
            passed[count++] = argv[i];
    }
    options_read(&options.renderer, count, passed);
    if (options.renderer.views.count != 1)
        die_usage("--view: a video is of one view");
    return options;
}
