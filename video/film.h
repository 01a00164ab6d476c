/* A film of a recorded run, or its last picture: the run is played again, frame by frame, and each
 * picture drawn at its time, as fast as that goes. The same log gives the same pictures. */
#ifndef JOLON_VIDEO_FILM_H
#define JOLON_VIDEO_FILM_H

#include "renderer/pulse.h"
#include "renderer/studio.h"
#include "replay/tape.h"
#include "video/options.h"

#define FILM_PATH_BYTES 4096

struct film {
    struct video_options options;
    struct tape tape;
    struct view view;
    struct player player;
    struct pulse pulse; /* nobody waits for its beat */
    struct outlets outlets;
    struct studio studio;
    bool still;          /* the last picture alone, as a PNG file */
    uint64_t first, end; /* frames: from the first, and this one no more */
    bool between;        /* pictures show what is between frames too */
    uint64_t pictures, begun_ns, told_ns;
    char path[FILM_PATH_BYTES]; /* of the file while it is made */
    int fd;
};

/* Makes what film->options say, all else zero; ends the process when it cannot. */
enum tape_step film_make(struct film *film);

#endif
