/* A film of a recorded run, or its last picture: the run is played again, frame by frame, and each
 * picture drawn at its time, as fast as that goes. The same log gives the same pictures. */
#ifndef JOLON_RENDERER_VIDEO_RUN_VIDEO_H
#define JOLON_RENDERER_VIDEO_RUN_VIDEO_H

#include "renderer/heartbeat.h"
#include "renderer/render_session.h"
#include "recorder/replay/log_replay.h"
#include "renderer/video/options.h"

#define RUN_VIDEO_PATH_BYTES 4096

struct run_video {
    struct video_options options;
    struct log_replay tape;
    struct view view;
    struct frame_stepper player;
    struct heartbeat heartbeat; /* nobody waits for its beat */
    struct output_set outputs;
    struct render_session session;
    bool still;          /* the last picture alone, as a PNG file */
    uint64_t first, end; /* frames: from the first, and this one no more */
    bool between;        /* pictures show what is between frames too */
    uint64_t pictures, begun_ns, told_ns;
    char path[RUN_VIDEO_PATH_BYTES]; /* of the file while it is made */
    int fd;
};

/* Makes what film->options say, all else zero; ends the process when it cannot. */
enum log_replay_step run_video_make(struct run_video *film);

#endif
