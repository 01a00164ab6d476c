/* Images, command logs and running worlds as sources of frames. */
#include "supervisor/worldctl/frame_source.h"

#include "ipc/segment/segment_attach.h"
#include "ipc/process/log.h"
#include "recorder/replay/arguments.h"
#include "recorder/replay/image_resume.h"
#include "recorder/replay/run_start.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

static void start_stepper(struct frame_source *source)
{
    if (frame_stepper_init(&source->stepper, &source->view, source->threads) != 0)
        die_refused("cannot start %u threads: %s", source->threads, strerror(errno));
}

static void open_image(struct frame_source *source)
{
    static struct image image;
    image_resume_private(&source->view, &image, source->name);
    image_close(&image);
    start_stepper(source);
}

void frame_source_open(struct frame_source *source, const char *name, uint32_t threads)
{
    struct stat status;
    *source = (struct frame_source){.name = name, .threads = threads};
    if (stat(name, &status) != 0 && !strchr(name, '/')) {
        const struct arguments arguments = {.world = name};
        source->kind = FRAME_SOURCE_WORLD;
        arguments_snapshot(&arguments, &source->view, &source->snapshot);
    } else if (log_replay_is_command_log(name)) {
        source->kind = FRAME_SOURCE_LOG;
        run_start_open(&source->replay, name);
        run_start_make(&source->view, &source->replay);
        start_stepper(source);
    } else {
        source->kind = FRAME_SOURCE_IMAGE;
        open_image(source);
    }
}

void frame_source_close(struct frame_source *source)
{
    if (source->kind == FRAME_SOURCE_WORLD) {
        snapshot_free(&source->snapshot);
        segment_detach(&source->view);
        return;
    }
    frame_stepper_free(&source->stepper);
    segment_abandon(&source->view);
    if (source->kind == FRAME_SOURCE_LOG)
        log_replay_close(&source->replay);
}

struct compared frame_source_frame(const struct frame_source *source)
{
    if (source->kind == FRAME_SOURCE_WORLD)
        return (struct compared){&source->view.world,
                                 snapshot_state(&source->snapshot, &source->view)};
    return (struct compared){&source->view.world,
                             source->view.w[frame_stepper_frame(&source->stepper) & 1]};
}

uint64_t frame_source_number(const struct frame_source *source)
{
    return source->kind == FRAME_SOURCE_WORLD ? source->snapshot.head.frame
                                              : frame_stepper_frame(&source->stepper);
}

bool frame_source_known(const struct frame_source *source)
{
    return source->kind == FRAME_SOURCE_LOG &&
           frame_source_number(source) < source->replay.known_frame;
}

bool frame_source_step(struct frame_source *source)
{
    struct error_text error;
    if (source->kind == FRAME_SOURCE_IMAGE) {
        frame_stepper_step(&source->stepper, NULL);
        return true;
    }
    enum log_replay_step step = log_replay_step(&source->replay, &source->stepper, &error);
    if (step == LOG_REPLAY_MISMATCH)
        die_refused("%s", error.text);
    return step == LOG_REPLAY_STEPPED;
}
