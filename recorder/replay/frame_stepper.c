/* The two stages of a frame, one after the other, in one process. */
#include "recorder/replay/frame_stepper.h"

#include <errno.h>

int frame_stepper_init(struct frame_stepper *player, struct view *view, uint32_t threads)
{
    *player = (struct frame_stepper){.view = view};
    player->workers = thread_pool_create(threads);
    if (!player->workers)
        return -1;
    if (mover_init(&player->mover, &view->world, view->w[0].craters, player->workers) != 0)
        goto err_workers;
    if (collider_init(&player->collider, &view->world, view->w[0].craters, player->workers) != 0)
        goto err_mover;
    return 0;
err_mover:
    mover_free(&player->mover);
err_workers:
    thread_pool_destroy(player->workers);
    player->workers = NULL;
    errno = ENOMEM;
    return -1;
}

void frame_stepper_free(struct frame_stepper *player)
{
    if (!player->workers)
        return;
    mover_free(&player->mover);
    collider_free(&player->collider);
    thread_pool_destroy(player->workers);
    player->workers = NULL;
}

void frame_stepper_sources(const struct view *view,
                           struct command_source sources[COMMAND_RING_COUNT])
{
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        sources[i] = (struct command_source){view->commands[i]->slot, view->header->command_slots,
                                             atomic_load(&view->commands[i]->head)};
}

uint64_t frame_stepper_frame(const struct frame_stepper *player)
{
    return atomic_load(&player->view->commit->commit);
}

void frame_stepper_move(struct frame_stepper *player, const struct command_source *sources)
{
    struct view *view = player->view;
    struct command_source own[COMMAND_RING_COUNT];
    uint64_t commit = frame_stepper_frame(player);
    frame_stepper_sources(view, own);
    mover_step(&player->mover, &view->w[commit & 1], &view->m, sources ? sources : own);
    atomic_store(&view->moved_word->moved, commit + 1);
}

void frame_stepper_collide(struct frame_stepper *player)
{
    struct view *view = player->view;
    const struct event_ring ring = {view->events, view->header->event_slots};
    uint64_t commit = frame_stepper_frame(player);
    atomic_store(&view->commit->writing, commit + 1);
    collider_step(&player->collider, &view->w[commit & 1], &view->m, &view->w[(commit + 1) & 1],
                  &ring);
    atomic_store(&view->commit->commit, commit + 1);
}

void frame_stepper_step(struct frame_stepper *player, const struct command_source *sources)
{
    if (atomic_load(&player->view->moved_word->moved) == frame_stepper_frame(player))
        frame_stepper_move(player, sources);
    frame_stepper_collide(player);
}
