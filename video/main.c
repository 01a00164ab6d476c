/* jolon-video: makes a video of a recorded run. In this one process the run is played again, frame
 * by frame, and each picture drawn at its time, as fast as that goes; another thread encodes. */
#include "ipc/log.h"
#include "ipc/process.h"
#include "video/film.h"

int main(int argc, char **argv)
{
    static struct film film;
    log_open("video");
    film.options = video_options_read(argc, argv);
    process_signals();
    return film_make(&film) == TAPE_WRONG ? EXIT_REFUSED : EXIT_OK;
}
