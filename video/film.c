/* Playing a recorded run again and drawing its pictures. */
#include "video/film.h"

#include "ipc/clock.h"
#include "ipc/log.h"
#include "ipc/process.h"
#include "renderer/pulse.h"
#include "renderer/studio.h"
#include "replay/tape.h"
#include "worldctl/remake.h"

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

static void open_run(struct film *film)
{
    const struct video_options *options = &film->options;
    remake_tape(&film->tape, options->log);
    if (options->from > film->tape.known_frame)
        die_usage("--from %" PRIu64 ": %s is known to frame %" PRIu64, options->from, options->log,
                  film->tape.known_frame);
    remake_world(&film->view, &film->tape);
    uint32_t threads = options->renderer.threads > 0 ? options->renderer.threads : 1;
    if (player_init(&film->player, &film->view, threads) != 0)
        die_refused("cannot start %u threads: %s", threads, strerror(errno));
    uint64_t start = player_frame(&film->player);
    film->first = options->from > start ? options->from : start;
    film->end = film->tape.known_frame + 1;
    if (options->frames > 0 && options->frames < film->end - film->first)
        film->end = film->first + options->frames;
    if (film->still)
        film->first = film->end - 1;
}

/* The video appears under its name when it is complete. */
static void open_file(struct film *film)
{
    int length =
        snprintf(film->path, sizeof film->path, "%s.%ld.tmp", film->options.file, (long)getpid());
    if (length < 0 || (size_t)length >= sizeof film->path)
        die_refused("%s: the path is too long", film->options.file);
    film->fd = open(film->path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (film->fd < 0)
        die_refused("%s: cannot make the file: %s", film->options.file, strerror(errno));
}

_Noreturn static void give_up(const struct film *film, const struct reason *reason)
{
    if (!film->still)
        unlink(film->path);
    die_refused("%s", reason->text);
}

static void open_studio(struct film *film)
{
    struct reason reason;
    struct options *drawn = &film->options.renderer;
    drawn->hold = 0; /* nobody waits */
    double hz = 1.0 / film->view.world.params->dt_s;
    if (drawn->fps <= 0.0)
        drawn->fps = hz < VIDEO_FPS_MAX ? hz : VIDEO_FPS_MAX;
    const struct outlets_wish wish = {.world = film->view.name,
                                      .video = film->options.file,
                                      .video_fps = drawn->fps,
                                      .replay = true,
                                      .video_fd = film->fd,
                                      .stream_port = -1};
    drawn->snap = film->still ? film->options.file : NULL;
    if (!film->still && (outlets_open(&film->outlets, &wish, &reason) != 0 ||
                         outlets_start(&film->outlets, &reason) != 0))
        give_up(film, &reason);
    if (studio_open(&film->studio, &film->view, &film->pulse, film->still ? NULL : &film->outlets,
                    drawn, &reason) != 0)
        give_up(film, &reason);
}

/* Plays on to a frame, looking at the world now and then: what burns and what left tracks is to be
 * known. False when the run is over, or not as it was recorded. */
static bool play_to(struct film *film, uint64_t frame, enum tape_step *step)
{
    struct reason reason;
    uint64_t looks = (uint64_t)(LOOK_S / film->view.world.params->dt_s) + 1;
    while (player_frame(&film->player) < frame && !process_stopping()) {
        *step = tape_step(&film->tape, &film->player, &reason);
        if (*step == TAPE_WRONG)
            log_warn("%s", reason.text);
        if (*step != TAPE_STEPPED)
            return false;
        if (player_frame(&film->player) % looks == 0 && studio_look(&film->studio, &reason) != 0)
            give_up(film, &reason);
    }
    return !process_stopping();
}

static void tell_progress(struct film *film)
{
    uint64_t now_ns = clock_now_ns();
    if (!isatty(STDERR_FILENO) || now_ns - film->told_ns < PROGRESS_NS)
        return;
    film->told_ns = now_ns;
    fprintf(stderr, "\rframe %" PRIu64 " of %" PRIu64 ", %.1f pictures a second ",
            player_frame(&film->player), film->end - 1,
            (double)film->pictures * 1e9 / (double)(now_ns - film->begun_ns));
}

/* Plays to a frame and looks at it and at the one before, between which the picture may be. */
static bool go_to(struct film *film, uint64_t frame, enum tape_step *step)
{
    struct reason reason;
    if (frame > film->first && player_frame(&film->player) < frame) {
        if (!play_to(film, frame - 1, step))
            return false;
        if (film->between && studio_look(&film->studio, &reason) != 0)
            give_up(film, &reason);
    }
    if (!play_to(film, frame, step))
        return false;
    if (studio_look(&film->studio, &reason) != 0)
        give_up(film, &reason);
    return true;
}

/* So many frames before the one looked at last, less than 1. */
static void show_before(struct film *film, double frames)
{
    struct moment latest = studio_moment(&film->studio, film->studio.latest);
    film->studio.at_s = moment_time_s(&latest) - frames * film->view.world.params->dt_s;
}

/* Every picture at its time. */
static enum tape_step shoot(struct film *film)
{
    struct reason reason;
    enum tape_step step = TAPE_STEPPED;
    double frames = 1.0 / (film->studio.options.fps * film->view.world.params->dt_s);
    film->between = fabs(frames - round(frames)) > WHOLE;
    film->studio.smooth = film->between;
    film->begun_ns = film->told_ns = clock_now_ns();
    for (;;) {
        double after = (double)film->pictures * frames;
        uint64_t due = film->first + (uint64_t)ceil(after - WHOLE);
        if (due >= film->end || !go_to(film, due, &step))
            break;
        show_before(film, (double)(due - film->first) - after);
        if (studio_draw(&film->studio, false, &reason) != 0)
            give_up(film, &reason);
        film->pictures++;
        tell_progress(film);
    }
    if (film->told_ns != film->begun_ns)
        fputs("\r\033[K", stderr);
    return step;
}

static void complete(struct film *film)
{
    struct reason reason;
    if (!film->still && outlets_close(&film->outlets, &reason) != 0)
        give_up(film, &reason);
    if (film->pictures == 0) {
        reason_set(&reason, "%s: the run ended before its first picture", film->options.file);
        give_up(film, &reason);
    }
    if (!film->still && (close(film->fd) != 0 || rename(film->path, film->options.file) != 0)) {
        reason_set(&reason, "%s: cannot complete the file: %s", film->options.file,
                   strerror(errno));
        give_up(film, &reason);
    }
    const struct options *drawn = &film->studio.options;
    printf("%s: %" PRIu64 " pictures of %ux%u, %.1f s of simulation, made in %.1f s\n",
           film->options.file, film->pictures, drawn->width, drawn->height,
           (double)film->pictures / drawn->fps, (double)(clock_now_ns() - film->begun_ns) / 1e9);
}

enum tape_step film_make(struct film *film)
{
    const char *dot = strrchr(film->options.file, '.');
    film->still = dot != NULL && strcmp(dot, ".png") == 0;
    open_run(film);
    if (!film->still)
        open_file(film);
    open_studio(film);
    enum tape_step step = shoot(film);
    complete(film);
    studio_close(&film->studio);
    player_free(&film->player);
    segment_abandon(&film->view);
    tape_close(&film->tape);
    return step;
}
