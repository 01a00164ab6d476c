/* Images, logs and worlds as frames to be compared. */
#include "supervisor/worldctl/frame_source.h"

#include "ipc/segment/segment_attach.h"
#include "recorder/archive/image_read.h"
#include "ipc/process/log.h"
#include "recorder/replay/arguments.h"
#include "recorder/replay/run_start.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

static void start_player(struct frame_source *side)
{
    if (frame_stepper_init(&side->player, &side->view, side->threads) != 0)
        die_refused("cannot start %u threads: %s", side->threads, strerror(errno));
}

static void open_image(struct frame_source *side)
{
    static struct image image;
    struct reason reason;
    if (image_open(&image, side->name, &reason) != 0)
        die_refused("%s", reason.text);
    struct segment_header header = image_segment(&image);
    if (segment_private(&side->view, &header, &reason) != 0 ||
        image_load(&side->view, &image, &reason) != 0)
        die_refused("%s", reason.text);
    image_close(&image);
    start_player(side);
}

void frame_source_open(struct frame_source *side, const char *name, uint32_t threads)
{
    struct stat status;
    *side = (struct frame_source){.name = name, .threads = threads};
    if (stat(name, &status) != 0 && !strchr(name, '/')) {
        const struct arguments arguments = {.world = name};
        side->kind = FRAME_SOURCE_WORLD;
        arguments_snapshot(&arguments, &side->view, &side->snapshot);
    } else if (log_replay_is_one(name)) {
        side->kind = FRAME_SOURCE_LOG;
        run_start_tape(&side->tape, name);
        run_start_world(&side->view, &side->tape);
        start_player(side);
    } else {
        side->kind = FRAME_SOURCE_IMAGE;
        open_image(side);
    }
}

void frame_source_close(struct frame_source *side)
{
    if (side->kind == FRAME_SOURCE_WORLD) {
        snapshot_free(&side->snapshot);
        segment_detach(&side->view);
        return;
    }
    frame_stepper_free(&side->player);
    segment_abandon(&side->view);
    if (side->kind == FRAME_SOURCE_LOG)
        log_replay_close(&side->tape);
}

struct compared frame_source_frame(const struct frame_source *side)
{
    if (side->kind == FRAME_SOURCE_WORLD)
        return (struct compared){&side->view.world, snapshot_state(&side->snapshot, &side->view)};
    return (struct compared){&side->view.world,
                             side->view.w[frame_stepper_frame(&side->player) & 1]};
}

uint64_t frame_source_number(const struct frame_source *side)
{
    return side->kind == FRAME_SOURCE_WORLD ? side->snapshot.head.frame
                                            : frame_stepper_frame(&side->player);
}

bool frame_source_known(const struct frame_source *side)
{
    return side->kind == FRAME_SOURCE_LOG && frame_source_number(side) < side->tape.known_frame;
}

bool frame_source_step(struct frame_source *side)
{
    struct reason reason;
    if (side->kind == FRAME_SOURCE_IMAGE) {
        frame_stepper_step(&side->player, NULL);
        return true;
    }
    enum log_replay_step step = log_replay_step(&side->tape, &side->player, &reason);
    if (step == LOG_REPLAY_WRONG)
        die_refused("%s", reason.text);
    return step == LOG_REPLAY_STEPPED;
}
