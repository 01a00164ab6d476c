/* Reads the command line: its own options and the renderer's. */
#include "renderer/video/options.h"

#include "ipc/process/log.h"

static struct video_options given;

static const struct option_row rows[] = {
    {"from", "FRAME", "the first frame of it (default: the run's)", .u64 = &given.from,
     .most = UINT64_MAX / 2},
    {"frames", "N", "so many frames of the run (default: to its end)", .u64 = &given.frames,
     .least = 1, .most = UINT64_MAX / 2},
    OPTION_ROWS_END};

struct video_options video_options_read(int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-video",
        .usage =
            "[options] LOG FILE\n"
            "Plays a recorded run again (LOG: commands.log of its --out) and makes a video of it: "
            "FILE ends\n"
            "in .mkv, .mp4 or .webm. A second of it is a second of simulation. A FILE in .png is "
            "its last\n"
            "picture alone.",
        .rows = rows,
        .ending =
            "  --fps F                pictures a second (default: one for each frame, at most\n"
            "                         60); where that is not so many frames each, they show\n"
            "                         what is between two\n"
            "  --threads N            of the simulation (default 1) and of the own rasteriser\n"
            "  --view V, --vehicle ID, --size WxH, --eye X,Z,HEIGHT ...\n"
            "                         and all else that jolon-renderer --help says of drawing\n",
        .plain = 2};
    if (options_read(&given.renderer, &table, argc, argv) != 2)
        die_usage("wants a LOG and a FILE; see jolon-video --help");
    if (given.renderer.views.count != 1)
        die_usage("--view: a video is of one view");
    given.log = argv[argc - 2];
    given.file = argv[argc - 1];
    return given;
}
