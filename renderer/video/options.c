/* Reads the command line: its own options and the renderer's. */
#include "renderer/video/options.h"

#include "ipc/process/log.h"

static struct video_options given;

static const struct option_row rows[] = {
    {"from", "FRAME", "the first frame (default: that of the run)", .u64 = &given.from,
     .most = UINT64_MAX / 2},
    {"frames", "N", "the number of frames (default: to the run's end)", .u64 = &given.frames,
     .least = 1, .most = UINT64_MAX / 2},
    OPTION_ROWS_END};

struct video_options video_options_read(int argc, char **argv)
{
    static const struct option_table table = {
        .program = "jolon-video",
        .usage =
            "[options] LOG FILE\n"
            "Replays a recorded run (LOG: commands.log of its --out) and makes a video of it. FILE "
            "ends in\n"
            ".mkv, .mp4 or .webm. A second of video is a second of simulation. A FILE that ends in "
            ".png\n"
            "gets only the last picture.",
        .rows = rows,
        .ending =
            "  --fps F                pictures a second (default: one for each frame, at most\n"
            "                         60); a picture may lie between two frames\n"
            "  --threads N            for the simulation (default 1) and for the own rasteriser\n"
            "  --view V, --vehicle ID, --size WxH, --eye X,Z,HEIGHT ...\n"
            "                         and the other drawing options of jolon-renderer --help\n",
        .plain = 2};
    if (options_read(&given.renderer, &table, argc, argv) != 2)
        die_usage("LOG and FILE are required; see jolon-video --help");
    if (given.renderer.views.count != 1)
        die_usage("--view: a video shows exactly one view");
    given.log = argv[argc - 2];
    given.file = argv[argc - 1];
    return given;
}
