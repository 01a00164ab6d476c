/* jolon-bench: measures the parts of Jolon, each beside what bounds it. */
#include "tests/bench/bench.h"

#include "ipc/process/log.h"
#include "ipc/process/process.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Noreturn void bench_refuse(const char *option)
{
    die_usage("%s: no such option, or its value is missing; try jolon-bench help", option);
}

struct bench_options bench_options(int argc, char **argv, struct bench_options chosen)
{
    static const struct option options[] = {{"vehicles", required_argument, NULL, 'v'},
                                            {"threads", required_argument, NULL, 't'},
                                            {"frames", required_argument, NULL, 'f'},
                                            {"peers", no_argument, NULL, 'p'},
                                            {"json", no_argument, NULL, 'j'},
                                            {"agents", no_argument, NULL, 'a'},
                                            {NULL, 0, NULL, 0}};
    int option;
    while ((option = getopt_long(argc, argv, "", options, NULL)) != -1) {
        switch (option) {
        case 'v':
            chosen.vehicles = (uint32_t)process_whole("vehicles", optarg, 1, 1000000);
            break;
        case 't':
            chosen.threads = (uint32_t)process_whole("threads", optarg, 1, 16);
            break;
        case 'f':
            chosen.frames = (uint32_t)process_whole("frames", optarg, 1, 10000000);
            break;
        case 'p':
            chosen.peers = true;
            break;
        case 'j':
            chosen.json = true;
            break;
        case 'a':
            chosen.agents = true;
            break;
        default:
            bench_refuse(argv[optind - 1]);
        }
    }
    if (optind < argc)
        die_usage("%s: one argument too many; try jolon-bench help", argv[optind]);
    return chosen;
}

static int ascending(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

double bench_quantile(double *values, uint32_t count, double fraction)
{
    qsort(values, count, sizeof *values, ascending);
    return count ? values[(uint32_t)(fraction * (double)(count - 1) + 0.5)] : 0.0;
}

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *usage;
} benches[] = {
    {"handover", bench_handover,
     "[--frames F] [--json]     a frame without work, beside a bare futex ping-pong"},
    {"detect", bench_detect,
     "[--vehicles N] [--threads T] [--frames F] [--peers] [--json]     detection beside ODE, "
     "Bullet"},
    {"encode", bench_encode,
     "[--size WxH] [--frames F] [--json]     a picture as PNG, JPEG and video"},
    {"frame", bench_frame,
     "[--vehicles N [--agents]] [--threads T] [--frames F] [--json]     the steps of a frame; "
     "--agents: of two forces at war"},
    {"methods", bench_methods,
     "[--vehicles N] [--json]     the ways to detect, for a thousand bodies up to N"},
    {"models", bench_models, "[--kind NAME] [--size WxH] [--gl] FILE     what models look like"},
    {"render", bench_render,
     "[--gl] [--size WxH] [--seconds S] [--threads T] [--beside] [--follow ID] [--out DIR "
     "[--all]] "
     "[--json]     a picture's stages"},
    {"shapes", bench_shapes, "[--frames SAMPLES] [--json]     what spheres get wrong"},
    {"traffic", bench_traffic,
     "[--vehicles N] [--threads T] [--frames F] [--json]     what agents run into"},
};

#define BENCHES (sizeof benches / sizeof benches[0])

static bool asks_help(int argc, char **argv)
{
    for (int i = 0; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)
            return true;
    }
    return false;
}

int main(int argc, char **argv)
{
    log_open("bench");
    opterr = 0; /* we say it, in one line */
    for (size_t i = 0; argc > 1 && i < BENCHES; i++) {
        if (strcmp(argv[1], benches[i].name) != 0)
            continue;
        if (!asks_help(argc - 1, argv + 1))
            return benches[i].run(argc - 1, argv + 1);
        printf("usage: jolon-bench %s %s\n", benches[i].name, benches[i].usage);
        return EXIT_OK;
    }
    if (argc > 1 && strcmp(argv[1], "help") != 0 && !asks_help(2, argv))
        die_usage("%s: no such benchmark; try jolon-bench help", argv[1]);
    FILE *to = argc > 1 ? stdout : stderr;
    fprintf(to, "usage: jolon-bench BENCHMARK ...\n");
    for (size_t i = 0; i < BENCHES; i++)
        fprintf(to, "  %-8s %s\n", benches[i].name, benches[i].usage);
    return argc > 1 ? EXIT_OK : EXIT_USAGE;
}
