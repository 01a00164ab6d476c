/* Jolon as an engine of the benchmark of heaps: its mover drives, and its collider is measured. */
#include "tests/bench/heap_engine.h"

#include "ipc/process/log.h"
#include "recorder/replay/frame_stepper.h"
#include "supervisor/physics/rigid_pose.h"
#include "tests/bench/world.h"
#include "world/entity/persistent_contact.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct jolon {
    struct frame_stepper stepper;
    uint32_t tanks;
    bool pushes;
};

static const struct state *committed(const struct jolon *self)
{
    return &self->stepper.view->w[frame_stepper_frame(&self->stepper) & 1];
}

static void *jolon_open(const struct heap_tanks *tanks, uint32_t threads)
{
    struct jolon *self = calloc(1, sizeof *self);
    if (!self)
        die_refused("out of memory");
    self->tanks = tanks->count;
    if (frame_stepper_init(&self->stepper, tanks->view, threads) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    const struct entities *e = &committed(self)->entities;
    for (uint32_t i = 0; i < tanks->count; i++) {
        e->row[i].behaviour = BEHAVIOUR_DRIVEN;
        e->row[i].until_tick = UINT32_MAX;
    }
    return self;
}

static void jolon_close(void *handle)
{
    struct jolon *self = handle;
    frame_stepper_free(&self->stepper);
    free(self);
}

/* The throttles are written into the committed frame. Mover and collider then copy it anew. */
static void jolon_drive(void *handle, bool push)
{
    struct jolon *self = handle;
    const struct entities *e = &committed(self)->entities;
    for (uint32_t i = 0; i < self->tanks && push != self->pushes; i++)
        e->row[i].throttle = push ? 1.0f : 0.0f;
    if (push != self->pushes)
        self->stepper.mover.left = self->stepper.collider.left[0] = self->stepper.collider.left[1] =
            0;
    self->pushes = push;
    frame_stepper_move(&self->stepper, NULL);
}

static void jolon_step(void *handle)
{
    struct jolon *self = handle;
    frame_stepper_collide(&self->stepper);
}

static struct heap_body body_of(const struct entities *e, uint32_t row)
{
    struct rigid_pose pose = rigid_pose_of(entities_position(e, row), e->row[row].heading,
                                           e->row[row].pitch, e->row[row].roll);
    return (struct heap_body){
        .at = {pose.at.x - BENCH_MIDDLE_M, pose.at.y, pose.at.z - BENCH_MIDDLE_M},
        .forward = {pose.forward.x, pose.forward.y, pose.forward.z},
        .up = {pose.up.x, pose.up.y, pose.up.z},
        .right = {pose.right.x, pose.right.y, pose.right.z},
        .speed_mps = vec3_length(entities_velocity(e, row))};
}

static void jolon_look(void *handle, struct heap_look *look)
{
    struct jolon *self = handle;
    const struct state *now = committed(self);
    for (uint32_t i = 0; i < self->tanks; i++)
        look->body[i] = body_of(&now->entities, i);
    for (uint32_t i = 0; i < now->head->contact_count; i++)
        heap_look_add(look, now->contacts[i].a_row, now->contacts[i].b_row);
    look->told = now->head->tally.collisions;
    look->checksum = now->head->checksum;
}

const struct heap_engine heap_jolon = {.name = "jolon",
                                       .threads = THREAD_POOL_MAX,
                                       .tells = true,
                                       .open = jolon_open,
                                       .close = jolon_close,
                                       .drive = jolon_drive,
                                       .step = jolon_step,
                                       .look = jolon_look};
