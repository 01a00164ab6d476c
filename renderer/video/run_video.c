/* Replaying a recorded run and drawing its pictures. */
#include "renderer/video/run_video.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "renderer/heartbeat.h"
#include "renderer/render_session.h"
#include "recorder/replay/log_replay.h"
#include "recorder/replay/run_start.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define UPDATE_S        0.5 /* [s of simulation] between updates of the effects without a picture */
#define PROGRESS_NS     NS_PER_S
#define FRAME_TOLERANCE 1e-6 /* of a frame: a smaller difference is ignored */

static void open_run(struct run_video *video)
{
    const struct video_options *options = &video->options;
    run_start_open(&video->replay, options->log);
    if (options->from > video->replay.known_frame)
        die_usage("--from %" PRIu64 ": %s is known to frame %" PRIu64, options->from, options->log,
                  video->replay.known_frame);
    run_start_make(&video->view, &video->replay);
    uint32_t threads = options->renderer.threads > 0 ? options->renderer.threads : 1;
    if (frame_stepper_init(&video->stepper, &video->view, threads) != 0)
        die_refused("cannot start %u threads: %s", threads, strerror(errno));
    uint64_t start = frame_stepper_frame(&video->stepper);
    video->first = options->from > start ? options->from : start;
    video->end = video->replay.known_frame + 1;
    if (options->frames > 0 && options->frames < video->end - video->first)
        video->end = video->first + options->frames;
    if (video->still)
        video->first = video->end - 1;
}

/* The file gets its name when it is complete. */
static void open_file(struct run_video *video)
{
    int length = snprintf(video->path, sizeof video->path, "%s.%ld.tmp", video->options.file,
                          (long)getpid());
    if (length < 0 || (size_t)length >= sizeof video->path)
        die_refused("%s: the path is too long", video->options.file);
    video->fd = open(video->path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (video->fd < 0)
        die_refused("%s: cannot make the file: %s", video->options.file, strerror(errno));
}

_Noreturn static void fail(const struct run_video *video, struct error_text *error)
{
    if (!video->still)
        unlink(video->path);
    die_refused("%s", error->text);
}

static void open_session(struct run_video *video)
{
    struct error_text error;
    struct options *drawn = &video->options.renderer;
    drawn->hold = 0; /* no user waits for a frame */
    double hz = 1.0 / world_dt_s(&video->view.world);
    if (drawn->fps <= 0.0)
        drawn->fps = hz < VIDEO_FPS_MAX ? hz : VIDEO_FPS_MAX;
    const struct output_set_options options = {.world = video->view.name,
                                               .video = video->options.file,
                                               .video_fps = drawn->fps,
                                               .replay = true,
                                               .video_fd = video->fd,
                                               .stream_port = -1};
    drawn->snap = video->still ? video->options.file : NULL;
    if (!video->still && (output_set_open(&video->outputs, &options, &error) != 0 ||
                          output_set_start(&video->outputs, &error) != 0))
        fail(video, &error);
    if (render_session_open(&video->session, &video->view, &video->heartbeat,
                            video->still ? NULL : &video->outputs, drawn, &error) != 0)
        fail(video, &error);
}

/* Replays up to a frame and updates the effects now and then, since fires and tracks depend on
 * earlier frames. Returns false at the end of the run, or when the run differs from the
 * recording. */
static bool replay_to(struct run_video *video, uint64_t frame, enum log_replay_step *step)
{
    struct error_text error;
    uint64_t update_frames = (uint64_t)(UPDATE_S / world_dt_s(&video->view.world)) + 1;
    while (frame_stepper_frame(&video->stepper) < frame && !process_stopping()) {
        *step = log_replay_step(&video->replay, &video->stepper, &error);
        if (*step == LOG_REPLAY_MISMATCH)
            log_warn("%s", error.text);
        if (*step != LOG_REPLAY_STEPPED)
            return false;
        if (frame_stepper_frame(&video->stepper) % update_frames == 0 &&
            render_session_update(&video->session, &error) != 0)
            fail(video, &error);
    }
    return !process_stopping();
}

static void report_progress(struct run_video *video)
{
    uint64_t now_ns = clock_now_ns();
    if (!isatty(STDERR_FILENO) || now_ns - video->reported_ns < PROGRESS_NS)
        return;
    video->reported_ns = now_ns;
    fprintf(stderr, "\rframe %" PRIu64 " of %" PRIu64 ", %.1f pictures a second ",
            frame_stepper_frame(&video->stepper), video->end - 1,
            (double)video->pictures * 1e9 / (double)(now_ns - video->begun_ns));
}

/* Replays up to a frame and reads that frame and the one before, between which the picture may
 * lie. */
static bool replay_with_previous(struct run_video *video, uint64_t frame,
                                 enum log_replay_step *step)
{
    struct error_text error;
    if (frame > video->first && frame_stepper_frame(&video->stepper) < frame) {
        if (!replay_to(video, frame - 1, step))
            return false;
        if (video->between && render_session_update(&video->session, &error) != 0)
            fail(video, &error);
    }
    if (!replay_to(video, frame, step))
        return false;
    if (render_session_update(&video->session, &error) != 0)
        fail(video, &error);
    return true;
}

/* Sets the picture's time to this many frames before the last frame read, less than 1. */
static void set_time_before(struct run_video *video, double frames)
{
    struct frame_view latest = render_session_frame_view(&video->session, video->session.latest);
    video->session.at_s = frame_view_time_s(&latest) - frames * world_dt_s(&video->view.world);
}

/* Draws every picture at its time. */
static enum log_replay_step draw_pictures(struct run_video *video)
{
    struct error_text error;
    enum log_replay_step step = LOG_REPLAY_STEPPED;
    double frames = 1.0 / (video->session.options.fps * world_dt_s(&video->view.world));
    video->between = fabs(frames - round(frames)) > FRAME_TOLERANCE;
    video->session.smooth = video->between;
    video->begun_ns = video->reported_ns = clock_now_ns();
    for (;;) {
        double after = (double)video->pictures * frames;
        uint64_t due = video->first + (uint64_t)ceil(after - FRAME_TOLERANCE);
        if (due >= video->end || !replay_with_previous(video, due, &step))
            break;
        set_time_before(video, (double)(due - video->first) - after);
        if (view_pictures_draw(&video->session, false, &error) != 0)
            fail(video, &error);
        video->pictures++;
        report_progress(video);
    }
    if (video->reported_ns != video->begun_ns)
        fputs("\r\033[K", stderr);
    return step;
}

static void complete(struct run_video *video)
{
    struct error_text error;
    if (!video->still && output_set_close(&video->outputs, &error) != 0)
        fail(video, &error);
    if (video->pictures == 0) {
        error_text_set(&error, "%s: the run ended before its first picture", video->options.file);
        fail(video, &error);
    }
    if (!video->still && (close(video->fd) != 0 || rename(video->path, video->options.file) != 0)) {
        error_text_set(&error, "%s: cannot complete the file: %s", video->options.file,
                       strerror(errno));
        fail(video, &error);
    }
    const struct options *drawn = &video->session.options;
    printf("%s: %" PRIu64 " pictures of %ux%u, %.1f s of simulation, made in %.1f s\n",
           video->options.file, video->pictures, drawn->width, drawn->height,
           (double)video->pictures / drawn->fps, (double)(clock_now_ns() - video->begun_ns) / 1e9);
}

enum log_replay_step run_video_make(struct run_video *video)
{
    const char *dot = strrchr(video->options.file, '.');
    video->still = dot != NULL && strcmp(dot, ".png") == 0;
    open_run(video);
    if (!video->still)
        open_file(video);
    open_session(video);
    enum log_replay_step step = draw_pictures(video);
    complete(video);
    render_session_close(&video->session);
    frame_stepper_free(&video->stepper);
    segment_abandon(&video->view);
    log_replay_close(&video->replay);
    return step;
}
