/* jolon-video: makes a video of a recorded run. One process replays the run frame by frame as fast
 * as possible and draws each picture at its time. Another thread encodes. */
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "renderer/video/run_video.h"

int main(int argc, char **argv)
{
    static struct run_video video;
    log_open("video");
    video.options = video_options_read(argc, argv);
    process_signals();
    return run_video_make(&video) == LOG_REPLAY_MISMATCH ? EXIT_REFUSED : EXIT_OK;
}
