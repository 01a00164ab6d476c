/* jolon-mover: paces the frames and moves every vehicle and munition. Writes the moved table. */
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/sandbox/sandbox.h"
#include "ipc/segment/segment_attach.h"
#include "mover/step.h"

#include "world/params.h"
#include "world/runtime/work_done.h"

#include <errno.h>
#include <string.h>
#include <sys/prctl.h>

/* Runs frames until the process is asked to stop or the run is over. */
static void move_frames(struct mover *mover, struct view *view)
{
    struct command_source sources[COMMAND_RING_COUNT];
    struct frame_protocol frame;
    while (frame_protocol_mover_begin(&frame, view) == 0) {
        for (int i = 0; i < COMMAND_RING_COUNT; i++)
            sources[i] = (struct command_source){
                view->commands[i]->slot, view->header->command_slots, frame.command_head[i]};
        mover_step(mover, &view->w[(frame.number - 1) & 1], &view->m, sources);
        frame_protocol_mover_end(&frame, view);
    }
}

int main(int argc, char **argv)
{
    struct stage_options options = process_stage_options(argc, argv, "jolon-mover");
    struct sandbox sandbox;
    struct view view;
    struct error_text error;
    struct mover mover;
    log_open("mover");
    process_close_inherited();
    process_signals();
    process_die_with_parent(options.parent);
    prctl(PR_SET_TIMERSLACK, 1000); /* [ns] a frame begins when it is due, not 50 us later */
    if (sandbox_begin(&sandbox, ROLE_MOVER, options.sandbox_off, &error) != 0 ||
        (options.stand_by ? segment_stand_by : segment_attach)(&view, options.world, ROLE_MOVER,
                                                               &error) != 0)
        die_refused("%s", error.text);
    work_done_into(&view.slot[view.role]->work);
    struct thread_pool *workers = thread_pool_create(options.threads);
    if (!workers)
        die_refused("cannot start %u threads: %s", options.threads, strerror(errno));
    if (mover_init(&mover, &view.world, view.w[0].craters, workers) != 0)
        process_refuse_memory(view.world.params->capacity);
    if (sandbox_enter(&sandbox, &error) != 0)
        die_refused("%s", error.text);
    /* A stand-by process may be asked to stop, or the run may end, before it gets the role. */
    if (segment_take(&view) == 0 && !(options.stand_by && frame_protocol_finished(&view))) {
        segment_ready(&view);
        log_info("moves world \"%s\" on %u thread(s)", view.name, options.threads);
        move_frames(&mover, &view);
    }
    mover_free(&mover);
    thread_pool_destroy(workers);
    segment_detach(&view);
    return EXIT_OK;
}
