/* Playing a recorded run again and drawing its pictures. */
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

#define LOOK_S      0.5 /* of simulation, between two looks at what is not drawn */
#define PROGRESS_NS NS_PER_S
#define WHOLE       1e-6 /* of a frame: so little is nothing */

static void open_run(struct run_video *film)
{
    const struct video_options *options = &film->options;
    run_start_open(&film->tape, options->log);
    if (options->from > film->tape.known_frame)
        die_usage("--from %" PRIu64 ": %s is known to frame %" PRIu64, options->from, options->log,
                  film->tape.known_frame);
    run_start_make(&film->view, &film->tape);
    uint32_t threads = options->renderer.threads > 0 ? options->renderer.threads : 1;
    if (frame_stepper_init(&film->player, &film->view, threads) != 0)
        die_refused("cannot start %u threads: %s", threads, strerror(errno));
    uint64_t start = frame_stepper_frame(&film->player);
    film->first = options->from > start ? options->from : start;
    film->end = film->tape.known_frame + 1;
    if (options->frames > 0 && options->frames < film->end - film->first)
        film->end = film->first + options->frames;
    if (film->still)
        film->first = film->end - 1;
}

/* The video appears under its name when it is complete. */
static void open_file(struct run_video *film)
{
    int length =
        snprintf(film->path, sizeof film->path, "%s.%ld.tmp", film->options.file, (long)getpid());
    if (length < 0 || (size_t)length >= sizeof film->path)
        die_refused("%s: the path is too long", film->options.file);
    film->fd = open(film->path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (film->fd < 0)
        die_refused("%s: cannot make the file: %s", film->options.file, strerror(errno));
}

_Noreturn static void give_up(const struct run_video *film, struct error_text *error)
{
    if (!film->still)
        unlink(film->path);
    die_refused("%s", error->text);
}

static void open_session(struct run_video *film)
{
    struct error_text error;
    struct options *drawn = &film->options.renderer;
    drawn->hold = 0; /* nobody waits */
    double hz = 1.0 / world_dt_s(&film->view.world);
    if (drawn->fps <= 0.0)
        drawn->fps = hz < VIDEO_FPS_MAX ? hz : VIDEO_FPS_MAX;
    const struct output_set_options wish = {.world = film->view.name,
                                            .video = film->options.file,
                                            .video_fps = drawn->fps,
                                            .replay = true,
                                            .video_fd = film->fd,
                                            .stream_port = -1};
    drawn->snap = film->still ? film->options.file : NULL;
    if (!film->still && (output_set_open(&film->outputs, &wish, &error) != 0 ||
                         output_set_start(&film->outputs, &error) != 0))
        give_up(film, &error);
    if (render_session_open(&film->session, &film->view, &film->heartbeat,
                            film->still ? NULL : &film->outputs, drawn, &error) != 0)
        give_up(film, &error);
}

/* Plays on to a frame, looking at the world now and then: what burns and what left tracks is to be
 * known. False when the run is over, or not as it was recorded. */
static bool play_to(struct run_video *film, uint64_t frame, enum log_replay_step *step)
{
    struct error_text error;
    uint64_t looks = (uint64_t)(LOOK_S / world_dt_s(&film->view.world)) + 1;
    while (frame_stepper_frame(&film->player) < frame && !process_stopping()) {
        *step = log_replay_step(&film->tape, &film->player, &error);
        if (*step == LOG_REPLAY_MISMATCH)
            log_warn("%s", error.text);
        if (*step != LOG_REPLAY_STEPPED)
            return false;
        if (frame_stepper_frame(&film->player) % looks == 0 &&
            render_session_update(&film->session, &error) != 0)
            give_up(film, &error);
    }
    return !process_stopping();
}

static void tell_progress(struct run_video *film)
{
    uint64_t now_ns = clock_now_ns();
    if (!isatty(STDERR_FILENO) || now_ns - film->told_ns < PROGRESS_NS)
        return;
    film->told_ns = now_ns;
    fprintf(stderr, "\rframe %" PRIu64 " of %" PRIu64 ", %.1f pictures a second ",
            frame_stepper_frame(&film->player), film->end - 1,
            (double)film->pictures * 1e9 / (double)(now_ns - film->begun_ns));
}

/* Plays to a frame and looks at it and at the one before, between which the picture may be. */
static bool go_to(struct run_video *film, uint64_t frame, enum log_replay_step *step)
{
    struct error_text error;
    if (frame > film->first && frame_stepper_frame(&film->player) < frame) {
        if (!play_to(film, frame - 1, step))
            return false;
        if (film->between && render_session_update(&film->session, &error) != 0)
            give_up(film, &error);
    }
    if (!play_to(film, frame, step))
        return false;
    if (render_session_update(&film->session, &error) != 0)
        give_up(film, &error);
    return true;
}

/* So many frames before the one looked at last, less than 1. */
static void show_before(struct run_video *film, double frames)
{
    struct frame_view latest = render_session_frame_view(&film->session, film->session.latest);
    film->session.at_s = frame_view_time_s(&latest) - frames * world_dt_s(&film->view.world);
}

/* Every picture at its time. */
static enum log_replay_step shoot(struct run_video *film)
{
    struct error_text error;
    enum log_replay_step step = LOG_REPLAY_STEPPED;
    double frames = 1.0 / (film->session.options.fps * world_dt_s(&film->view.world));
    film->between = fabs(frames - round(frames)) > WHOLE;
    film->session.smooth = film->between;
    film->begun_ns = film->told_ns = clock_now_ns();
    for (;;) {
        double after = (double)film->pictures * frames;
        uint64_t due = film->first + (uint64_t)ceil(after - WHOLE);
        if (due >= film->end || !go_to(film, due, &step))
            break;
        show_before(film, (double)(due - film->first) - after);
        if (view_pictures_draw(&film->session, false, &error) != 0)
            give_up(film, &error);
        film->pictures++;
        tell_progress(film);
    }
    if (film->told_ns != film->begun_ns)
        fputs("\r\033[K", stderr);
    return step;
}

static void complete(struct run_video *film)
{
    struct error_text error;
    if (!film->still && output_set_close(&film->outputs, &error) != 0)
        give_up(film, &error);
    if (film->pictures == 0) {
        error_text_set(&error, "%s: the run ended before its first picture", film->options.file);
        give_up(film, &error);
    }
    if (!film->still && (close(film->fd) != 0 || rename(film->path, film->options.file) != 0)) {
        error_text_set(&error, "%s: cannot complete the file: %s", film->options.file,
                       strerror(errno));
        give_up(film, &error);
    }
    const struct options *drawn = &film->session.options;
    printf("%s: %" PRIu64 " pictures of %ux%u, %.1f s of simulation, made in %.1f s\n",
           film->options.file, film->pictures, drawn->width, drawn->height,
           (double)film->pictures / drawn->fps, (double)(clock_now_ns() - film->begun_ns) / 1e9);
}

enum log_replay_step run_video_make(struct run_video *film)
{
    const char *dot = strrchr(film->options.file, '.');
    film->still = dot != NULL && strcmp(dot, ".png") == 0;
    open_run(film);
    if (!film->still)
        open_file(film);
    open_session(film);
    enum log_replay_step step = shoot(film);
    complete(film);
    render_session_close(&film->session);
    frame_stepper_free(&film->player);
    segment_abandon(&film->view);
    log_replay_close(&film->tape);
    return step;
}
