/* Measures the steps of a frame: mover and collider run one after the other in one process, on the
 * Hunter-Liggett world (500 vehicles), or on its ground with any number of vehicles on patrol or at
 * war. */
#include "tests/bench/bench.h"
#include "tests/bench/world.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/replay/frame_stepper.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct times {
    double *mover_ms, *collider_ms, *frame_ms;
};

static void run(struct view *view, const struct bench_options *options, struct times *times)
{
    struct frame_stepper stepper;
    if (frame_stepper_init(&stepper, view, options->threads) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    for (uint32_t i = 0; i < options->frames; i++) {
        uint64_t t0 = clock_now_ns();
        frame_stepper_move(&stepper, NULL);
        uint64_t t1 = clock_now_ns();
        frame_stepper_collide(&stepper);
        uint64_t t2 = clock_now_ns();
        times->mover_ms[i] = (double)(t1 - t0) / 1e6;
        times->collider_ms[i] = (double)(t2 - t1) / 1e6;
        times->frame_ms[i] = (double)(t2 - t0) / 1e6;
    }
    frame_stepper_free(&stepper);
}

/* Gives every land vehicle a driver who makes it circle: all are bodies on their springs. */
static void drive_all(const struct view *view)
{
    for (int buffer = 0; buffer < 2; buffer++) {
        struct entities e = view->w[buffer].entities;
        for (uint32_t i = 0; i < view->w[buffer].head->used; i++) {
            if (view->world.kinds[e.kind[i]].domain != DOMAIN_LAND)
                continue;
            e.behaviour[i] = BEHAVIOUR_DRIVEN;
            e.throttle[i] = 0.6f;
            e.steer[i] = i & 1 ? 0.2f : -0.2f;
        }
    }
}

int bench_frame(struct bench_options options)
{
    struct view view;
    if (options.agents)
        bench_world_agents(&view, options.vehicles);
    else
        bench_world_open(&view, NULL, options.vehicles);
    if (options.driven)
        drive_all(&view);
    double *values = calloc((size_t)options.frames * 3, sizeof *values);
    if (!values)
        die_refused("out of memory");
    struct times times = {values, values + options.frames, values + 2 * (size_t)options.frames};
    run(&view, &options, &times);
    const struct state_head *head = view.w[options.frames & 1].head;
    double mover = bench_quantile(times.mover_ms, options.frames, 0.5);
    double collider = bench_quantile(times.collider_ms, options.frames, 0.5);
    double frame = bench_quantile(times.frame_ms, options.frames, 0.5);
    double slow = bench_quantile(times.frame_ms, options.frames, 0.99);
    if (options.json)
        printf(
            "{\"vehicles\":%u,\"threads\":%u,\"frames\":%u,\"mover_ms\":%.6f,\"collider_ms\":%.6f,"
            "\"frame_ms\":%.6f,\"frame_p99_ms\":%.6f,\"collisions\":%llu,\"fires\":%llu,"
            "\"changes\":%llu,\"destroyed\":%llu}\n",
            options.vehicles, options.threads, options.frames, mover, collider, frame, slow,
            (unsigned long long)head->tally.collisions, (unsigned long long)head->tally.fires,
            (unsigned long long)head->tally.agent_changes,
            (unsigned long long)head->tally.destroyed);
    else
        printf(
            "%u vehicles, %u thread(s), %u frames: mover %.3f ms, collider %.3f ms, frame %.3f ms "
            "(p99 %.3f); %llu collisions, %llu shots, %llu changes of mind, %llu destroyed\n",
            options.vehicles, options.threads, options.frames, mover, collider, frame, slow,
            (unsigned long long)head->tally.collisions, (unsigned long long)head->tally.fires,
            (unsigned long long)head->tally.agent_changes,
            (unsigned long long)head->tally.destroyed);
    free(values);
    segment_abandon(&view);
    return EXIT_OK;
}
