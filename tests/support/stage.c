/* Runs mover and collider as children of a test. */
#include "tests/support/stage.h"

#include "collider/step.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/process.h"
#include "mover/step.h"
#include "tests/support/child.h"

#include <fcntl.h>
#include <unistd.h>

struct stage {
    struct view view;
    bool quiet;
};

static int run_mover(struct view *view)
{
    struct command_source sources[COMMAND_RING_COUNT];
    struct mover mover;
    struct frame_protocol frame;
    if (mover_init(&mover, &view->world, view->w[0].craters, NULL) != 0)
        return 99;
    while (frame_protocol_mover_begin(&frame, view) == 0) {
        for (int i = 0; i < COMMAND_RING_COUNT; i++)
            sources[i] = (struct command_source){
                view->commands[i]->slot, layout_ring_slots(view->header, i), frame.command_head[i]};
        mover_step(&mover, &view->w[(frame.number - 1) & 1], &view->m, sources);
        frame_protocol_mover_end(&frame, view);
    }
    mover_free(&mover);
    return 0;
}

static int run_collider(struct view *view)
{
    const struct event_ring ring = {view->events, view->header->event_slots};
    struct collider collider;
    struct frame_protocol frame;
    if (collider_init(&collider, &view->world, view->w[0].craters, NULL) != 0)
        return 99;
    while (frame_protocol_collider_begin(&frame, view) == 0) {
        collider_step(&collider, &view->w[(frame.number - 1) & 1], &view->m,
                      &view->w[frame.number & 1], &ring);
        frame_protocol_collider_end(&frame, view);
    }
    collider_free(&collider);
    return 0;
}

static int run(void *context)
{
    struct stage *stage = context;
    if (stage->quiet)
        dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
    process_signals();
    return stage->view.role == ROLE_MOVER ? run_mover(&stage->view) : run_collider(&stage->view);
}

pid_t stage_start(const struct view *view, enum role role, bool quiet)
{
    struct stage stage = {*view, quiet}; /* fork() copies it to the child */
    stage.view.role = role;
    return child_start(run, &stage);
}
