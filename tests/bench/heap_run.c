/* Measures an engine frame by frame. Only its step is timed, not what the benchmark looks at. */
#include "tests/bench/heap_run.h"

#include "ipc/process/log.h"
#include "tests/bench/bench.h"
#include "tests/bench/heap_overlap.h"

#include <stdlib.h>
#include <time.h>

/* Which pairs were in contact in the last two frames. */
struct run {
    const struct heap_engine *engine;
    const struct heap_scene *scene;
    struct heap_look look;
    struct heap_pair *before;
    size_t pairs_before, before_capacity;
    uint64_t begun;
    double *cpu_ms, *wall_ms, *caller_ms;
};

static void *grown(void *memory, size_t bytes)
{
    memory = realloc(memory, bytes);
    if (!memory)
        die_refused("out of memory");
    return memory;
}

void heap_look_add(struct heap_look *look, uint32_t a, uint32_t b)
{
    if (look->pairs == look->capacity) {
        look->capacity = look->capacity * 2 + 256;
        look->pair = grown(look->pair, look->capacity * sizeof *look->pair);
    }
    look->pair[look->pairs++] = a < b ? (struct heap_pair){a, b} : (struct heap_pair){b, a};
}

static double now_ms(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static int by_bodies(const void *p, const void *q)
{
    const struct heap_pair *a = p, *b = q;
    if (a->a != b->a)
        return a->a < b->a ? -1 : 1;
    return (a->b > b->b) - (a->b < b->b);
}

/* Sorts the pairs and removes those that are listed twice. */
static void sort_pairs(struct heap_look *look)
{
    size_t kept = 0;
    if (look->pairs == 0)
        return;
    qsort(look->pair, look->pairs, sizeof *look->pair, by_bodies);
    for (size_t i = 0; i < look->pairs; i++) {
        if (kept == 0 || by_bodies(&look->pair[i], &look->pair[kept - 1]) != 0)
            look->pair[kept++] = look->pair[i];
    }
    look->pairs = kept;
}

/* Counts the pairs that were not in contact in the frame before. */
static void count_begun(struct run *run)
{
    const struct heap_look *look = &run->look;
    for (size_t i = 0; i < look->pairs; i++)
        run->begun +=
            run->pairs_before == 0 || !bsearch(&look->pair[i], run->before, run->pairs_before,
                                               sizeof *run->before, by_bodies);
}

static void look_at(struct run *run, void *self)
{
    struct heap_pair *pair = run->before;
    size_t capacity = run->before_capacity;
    run->before = run->look.pair;
    run->before_capacity = run->look.capacity;
    run->pairs_before = run->look.pairs;
    run->look.pair = pair;
    run->look.capacity = capacity;
    run->look.pairs = 0;
    run->engine->look(self, &run->look);
    sort_pairs(&run->look);
    count_begun(run);
}

static void time_step(struct run *run, void *self, uint32_t frame)
{
    double wall = now_ms(CLOCK_MONOTONIC), cpu = now_ms(CLOCK_PROCESS_CPUTIME_ID);
    double caller = now_ms(CLOCK_THREAD_CPUTIME_ID);
    run->engine->step(self);
    run->caller_ms[frame] = now_ms(CLOCK_THREAD_CPUTIME_ID) - caller;
    run->cpu_ms[frame] = now_ms(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    run->wall_ms[frame] = now_ms(CLOCK_MONOTONIC) - wall;
}

static double deepest(const struct run *run, double least_m)
{
    const struct heap_scene *scene = run->scene;
    return heap_overlap_deepest(run->engine->boxes ? &scene->box : &scene->model, run->look.body,
                                scene->tanks.count, least_m);
}

static double fastest(const struct run *run)
{
    double mps = 0.0;
    for (uint32_t i = 0; i < run->scene->tanks.count; i++)
        mps = maths_max(mps, run->look.body[i].speed_mps);
    return mps;
}

static uint32_t frames_pushed(const struct heap_result *result)
{
    return result->frames - result->frames / 3;
}

/* Sorts the times. */
static void set_times(struct run *run, struct heap_result *result)
{
    uint32_t pushed = frames_pushed(result), rest = result->frames / 9;
    result->rest_ms = bench_quantile(run->cpu_ms + result->frames - rest, rest, 0.5);
    result->cpu_ms = bench_quantile(run->cpu_ms, pushed, 0.5);
    result->cpu_p99_ms = bench_quantile(run->cpu_ms, pushed, 0.99);
    result->cpu_worst_ms = bench_quantile(run->cpu_ms, pushed, 1.0);
    result->wall_ms = bench_quantile(run->wall_ms, pushed, 0.5);
    result->caller_ms = bench_quantile(run->caller_ms, pushed, 0.5);
}

static void run_frames(struct run *run, void *self, struct heap_result *result)
{
    uint32_t pushed = frames_pushed(result);
    uint32_t impact = (uint32_t)(HEAP_IMPACT_S / HEAP_DT_S + 0.5);
    for (uint32_t frame = 0; frame < result->frames; frame++) {
        run->engine->drive(self, frame < pushed);
        time_step(run, self, frame);
        look_at(run, self);
        if (frame < pushed && frame < impact)
            result->impact_m = deepest(run, result->impact_m);
        else if (frame < pushed)
            result->steady_m = deepest(run, result->steady_m);
        if (frame + 1 == pushed) {
            result->pairs = (uint32_t)run->look.pairs;
            result->begins = run->begun;
            result->collisions = run->engine->tells ? run->look.told : run->begun;
        }
    }
    result->end_m = deepest(run, 0.0);
    result->fastest_mps = fastest(run);
    result->checksum = run->look.checksum;
    result->at_rest = result->fastest_mps < HEAP_REST_MPS;
}

struct heap_result heap_run(const struct heap_engine *engine, const struct heap_scene *scene,
                            uint32_t threads, uint32_t frames)
{
    struct heap_result result = {.frames = frames,
                                 .threads = threads < engine->threads ? threads : engine->threads};
    struct run run = {.engine = engine,
                      .scene = scene,
                      .cpu_ms = grown(NULL, frames * sizeof(double)),
                      .wall_ms = grown(NULL, frames * sizeof(double)),
                      .caller_ms = grown(NULL, frames * sizeof(double))};
    run.look.body = grown(NULL, scene->tanks.count * sizeof *run.look.body);
    void *self = engine->open(&scene->tanks, result.threads);
    run_frames(&run, self, &result);
    engine->close(self);
    set_times(&run, &result);
    free(run.look.body);
    free(run.look.pair);
    free(run.before);
    free(run.cpu_ms);
    free(run.wall_ms);
    free(run.caller_ms);
    return result;
}
