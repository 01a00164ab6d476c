/* jolon-bench: measures the parts of Jolon and, for comparison, their limits. */
#include "tests/bench/bench.h"

#include "ipc/process/log.h"
#include "tests/bench/world.h"

#include <stdio.h>
#include <string.h>

static const struct bench {
    const char *name;
    int (*run)(struct bench_options options);
    const char *usage; /* the options that the benchmark takes */
    struct bench_options defaults;
} benches[] = {
    {"handover",
     bench_handover,
     "[--frames F] [--json]     a frame without work, beside a bare futex ping-pong",
     {.frames = 20000}},
    {"battle",
     bench_battle,
     "[--threads T] [--frames F] [SCENARIO]     shots, losses and pushing in a battle",
     {.threads = 1, .frames = 108000}},
    {"detect",
     bench_detect,
     "[--vehicles N] [--threads T] [--frames F] [--peers] [--json]     detection beside ODE, "
     "Bullet",
     {.vehicles = 500, .threads = 1}},
    {"encode",
     bench_encode,
     "[--size WxH] [--frames F] [--json]     a picture as PNG, JPEG and video",
     {.size = {1280, 720}, .frames = 120}},
    {"frame",
     bench_frame,
     "[--vehicles N] [--mode MODE] [--agents] [--driven] [--cruise] [--burst N] [--settle F] "
     "[--threads T] "
     "[--frames F] [--json]     the steps of a frame; MODE: scenario, idle, patrol, war or dense; "
     "--agents: as --mode war; --driven: all land vehicles on their springs; --cruise: vehicles "
     "may cruise; --burst: again after "
     "N bombs; --settle: after F frames",
     {.vehicles = BENCH_SCENARIO_VEHICLES, .threads = 1, .frames = 1200}},
    {"heap",
     bench_heap,
     "[--vehicles N] [--threads T] [--frames F] [--peers] [--json]     tanks that press on each "
     "other, beside Bullet, ODE",
     {.vehicles = 90, .threads = 1, .frames = 900}},
    {"methods",
     bench_methods,
     "[--vehicles N] [--json]     the ways to detect, for a thousand bodies up to N",
     {.vehicles = 1000000}},
    {"models",
     bench_models,
     "[--kind NAME] [--size WxH] [--gl] FILE     what models look like",
     {.size = {320, 240}}},
    {"render",
     bench_render,
     "[--gl] [--size WxH] [--seconds S] [--threads T] [--beside] [--follow ID] [--out DIR "
     "[--all]] "
     "[--json]     a picture's stages",
     {.size = {1280, 720}, .threads = 1, .seconds = 5.0}},
    {"shapes",
     bench_shapes,
     "[--frames SAMPLES] [--json]     what spheres get wrong",
     {.frames = 20000}},
    {"traffic",
     bench_traffic,
     "[--vehicles N] [--threads T] [--frames F] [--json]     what agents run into",
     {.vehicles = BENCH_SCENARIO_VEHICLES, .threads = 1, .frames = 36000}},
};

#define BENCHES (sizeof benches / sizeof benches[0])

static struct bench_options given;

static const struct option_row rows[] = {
    {"vehicles", "N", NULL, .u32 = &given.vehicles, .least = 1, .most = 1000000},
    {"threads", "T", NULL, .u32 = &given.threads, .least = 1, .most = 16},
    {"frames", "F", NULL, .u32 = &given.frames, .least = 1, .most = 10000000},
    {"mode", BENCH_MODE_WORDS, NULL, .choice = &given.mode},
    {"burst", "N", NULL, .u32 = &given.burst, .most = 500000},
    {"settle", "F", NULL, .u32 = &given.settle, .most = 1000000},
    {"size", "WxH", NULL, .size = &given.size, .least = 64, .most = 4096},
    {"seconds", "S", NULL, .real = &given.seconds, .high = 3600.0},
    {"follow", "ID", NULL, .u32 = &given.follow, .most = UINT32_MAX},
    {"kind", "NAME", NULL, .text = &given.kind},
    {"out", "DIR", NULL, .text = &given.out},
    {"peers", NULL, NULL, .flag = &given.peers},
    {"driven", NULL, NULL, .flag = &given.driven},
    {"cruise", NULL, NULL, .flag = &given.cruise},
    {"agents", NULL, NULL, .flag = &given.agents},
    {"beside", NULL, NULL, .flag = &given.beside},
    {"all", NULL, NULL, .flag = &given.all},
    {"gl", NULL, NULL, .flag = &given.gl},
    {"json", NULL, NULL, .flag = &given.json},
    OPTION_ROWS_END};

static int run(const struct bench *bench, int argc, char **argv)
{
    char program[64];
    (void)snprintf(program, sizeof program, "jolon-bench %s", bench->name);
    const struct option_table table = {
        .program = program,
        .usage = bench->usage,
        .rows = rows,
        .usage_rows = true,
        .plain = (bench->run == bench_models || bench->run == bench_battle)};
    given = bench->defaults;
    if (option_table_read(&table, argc, argv) > 0)
        given.file = argv[argc - 1];
    return bench->run(given);
}

int main(int argc, char **argv)
{
    log_open("bench");
    for (size_t i = 0; argc > 1 && i < BENCHES; i++) {
        if (strcmp(argv[1], benches[i].name) == 0)
            return run(&benches[i], argc - 1, argv + 1);
    }
    if (argc > 1 && strcmp(argv[1], "help") != 0 && strcmp(argv[1], "--help") != 0 &&
        strcmp(argv[1], "-h") != 0)
        die_usage("%s: no such benchmark; try jolon-bench help", argv[1]);
    FILE *to = argc > 1 ? stdout : stderr;
    fprintf(to, "usage: jolon-bench BENCHMARK ...\n");
    for (size_t i = 0; i < BENCHES; i++)
        fprintf(to, "  %-8s %s\n", benches[i].name, benches[i].usage);
    return argc > 1 ? EXIT_OK : EXIT_USAGE;
}
