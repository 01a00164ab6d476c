/* jolon-video: makes a video of a recorded run. In this one process the run is played again, frame
 * by frame, and each picture drawn at its time, as fast as that goes; another thread encodes. */
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "renderer/video/run_video.h"

int main(int argc, char **argv)
{
    static struct run_video film;
    log_open("video");
    film.options = video_options_read(argc, argv);
    process_signals();
    return run_video_make(&film) == LOG_REPLAY_MISMATCH ? EXIT_REFUSED : EXIT_OK;
}
