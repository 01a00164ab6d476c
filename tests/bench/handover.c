/* Measures a frame whose stages do nothing: mover and collider are two processes with the real
 * frame protocol. For comparison, two processes pass a futex word to each other as often (two
 * wake-ups). */
#include "tests/bench/bench.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/param_values.h"
#include "world/params.h"

#include <errno.h>
#include <linux/futex.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

struct shared {
    _Alignas(64) _Atomic uint32_t word;
    double us[];
};

static struct shared *share(uint32_t frames)
{
    void *memory = mmap(NULL, sizeof(struct shared) + frames * sizeof(double),
                        PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
        die_refused("out of memory: %s", strerror(errno));
    return memory;
}

static void become(struct view *view, enum role role, uint32_t frames)
{
    struct params *params = (struct params *)(uintptr_t)view->world.params;
    view->role = role;
    params->frame_limit = frames;
    params->pace = PACE_MAX;
    params->dt_s = 1.0 / 60.0;
}

static void empty_collider(struct view *view)
{
    struct frame_protocol frame;
    while (frame_protocol_collider_begin(&frame, view) == 0) {
        const struct state_head *now = view->w[(frame.number - 1) & 1].head;
        struct state_head *next = view->w[frame.number & 1].head;
        *next = *now;
        next->frame = frame.number;
        frame_protocol_collider_end(&frame, view);
    }
}

static void empty_mover(struct view *view, double *us)
{
    struct frame_protocol frame;
    uint64_t before = clock_now_ns();
    while (frame_protocol_mover_begin(&frame, view) == 0) {
        uint64_t now = clock_now_ns();
        us[frame.number - 1] = (double)(now - before) / 1e3;
        before = now;
        frame_protocol_mover_end(&frame, view);
    }
}

static void frames_between(uint32_t frames, double *us)
{
    struct params params = {.capacity = 16,
                            .event_slots = 16,
                            .intents_per_frame = 1,
                            .command_slots = 16,
                            .crater_slots = 1};
    struct counts counts = {.posts_side = 2, .side_m = 50000};
    struct segment_header header = segment_header_for(&params, &counts);
    struct view view;
    struct error_text error;
    if (segment_private(&view, &header, &error) != 0)
        die_refused("%s", error.text);
    view.w[0].head->time_scale = 1.0;
    view.checked = true; /* frames have no content: no checksums */
    become(&view, ROLE_COLLIDER, frames);
    int parent = (int)getpid();
    pid_t child = fork();
    if (child < 0)
        die_refused("cannot start a process: %s", strerror(errno));
    if (child == 0) {
        process_die_with_parent(parent);
        empty_collider(&view);
        _exit(0);
    }
    become(&view, ROLE_MOVER, frames);
    empty_mover(&view, us);
    waitpid(child, NULL, 0);
    segment_abandon(&view);
}

static void futex(_Atomic uint32_t *word, int operation, uint32_t value)
{
    syscall(SYS_futex, (uintptr_t)word, operation, value, NULL, NULL, 0);
}

/* Waits until the word is odd (or even), then adds one. */
static void pass_on(_Atomic uint32_t *word, uint32_t odd)
{
    uint32_t value = atomic_load(word);
    while ((value & 1u) != odd) {
        futex(word, FUTEX_WAIT, value);
        value = atomic_load(word);
    }
    atomic_store(word, value + 1);
    futex(word, FUTEX_WAKE, 1);
}

static void futex_between(struct shared *shared, uint32_t frames)
{
    pid_t child = fork();
    if (child < 0)
        die_refused("cannot start a process: %s", strerror(errno));
    if (child == 0) {
        for (uint32_t i = 0; i < frames; i++)
            pass_on(&shared->word, 1);
        _exit(0);
    }
    for (uint32_t i = 0; i < frames; i++) {
        uint64_t before = clock_now_ns();
        pass_on(&shared->word, 0);
        while ((atomic_load(&shared->word) & 1u) != 0)
            futex(&shared->word, FUTEX_WAIT, atomic_load(&shared->word) | 1u);
        shared->us[i] = (double)(clock_now_ns() - before) / 1e3;
    }
    waitpid(child, NULL, 0);
}

int bench_handover(struct bench_options options)
{
    struct shared *frames = share(options.frames), *bare = share(options.frames);
    frames_between(options.frames, frames->us);
    futex_between(bare, options.frames);
    double p50 = bench_quantile(frames->us, options.frames, 0.5);
    double p99 = bench_quantile(frames->us, options.frames, 0.99);
    double futex_p50 = bench_quantile(bare->us, options.frames, 0.5);
    if (options.json)
        printf("{\"us_p50\":%.3f,\"us_p99\":%.3f,\"futex_us_p50\":%.3f}\n", p50, p99, futex_p50);
    else
        printf("a frame without work: p50 %.1f us, p99 %.1f us; a bare futex to and fro: p50 %.1f "
               "us\n",
               p50, p99, futex_p50);
    return EXIT_OK;
}
