/* Measures collision detection and that of other engines on the same work. */
#include "tests/bench/bench.h"
#include "tests/bench/workload.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_NS (60ull * NS_PER_S) /* limit for one engine's run */
#define STEPS_MOST 330

static const struct engine *const engines[] = {&engine_jolon, &engine_ode, &engine_bullet};

#define ENGINES (sizeof engines / sizeof engines[0])

struct result {
    const struct engine *engine;
    uint32_t threads, steps;
    double ms, p99_ms, bytes_per_vehicle;
    uint64_t contacts, fixed_contacts;
    bool ended; /* ended at the limit */
};

void engine_touches_add(struct engine_touches *touches, uint32_t a, uint32_t b)
{
    if (touches->count == touches->capacity) {
        touches->capacity = touches->capacity * 2 + 1024;
        touches->touch = realloc(touches->touch, touches->capacity * sizeof *touches->touch);
        if (!touches->touch)
            die_refused("out of memory");
    }
    touches->touch[touches->count++] = (struct engine_touch){a, b};
}

static size_t heap_bytes(void)
{
    struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

/* Runs the steps. bytes: what the engine holds at the end. */
static void run_steps(struct result *result, struct workload *workload, double *ms, size_t *bytes)
{
    const struct engine *engine = result->engine;
    struct engine_touches touches = {0};
    uint32_t steps = result->steps;
    uint64_t begin = clock_now_ns();
    size_t before = heap_bytes();
    void *self = engine->open(&workload->scene, result->threads);
    for (result->steps = 0; result->steps < steps && !result->ended; result->steps++) {
        engine->place(self);
        touches.count = 0;
        uint64_t t0 = clock_now_ns();
        engine->detect(self, &touches);
        uint64_t t1 = clock_now_ns();
        ms[result->steps] = (double)(t1 - t0) / 1e6;
        workload_step(workload, &touches);
        result->ended = t1 - begin > LONGEST_NS;
    }
    *bytes = heap_bytes() - before - touches.capacity * sizeof *touches.touch;
    engine->close(self);
    free(touches.touch);
}

static struct result measure(const struct engine *engine, struct workload *workload,
                             struct bench_options options)
{
    struct result result = {.engine = engine,
                            .threads = options.threads < engine->threads ? options.threads
                                                                         : engine->threads,
                            .steps = 1};
    double *ms = calloc(options.frames, sizeof *ms);
    size_t empty, full;
    if (!ms)
        die_refused("out of memory");
    /* A run without vehicles tells the memory of the fixed objects. */
    workload->scene.bodies = 0;
    run_steps(&result, workload, ms, &empty);
    workload->scene.bodies = options.vehicles;
    workload_rewind(workload);
    result.steps = options.frames;
    result.ended = false;
    run_steps(&result, workload, ms, &full);
    result.ended = result.steps < options.frames;
    result.ms = bench_quantile(ms, result.steps, 0.5);
    result.p99_ms = bench_quantile(ms, result.steps, 0.99);
    result.bytes_per_vehicle = full > empty ? (double)(full - empty) / options.vehicles : 0.0;
    result.contacts = workload->contacts;
    result.fixed_contacts = workload->fixed_contacts;
    free(ms);
    return result;
}

static void print(const struct result *result, uint32_t vehicles, bool json)
{
    const struct engine *engine = result->engine;
    if (json)
        printf("{\"engine\":\"%s\",\"variant\":\"%s\",\"threads\":%u,\"vehicles\":%u,\"steps\":%u,"
               "\"ms\":%.6f,\"p99_ms\":%.6f,\"contacts\":%llu,\"fixed_contacts\":%llu,"
               "\"bytes_per_vehicle\":%.0f}\n",
               engine->name, engine->variant, result->threads, vehicles, result->steps, result->ms,
               result->p99_ms, (unsigned long long)result->contacts,
               (unsigned long long)result->fixed_contacts, result->bytes_per_vehicle);
    else
        printf("%-6s %-4s %u thread(s), %u vehicles, %3u steps: %.4f ms (p99 %.4f), %llu contacts "
               "begun (%llu with fixed objects), %.0f bytes a vehicle%s\n",
               engine->name, engine->variant, result->threads, vehicles, result->steps, result->ms,
               result->p99_ms, (unsigned long long)result->contacts,
               (unsigned long long)result->fixed_contacts, result->bytes_per_vehicle,
               result->ended ? "; ended after a minute" : "");
    fflush(stdout);
}

static uint32_t steps_for(uint32_t vehicles)
{
    return vehicles <= 100000 ? STEPS_MOST : STEPS_MOST / 5;
}

int bench_detect(struct bench_options options)
{
    struct workload workload;
    /* One arena, so that mallinfo2() counts the memory of all threads. */
    mallopt(M_ARENA_MAX, 1);
    if (options.frames == 0)
        options.frames = steps_for(options.vehicles);
    workload_open(&workload, options.vehicles);
    for (size_t i = 0; i < (options.peers ? ENGINES : 1); i++) {
        struct result result = measure(engines[i], &workload, options);
        print(&result, options.vehicles, options.json);
    }
    workload_close(&workload);
    return EXIT_OK;
}
