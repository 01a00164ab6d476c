/* Measures a picture and its stages. The standard scene is Hunter-Liggett after half a minute of
 * battle, seen from behind a vehicle, and is drawn while the simulation continues. With --beside
 * another process runs a world of its own at its own pace meanwhile. */
#include "tests/bench/bench.h"
#include "tests/bench/scene.h"
#include "tests/bench/world.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "renderer/chart/annotated_picture.h"
#include "renderer/image/png.h"
#include "renderer/chart/instruments.h"
#include "world/view_mode.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define FIRST_FRAME  1800u /* the fighting has begun by then */
#define PICTURES_MAX 100000u

struct bench {
    struct bench_scene scene;
    struct annotated_picture chart;
};

enum stage { STAGE_SCENE, STAGE_DRAW, STAGE_CHART, STAGE_TOTAL, STAGE_COUNT };

static const char *const stage_names[STAGE_COUNT] = {"scene", "draw", "instruments", "total"};

/* For each picture: elapsed milliseconds, and milliseconds of this process's processors. */
struct times {
    double *wall_ms[STAGE_COUNT], *cpu_ms[STAGE_COUNT];
    uint32_t count;
    double *part_ms[BACK_END_STAGES_MAX]; /* of drawing, if the back end reports it */
    const char *part_names[BACK_END_STAGES_MAX];
    uint32_t parts;
};

static uint64_t cpu_now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (uint64_t)now.tv_sec * NS_PER_S + (uint64_t)now.tv_nsec;
}

static void write_picture(const struct bench_scene *s, const char *folder, uint32_t number)
{
    char path[1024];
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        die_refused("%s: %s", folder, strerror(errno));
    snprintf(path, sizeof path, "%s/%05u.png", folder, number);
    if (png_write_file(AT_FDCWD, path, &s->image, "jolon-bench render") != 0)
        die_refused("%s: %s", path, strerror(errno));
}

/* Draws a picture. number: its index, from 0. */
static void draw_one(struct bench *bench, struct times *times, uint32_t number)
{
    struct bench_scene *s = &bench->scene;
    struct frame_view frame_view = bench_scene_frame_view(s);
    struct annotated_picture_source source = {.frame_view = &frame_view,
                                              .tracks = &s->tracks,
                                              .effects = &s->effects,
                                              .camera = &s->list.camera,
                                              .slot = s->slot};
    uint64_t wall[STAGE_COUNT], cpu[STAGE_COUNT];
    wall[0] = clock_now_ns();
    cpu[0] = cpu_now_ns();
    bench_scene_build(s, &frame_view);
    wall[1] = clock_now_ns();
    cpu[1] = cpu_now_ns();
    bench_scene_draw(s, &frame_view);
    wall[2] = clock_now_ns();
    cpu[2] = cpu_now_ns();
    annotated_picture_instruments(&bench->chart, &s->image, &source);
    wall[3] = clock_now_ns();
    cpu[3] = cpu_now_ns();
    for (uint32_t i = 0; i < STAGE_TOTAL; i++) {
        times->wall_ms[i][number] = (double)(wall[i + 1] - wall[i]) / 1e6;
        times->cpu_ms[i][number] = (double)(cpu[i + 1] - cpu[i]) / 1e6;
    }
    if (s->draw.stages != NULL) {
        const struct back_end_stages *stages = s->draw.stages(s->draw.self);
        times->parts = stages->count;
        for (uint32_t i = 0; i < stages->count; i++) {
            times->part_names[i] = stages->stage[i].name;
            times->part_ms[i][number] = (double)stages->stage[i].cpu_ns / 1e6;
        }
    }
    times->wall_ms[STAGE_TOTAL][number] = (double)(wall[3] - wall[0]) / 1e6;
    times->cpu_ms[STAGE_TOTAL][number] = (double)(cpu[3] - cpu[0]) / 1e6;
}

static void open_bench(struct bench *bench, const struct bench_options *options)
{
    const struct bench_scene_options scene_options = {.frame = FIRST_FRAME,
                                                      .width = options->size.width,
                                                      .height = options->size.height,
                                                      .threads = options->threads,
                                                      .soft = !options->gl,
                                                      .follow = options->follow,
                                                      .view = VIEW_CHASE};
    struct error_text error;
    bench_scene_open(&bench->scene, &scene_options);
    if (bench->scene.slot == SLOT_NONE)
        die_refused("there is no vehicle to follow");
    if (annotated_picture_open(&bench->chart, &bench->scene.view.world, options->size.width,
                               options->size.height, &error) != 0)
        die_refused("%s", error.text);
}

static void run(struct bench *bench, const struct bench_options *options, struct times *times)
{
    double spent_ms = 0.0;
    while (spent_ms < 1e3 * options->seconds && times->count < PICTURES_MAX) {
        draw_one(bench, times, times->count);
        if (options->out != NULL && (options->all || times->count == 0))
            write_picture(&bench->scene, options->out, times->count);
        spent_ms += times->wall_ms[STAGE_TOTAL][times->count];
        times->count++;
        bench_scene_step(&bench->scene);
    }
}

/* --- the simulation beside it ------------------------------------------------------------------*/

static void keep_to(uint32_t cpu)
{
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(cpu, &set);
    if (sched_setaffinity(0, sizeof set, &set) != 0)
        die_refused("cannot keep to processor %u: %s", cpu, strerror(errno));
}

/* Starts a process that runs a world at its pace until it is killed. */
static pid_t begin_beside(bool one_core)
{
    pid_t child = fork();
    if (child < 0)
        die_refused("cannot fork: %s", strerror(errno));
    if (child > 0)
        return child;
    struct view view;
    struct frame_stepper stepper;
    process_die_with_parent(getppid());
    if (one_core)
        keep_to(0);
    bench_world_open(&view, NULL, BENCH_SCENARIO_VEHICLES);
    if (frame_stepper_init(&stepper, &view, 1) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    uint64_t step_ns = (uint64_t)(world_dt_s(&view.world) * (double)NS_PER_S);
    for (uint64_t next = clock_now_ns();; next += step_ns) {
        clock_sleep_until_ns(next);
        frame_stepper_step(&stepper, NULL);
    }
}

static void end_beside(pid_t child)
{
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
}

/* --- reading and telling -----------------------------------------------------------------------*/

static void tell(const struct bench_options *options, struct times *times)
{
    /* The first picture fills the caches and is not counted. */
    uint32_t skip = times->count > 1 ? 1 : 0, n = times->count - skip;
    double first_ms = times->wall_ms[STAGE_TOTAL][0];
    double total = bench_quantile(times->wall_ms[STAGE_TOTAL] + skip, n, 0.5);
    double slow = bench_quantile(times->wall_ms[STAGE_TOTAL] + skip, n, 0.99);
    printf(options->json
               ? "{\"back_end\":\"%s\",\"size\":\"%ux%u\",\"threads\":%u,\"beside\":%s,"
                 "\"pictures\":%u,"
                 "\"fps\":%.1f,\"p99_ms\":%.3f,\"first_ms\":%.1f,\"stage_ms\":{"
               : "%s, %ux%u, %u thread(s), simulation beside: %s, %u pictures: %.1f a second "
                 "(p99 %.1f ms, the first %.0f ms)\n",
           options->gl ? "gl" : "soft", options->size.width, options->size.height, options->threads,
           options->beside ? "true" : "false", times->count, 1e3 / total, slow, first_ms);
    for (uint32_t i = 0; i < STAGE_COUNT; i++) {
        double wall = bench_quantile(times->wall_ms[i] + skip, n, 0.5);
        double cpu = bench_quantile(times->cpu_ms[i] + skip, n, 0.5);
        printf(options->json ? "%s\"%s\":%.3f,\"%s_cpu\":%.3f" : "%s  %-12s %8.3f ms  (%s: %.3f)\n",
               options->json && i > 0 ? "," : "", stage_names[i], wall,
               options->json ? stage_names[i] : "processors", cpu);
    }
    for (uint32_t i = 0; i < times->parts; i++)
        printf(options->json ? ",\"draw_%s_cpu\":%.3f" : "    %-10s %8.3f ms of processors\n",
               times->part_names[i], bench_quantile(times->part_ms[i] + skip, n, 0.5));
    if (options->json)
        printf("}}\n");
}

int bench_render(struct bench_options options)
{
    static struct bench bench;
    struct times times = {.count = 0};
    double *values =
        calloc((size_t)(2 * STAGE_COUNT + BACK_END_STAGES_MAX) * PICTURES_MAX, sizeof *values);
    if (values == NULL)
        die_refused("out of memory");
    for (uint32_t i = 0; i < STAGE_COUNT; i++) {
        times.wall_ms[i] = values + (size_t)(2 * i) * PICTURES_MAX;
        times.cpu_ms[i] = values + (size_t)(2 * i + 1) * PICTURES_MAX;
    }
    for (uint32_t i = 0; i < BACK_END_STAGES_MAX; i++)
        times.part_ms[i] = values + (size_t)(2 * STAGE_COUNT + i) * PICTURES_MAX;
    open_bench(&bench, &options);
    pid_t child = options.beside ? begin_beside(options.threads == 1) : 0;
    if (options.beside && options.threads == 1)
        keep_to(1);
    run(&bench, &options, &times);
    if (options.beside)
        end_beside(child);
    tell(&options, &times);
    annotated_picture_close(&bench.chart);
    bench_scene_close(&bench.scene);
    free(values);
    return EXIT_OK;
}
