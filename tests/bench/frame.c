/* Measures the steps of a frame: mover and collider run one after the other in one process, on the
 * Hunter-Liggett world (500 vehicles), or on its ground with any number of vehicles that stand, are
 * on patrol, are at war or are close together. */
#include "tests/bench/bench.h"
#include "tests/bench/burst.h"
#include "tests/bench/world.h"

#include "ipc/frame/motion_table.h"
#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/replay/frame_stepper.h"
#include "world/params.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#define MOTION_FRAMES 60u /* in which changes of controls are counted; even */
#define TELL_FRAMES   6u  /* between two batches of motions */
#define SETTLE_FRAMES 60u /* after a burst, before frames are measured again */

/* Of each frame [ms]: wall time of the stages and of both, and processor time of all threads. */
struct times {
    double *mover_ms, *collider_ms, *frame_ms, *cpu_ms;
    double *woken;  /* rows that were moved */
    double *faults; /* pages that were taken from the kernel */
    uint32_t frames;
};

/* The controls and the course of each row in the last frame. While its controls are the same, its
 * motion is. While its course is too, it goes straight on at a constant speed, or rests. */
struct controls {
    float throttle, steer, climb;
    double heading, vx, vz;
};

/* Rows whose controls have changed, and rows whose course has not. */
struct changes {
    double controls, steady;
};

struct result {
    double mover_ms, collider_ms, frame_ms, slow_ms, cpu_ms; /* medians, and a p99 */
    double first_ms, first_cpu_ms;                           /* the first frame */
    double first_faults;               /* pages that the first frame took from the kernel */
    double second_ms, second_worst_ms; /* frames of the first simulated second: sum and worst */
    double woken;                      /* rows moved in a frame, median */
    double motion_frames;              /* for which a vehicle's controls stay the same, mean */
    double steady; /* share of the rows that keep heading and level velocity in a frame, percent */
    double told;   /* rows that a batch of motions tells, every TELL_FRAMES frames, mean */
};

struct burst {
    struct result after;
    uint32_t frames; /* until the last bomb was gone */
    double worst_ms; /* of these frames */
    uint32_t rows, rows_after;
};

static double cpu_now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

static double faults_now(void)
{
    struct rusage usage;
    (void)getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_minflt;
}

static void begin(struct frame_stepper *stepper, struct view *view, uint32_t threads)
{
    if (frame_stepper_init(stepper, view, threads) != 0)
        die_refused("cannot begin: %s", strerror(errno));
}

/* Adds what has changed since the rows were noted, and notes them. */
static void count_changes(const struct frame_stepper *stepper, struct controls *controls,
                          struct changes *changes)
{
    const struct state *state = &stepper->view->w[frame_stepper_frame(stepper) & 1];
    const struct entities *e = &state->entities;
    for (uint32_t i = 0; i < state->head->used; i++) {
        const struct controls now = {e->row[i].throttle, e->row[i].steer, e->row[i].climb,
                                     e->row[i].heading,  e->row[i].vx,    e->row[i].vz};
        const struct controls *before = &controls[i];
        changes->controls += before->throttle != now.throttle || before->steer != now.steer ||
                             before->climb != now.climb;
        changes->steady +=
            before->heading == now.heading && before->vx == now.vx && before->vz == now.vz;
        controls[i] = now;
    }
}

static void run(struct frame_stepper *stepper, const struct times *times)
{
    for (uint32_t i = 0; i < times->frames; i++) {
        double cpu = cpu_now_ms(), faults = faults_now();
        uint64_t t0 = clock_now_ns();
        frame_stepper_move(stepper, NULL);
        uint64_t t1 = clock_now_ns();
        frame_stepper_collide(stepper);
        uint64_t t2 = clock_now_ns();
        times->mover_ms[i] = (double)(t1 - t0) / 1e6;
        times->collider_ms[i] = (double)(t2 - t1) / 1e6;
        times->frame_ms[i] = (double)(t2 - t0) / 1e6;
        times->cpu_ms[i] = cpu_now_ms() - cpu;
        times->woken[i] = (double)stepper->mover.moved_rows;
        times->faults[i] = faults_now() - faults;
    }
}

struct telling {
    struct motion_table table;
    struct snapshot snapshot;
    double rows; /* told after the first batch */
};

static void tell(struct telling *telling, const struct view *view, bool first)
{
    if (snapshot_take(&telling->snapshot, view) != 0)
        die_refused("cannot read a frame: %s", strerror(errno));
    motion_table_update(&telling->table, &view->world, &telling->snapshot);
    telling->rows += first ? 0.0 : telling->table.count;
}

/* Finds the mean life of a motion, how many rows go on as they did, and how many receivers of
 * motions are told. Runs MOTION_FRAMES frames, which are not timed, because looking at the rows
 * between two frames would slow them. */
static void find_motions(struct frame_stepper *stepper, struct result *result)
{
    const struct state *state = &stepper->view->w[frame_stepper_frame(stepper) & 1];
    double rows = state->head->used * (double)MOTION_FRAMES;
    struct controls *controls = calloc(stepper->view->world.params->capacity, sizeof *controls);
    struct changes changes = {0};
    struct telling telling = {0};
    if (!controls || snapshot_init(&telling.snapshot, stepper->view) != 0 ||
        motion_table_init(&telling.table, stepper->view->header->capacity) != 0)
        die_refused("out of memory");
    count_changes(stepper, controls, &changes);
    changes = (struct changes){0};
    tell(&telling, stepper->view, true);
    for (uint32_t i = 1; i <= MOTION_FRAMES; i++) {
        frame_stepper_step(stepper, NULL);
        count_changes(stepper, controls, &changes);
        if (i % TELL_FRAMES == 0)
            tell(&telling, stepper->view, false);
    }
    motion_table_free(&telling.table);
    snapshot_free(&telling.snapshot);
    free(controls);
    result->told = telling.rows / (MOTION_FRAMES / TELL_FRAMES);
    result->motion_frames = rows / (changes.controls > 0.0 ? changes.controls : 1.0);
    result->steady = 100.0 * changes.steady / rows;
}

/* Sorts the times. */
static struct result result_of(const struct times *times, double dt_s)
{
    struct result result = {.first_ms = times->frame_ms[0],
                            .first_cpu_ms = times->cpu_ms[0],
                            .first_faults = times->faults[0]};
    for (uint32_t i = 0; i < times->frames && (double)i * dt_s < 1.0; i++) {
        result.second_ms += times->frame_ms[i];
        if (times->frame_ms[i] > result.second_worst_ms)
            result.second_worst_ms = times->frame_ms[i];
    }
    result.mover_ms = bench_quantile(times->mover_ms, times->frames, 0.5);
    result.collider_ms = bench_quantile(times->collider_ms, times->frames, 0.5);
    result.cpu_ms = bench_quantile(times->cpu_ms, times->frames, 0.5);
    result.frame_ms = bench_quantile(times->frame_ms, times->frames, 0.5);
    result.woken = bench_quantile(times->woken, times->frames, 0.5);
    result.slow_ms = bench_quantile(times->frame_ms, times->frames, 0.99);
    return result;
}

/* Drops the bombs, runs until the last one is gone, lets the world settle and measures again. */
static void run_burst(struct view *view, const struct bench_options *options,
                      const struct times *times, struct burst *burst)
{
    struct frame_stepper stepper;
    burst->rows = view->w[(options->settle + options->frames) & 1].head->used;
    burst_drop(view, options->burst);
    begin(&stepper, view, options->threads);
    for (uint32_t munitions = 1; munitions > 0; burst->frames++) {
        uint64_t t0 = clock_now_ns();
        frame_stepper_step(&stepper, NULL);
        double ms = (double)(clock_now_ns() - t0) / 1e6;
        burst->worst_ms = ms > burst->worst_ms ? ms : burst->worst_ms;
        munitions = view->w[frame_stepper_frame(&stepper) & 1].head->munitions;
        if (burst->frames > options->frames + 600) /* others fire too */
            break;
    }
    for (uint32_t i = 0; i < SETTLE_FRAMES; i++)
        frame_stepper_step(&stepper, NULL);
    run(&stepper, times);
    burst->after = result_of(times, world_dt_s(&view->world));
    burst->rows_after = view->w[frame_stepper_frame(&stepper) & 1].head->used;
    frame_stepper_free(&stepper);
}

/* Gives every land vehicle a driver who makes it circle: all are bodies on their springs. */
static void drive_all(const struct view *view)
{
    for (int buffer = 0; buffer < 2; buffer++) {
        struct entities e = view->w[buffer].entities;
        for (uint32_t i = 0; i < view->w[buffer].head->used; i++) {
            if (view->world.kinds[e.row[i].kind].domain != DOMAIN_LAND)
                continue;
            e.row[i].behaviour = BEHAVIOUR_DRIVEN;
            e.row[i].throttle = 0.6f;
            e.row[i].steer = i & 1 ? 0.2f : -0.2f;
        }
    }
}

/* --- what is printed ---------------------------------------------------------------------------*/

static void print_json(const struct bench_options *options, const struct result *result,
                       const struct burst *burst, const struct counters *tally)
{
    printf("{\"vehicles\":%u,\"mode\":\"%s\",\"threads\":%u,\"frames\":%u,\"mover_ms\":%.6f,"
           "\"collider_ms\":%.6f,\"frame_ms\":%.6f,\"frame_p99_ms\":%.6f,\"cpu_ms\":%.6f,"
           "\"first_ms\":%.6f,\"first_cpu_ms\":%.6f,\"first_faults\":%.0f,\"second_ms\":%.6f,"
           "\"second_worst_ms\":%.6f,"
           "\"woken\":%.0f,\"motion_frames\":%.1f,\"steady\":%.1f,\"told\":%.0f,",
           options->vehicles, bench_mode_word((enum bench_mode)options->mode), options->threads,
           options->frames, result->mover_ms, result->collider_ms, result->frame_ms,
           result->slow_ms, result->cpu_ms, result->first_ms, result->first_cpu_ms,
           result->first_faults, result->second_ms, result->second_worst_ms, result->woken,
           result->motion_frames, result->steady, result->told);
    if (options->burst > 0)
        printf("\"burst\":%u,\"burst_frames\":%u,\"burst_worst_ms\":%.6f,\"after_ms\":%.6f,"
               "\"after_cpu_ms\":%.6f,\"rows\":%u,\"rows_after\":%u,",
               options->burst, burst->frames, burst->worst_ms, burst->after.frame_ms,
               burst->after.cpu_ms, burst->rows, burst->rows_after);
    printf("\"collisions\":%llu,\"fires\":%llu,\"changes\":%llu,\"destroyed\":%llu}\n",
           (unsigned long long)tally->collisions, (unsigned long long)tally->fires,
           (unsigned long long)tally->agent_changes, (unsigned long long)tally->destroyed);
}

static void print_text(const struct bench_options *options, const struct result *result,
                       const struct burst *burst, const struct counters *tally)
{
    printf("%u vehicles, %s, %u thread(s), %u frames: mover %.3f ms, collider %.3f ms, frame %.3f "
           "ms (p99 %.3f), processor time %.3f ms, %.0f rows moved, %.0f told; first frame %.3f ms "
           "(%.3f), "
           "first second %.3f ms "
           "(worst frame %.3f); %llu collisions, %llu shots, %llu changes of mind, %llu destroyed",
           options->vehicles, bench_mode_word((enum bench_mode)options->mode), options->threads,
           options->frames, result->mover_ms, result->collider_ms, result->frame_ms,
           result->slow_ms, result->cpu_ms, result->woken, result->told, result->first_ms,
           result->first_cpu_ms, result->second_ms, result->second_worst_ms,
           (unsigned long long)tally->collisions, (unsigned long long)tally->fires,
           (unsigned long long)tally->agent_changes, (unsigned long long)tally->destroyed);
    if (options->burst > 0)
        printf("; %u bombs in %u frames (worst %.3f ms), then frame %.3f ms, processor time %.3f "
               "ms; rows in use %u before, %u after",
               options->burst, burst->frames, burst->worst_ms, burst->after.frame_ms,
               burst->after.cpu_ms, burst->rows, burst->rows_after);
    putchar('\n');
}

int bench_frame(struct bench_options options)
{
    struct view view;
    struct frame_stepper stepper;
    struct burst burst = {0};
    if (options.agents)
        options.mode = BENCH_MODE_WAR;
    bench_world_mode(&view, (enum bench_mode)options.mode, options.vehicles, options.burst);
    if (options.driven)
        drive_all(&view);
    ((struct params *)(uintptr_t)view.world.params)->cruise = options.cruise;
    size_t frames = options.frames;
    double *values = calloc(frames * 6, sizeof *values);
    if (!values)
        die_refused("out of memory");
    const struct times times = {values,
                                values + frames,
                                values + 2 * frames,
                                values + 3 * frames,
                                values + 4 * frames,
                                values + 5 * frames,
                                options.frames};
    begin(&stepper, &view, options.threads);
    for (uint32_t i = 0; i < options.settle; i++)
        frame_stepper_step(&stepper, NULL);
    run(&stepper, &times);
    const struct counters tally = view.w[frame_stepper_frame(&stepper) & 1].head->tally;
    struct result result = result_of(&times, world_dt_s(&view.world));
    find_motions(&stepper, &result);
    frame_stepper_free(&stepper);
    if (options.burst > 0)
        run_burst(&view, &options, &times, &burst);
    (options.json ? print_json : print_text)(&options, &result, &burst, &tally);
    free(values);
    segment_abandon(&view);
    return EXIT_OK;
}
