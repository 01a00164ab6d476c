/* jolon-mover: paces the frames and moves every vehicle and munition. Writes the moved table. */
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/stage/stage.h"
#include "mover/step.h"

#include <sys/prctl.h>

/* Runs frames until the process is asked to stop or the run is over. */
static void move_frames(struct mover *mover, struct view *view)
{
    struct command_source sources[COMMAND_RING_COUNT];
    struct frame_protocol frame;
    while (frame_protocol_mover_begin(&frame, view) == 0) {
        for (int i = 0; i < COMMAND_RING_COUNT; i++)
            sources[i] = (struct command_source){
                view->commands[i]->slot, layout_ring_slots(view->header, i), frame.command_head[i]};
        mover_step(mover, &view->w[(frame.number - 1) & 1], &view->m, sources);
        frame_protocol_mover_end(&frame, view);
    }
}

int main(int argc, char **argv)
{
    struct stage stage;
    struct view *view = &stage.view;
    struct mover mover;
    prctl(PR_SET_TIMERSLACK, 1000); /* [ns] a frame begins when it is due, not 50 us later */
    stage_open(&stage, argc, argv, ROLE_MOVER);
    if (mover_init(&mover, &view->world, view->w[0].craters, stage.workers) != 0)
        stage_refuse_memory(&stage);
    mover_touch(&mover, &view->m, view->w, stage_rows(view));
    if (stage_enter(&stage)) {
        log_info("moves world \"%s\" on %u thread(s)", view->name, stage.options.threads);
        move_frames(&mover, view);
    }
    mover_free(&mover);
    stage_close(&stage);
    return EXIT_OK;
}
