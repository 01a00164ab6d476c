/* Runs the two stages of a frame, one after the other, in one process. */
#include "recorder/replay/frame_stepper.h"

#include "world/entity/table_touch.h"

#include <errno.h>

int frame_stepper_init(struct frame_stepper *stepper, struct view *view, uint32_t threads)
{
    *stepper = (struct frame_stepper){.view = view};
    stepper->workers = thread_pool_create(threads);
    if (!stepper->workers)
        return -1;
    if (mover_init(&stepper->mover, &view->world, view->w[0].craters, stepper->workers) != 0)
        goto err_workers;
    if (collider_init(&stepper->collider, &view->world, view->w[0].craters, stepper->workers) != 0)
        goto err_mover;
    uint32_t rows = table_touch_rows(view->w[frame_stepper_frame(stepper) & 1].head->used,
                                     view->header->capacity);
    segment_prefault(view);
    mover_touch(&stepper->mover, &view->m, view->w, rows);
    collider_touch(&stepper->collider, &view->m, view->w, rows);
    return 0;
err_mover:
    mover_free(&stepper->mover);
err_workers:
    thread_pool_destroy(stepper->workers);
    stepper->workers = NULL;
    errno = ENOMEM;
    return -1;
}

void frame_stepper_free(struct frame_stepper *stepper)
{
    if (!stepper->workers)
        return;
    mover_free(&stepper->mover);
    collider_free(&stepper->collider);
    thread_pool_destroy(stepper->workers);
    stepper->workers = NULL;
}

void frame_stepper_sources(const struct view *view,
                           struct command_source sources[COMMAND_RING_COUNT])
{
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        sources[i] =
            (struct command_source){view->commands[i]->slot, layout_ring_slots(view->header, i),
                                    atomic_load(&view->commands[i]->head)};
}

uint64_t frame_stepper_frame(const struct frame_stepper *stepper)
{
    return atomic_load(&stepper->view->commit->commit);
}

void frame_stepper_move(struct frame_stepper *stepper, const struct command_source *sources)
{
    struct view *view = stepper->view;
    struct command_source own[COMMAND_RING_COUNT];
    uint64_t commit = frame_stepper_frame(stepper);
    frame_stepper_sources(view, own);
    mover_step(&stepper->mover, &view->w[commit & 1], &view->m, sources ? sources : own);
    atomic_store(&view->moved_word->moved, commit + 1);
}

void frame_stepper_collide(struct frame_stepper *stepper)
{
    struct view *view = stepper->view;
    const struct event_ring ring = {view->events, view->header->event_slots};
    uint64_t commit = frame_stepper_frame(stepper);
    atomic_store(&view->commit->writing, commit + 1);
    collider_step(&stepper->collider, &view->w[commit & 1], &view->m, &view->w[(commit + 1) & 1],
                  &ring);
    atomic_store(&view->commit->commit, commit + 1);
}

void frame_stepper_step(struct frame_stepper *stepper, const struct command_source *sources)
{
    if (atomic_load(&stepper->view->moved_word->moved) == frame_stepper_frame(stepper))
        frame_stepper_move(stepper, sources);
    frame_stepper_collide(stepper);
}
