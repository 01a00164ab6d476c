/* jolon-collider: finds and resolves the collisions of each frame and commits the frame. Writes
 * both world buffers, the craters and the event ring. */
#include "collider/step.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/stage/stage.h"
#include "world/runtime/reserve.h"

#include <inttypes.h>

/* Logs the arrays that grew during the frame beyond the memory that was reserved for them. */
static void log_growth(uint64_t *logged)
{
    uint64_t growths = reserve_growths();
    if (growths == *logged)
        return;
    log_info("%" PRIu64 " array(s) of a step had to grow beyond what is set aside: "
             "this frame took longer for it",
             growths - *logged);
    *logged = growths;
}

/* Runs frames until the process is asked to stop or the run is over. */
static void collide_frames(struct collider *collider, struct view *view)
{
    const struct event_ring ring = {view->events, view->header->event_slots};
    struct frame_protocol frame;
    uint64_t logged = 0;
    while (frame_protocol_collider_begin(&frame, view) == 0) {
        collider_step(collider, &view->w[(frame.number - 1) & 1], &view->m,
                      &view->w[frame.number & 1], &ring);
        frame_protocol_collider_end(&frame, view);
        log_growth(&logged);
    }
}

int main(int argc, char **argv)
{
    struct stage stage;
    struct view *view = &stage.view;
    struct collider collider;
    stage_open(&stage, argc, argv, ROLE_COLLIDER);
    if (collider_init(&collider, &view->world, view->w[0].craters, stage.workers) != 0)
        stage_refuse_memory(&stage);
    collider_touch(&collider, &view->m, view->w, stage_rows(view));
    if (stage_enter(&stage)) {
        log_info("collides world \"%s\" on %u thread(s)", view->name, stage.options.threads);
        collide_frames(&collider, view);
    }
    collider_free(&collider);
    stage_close(&stage);
    return EXIT_OK;
}
