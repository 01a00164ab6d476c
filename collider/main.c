/* jolon-collider: finds and answers every collision of a frame and commits it. Writes both world
 * buffers, the craters and the event ring. */
#include "collider/step.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "ipc/sandbox/sandbox.h"
#include "ipc/segment/segment_attach.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/work_done.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

/* Says when the frame has needed more memory than was set aside, which costs it time. */
static void tell_growth(uint64_t *told)
{
    uint64_t growths = reserve_growths();
    if (growths == *told)
        return;
    log_info("%" PRIu64 " array(s) of a step had to grow beyond what is set aside: "
             "this frame took longer for it",
             growths - *told);
    *told = growths;
}

/* The frames, until the process is asked to stop or the run is over. */
static void collide_frames(struct collider *collider, struct view *view)
{
    const struct event_ring ring = {view->events, view->header->event_slots};
    struct frame_protocol frame;
    uint64_t told = 0;
    while (frame_protocol_collider_begin(&frame, view) == 0) {
        collider_step(collider, &view->w[(frame.number - 1) & 1], &view->m,
                      &view->w[frame.number & 1], &ring);
        frame_protocol_collider_end(&frame, view);
        tell_growth(&told);
    }
}

int main(int argc, char **argv)
{
    struct stage_options options = process_stage_options(argc, argv, "jolon-collider");
    struct sandbox sandbox;
    struct view view;
    struct error_text error;
    struct collider collider;

    log_open("collider");
    process_close_inherited();
    process_signals();
    process_die_with_parent(options.parent);
    if (sandbox_begin(&sandbox, ROLE_COLLIDER, options.sandbox_off, &error) != 0 ||
        (options.stand_by ? segment_stand_by : segment_attach)(&view, options.world, ROLE_COLLIDER,
                                                               &error) != 0)
        die_refused("%s", error.text);
    work_done_into(&view.slot[view.role]->work);
    struct thread_pool *workers = thread_pool_create(options.threads);
    if (!workers)
        die_refused("cannot start %u threads: %s", options.threads, strerror(errno));
    if (collider_init(&collider, &view.world, view.w[0].craters, workers) != 0)
        process_refuse_memory(view.world.params->capacity);
    if (sandbox_enter(&sandbox, &error) != 0)
        die_refused("%s", error.text);
    /* It may have been asked to stop, or the run may have ended, while another had the role. */
    if (segment_take(&view) == 0 && !(options.stand_by && frame_protocol_finished(&view))) {
        segment_ready(&view);
        log_info("collides world \"%s\" on %u thread(s)", view.name, options.threads);
        collide_frames(&collider, &view);
    }

    collider_free(&collider);
    thread_pool_destroy(workers);
    segment_detach(&view);
    return EXIT_OK;
}
