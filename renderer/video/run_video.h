/* Makes a video of a recorded run, or a still picture of its end: the run is replayed frame by
 * frame as fast as possible, and each picture is drawn at its time. The same log gives the same
 * pictures. */
#ifndef JOLON_RENDERER_VIDEO_RUN_VIDEO_H
#define JOLON_RENDERER_VIDEO_RUN_VIDEO_H

#include "renderer/heartbeat.h"
#include "renderer/render_session.h"
#include "recorder/replay/log_replay.h"
#include "renderer/video/options.h"

#define RUN_VIDEO_PATH_BYTES 4096

struct run_video {
    struct video_options options;
    struct log_replay replay;
    struct view view;
    struct frame_stepper stepper;
    struct heartbeat heartbeat; /* no other process reads it */
    struct output_set outputs;
    struct render_session session;
    bool still;          /* only the last picture, as a PNG file */
    uint64_t first, end; /* frames first .. end - 1 */
    bool between;        /* pictures may lie between two frames */
    uint64_t pictures, begun_ns, reported_ns;
    char path[RUN_VIDEO_PATH_BYTES]; /* of the temporary file */
    int fd;
};

/* Makes the video that video->options describe; all other members must be zero. Ends the process on
 * failure. */
enum log_replay_step run_video_make(struct run_video *video);

#endif
