/* Verb replay-frame: computes the frame after an image's in this process and on one thread, so that
 * a debugger can catch the crash of a role. */
#include "supervisor/worldctl/verbs.h"

#include "ipc/process/log.h"
#include "recorder/replay/frame_stepper.h"
#include "recorder/replay/arguments.h"
#include "recorder/replay/image_resume.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>

/* Gives the memory the protection that the role had, so that a stray store crashes here as it
 * crashed there. */
static void protect(const struct view *view, enum role role)
{
    const struct layout *layout = &view->layout;
    for (int i = 0; i < REGION_COUNT; i++) {
        size_t end = i + 1 < REGION_COUNT ? layout->offset[i + 1] : layout->total;
        int writable = layout_writable(role, (enum region)i) ? PROT_WRITE : 0;
        if (end > layout->offset[i] && mprotect((unsigned char *)view->base + layout->offset[i],
                                                end - layout->offset[i], PROT_READ | writable) != 0)
            die_refused("cannot protect the world's memory: %s", strerror(errno));
    }
}

static void run(struct frame_stepper *stepper, bool moved)
{
    struct view *view = stepper->view;
    uint64_t frame = frame_stepper_frame(stepper) + 1;
    log_frame(frame);
    if (moved) {
        log_info("frame %" PRIu64 ": was moved already", frame);
    } else {
        log_info("frame %" PRIu64 ": moves", frame);
        protect(view, ROLE_MOVER);
        frame_stepper_move(stepper, NULL);
    }
    log_info("frame %" PRIu64 ": collides", frame);
    protect(view, ROLE_COLLIDER);
    frame_stepper_collide(stepper);
}

int verb_replay_frame(const struct arguments *arguments)
{
    static struct image image;
    struct view view;
    struct frame_stepper stepper;
    if (!arguments->path)
        die_usage("replay-frame: needs the DUMP to run, as `save --inputs` or a set that gave up "
                  "wrote it");
    image_resume_private(&view, &image, arguments->path);
    if (frame_stepper_init(&stepper, &view, 1) != 0)
        die_refused("out of memory to run a frame");
    bool moved = atomic_load(&view.moved_word->moved) == image.header.frame + 1;
    run(&stepper, moved);
    const struct state *state = &view.w[frame_stepper_frame(&stepper) & 1];
    printf("frame %" PRIu64 ": %s, digest %016" PRIx64 ", %" PRIu64 " events, %u entities\n",
           state->head->frame, moved ? "collided" : "moved and collided",
           state_digest(&view.world, state), state->head->event_end - image.header.event_end,
           state->head->vehicles + state->head->munitions);
    frame_stepper_free(&stepper);
    segment_abandon(&view);
    image_close(&image);
    return EXIT_OK;
}
