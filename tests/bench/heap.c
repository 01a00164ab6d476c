/* Measures heaps: rings of tanks drive inwards and press on each other, in Jolon and in other
 * engines. */
#include "tests/bench/bench.h"
#include "tests/bench/heap_run.h"

#include "ipc/process/log.h"

#include <stdio.h>

static const struct heap_engine *const engines[] = {&heap_jolon, &heap_bullet, &heap_ode};

#define ENGINES (sizeof engines / sizeof engines[0])

static double a_pair(const struct heap_result *result, uint64_t count)
{
    return result->pairs > 0 ? (double)count / result->pairs : 0.0;
}

static void print_row(const char *name, const struct heap_result *result)
{
    printf("%-7s %7u %8.3f %8.3f %8.3f %8.3f %8.3f %8.2f %8.2f %8.2f %6u %7.2f %7.2f  %s\n", name,
           result->threads, result->cpu_ms, result->cpu_p99_ms, result->cpu_worst_ms,
           result->wall_ms, result->rest_ms, 1e3 * result->impact_m, 1e3 * result->steady_m,
           1e3 * result->end_m, result->pairs, a_pair(result, result->begins),
           a_pair(result, result->collisions), result->at_rest ? "yes" : "no");
    fflush(stdout);
}

static void print_member(const char *name, const struct heap_result *result)
{
    printf("{\"engine\":\"%s\",\"threads\":%u,\"cpu_ms\":%.6f,\"cpu_p99_ms\":%.6f,"
           "\"cpu_worst_ms\":%.6f,\"wall_ms\":%.6f,\"caller_ms\":%.6f,\"rest_ms\":%.6f,"
           "\"impact_mm\":%.4f,\"steady_mm\":%.4f,\"end_mm\":%.4f,\"pairs\":%u,",
           name, result->threads, result->cpu_ms, result->cpu_p99_ms, result->cpu_worst_ms,
           result->wall_ms, result->caller_ms, result->rest_ms, 1e3 * result->impact_m,
           1e3 * result->steady_m, 1e3 * result->end_m, result->pairs);
    printf("\"begins\":%llu,\"begins_a_pair\":%.4f,\"collisions\":%llu,"
           "\"collisions_a_pair\":%.4f,\"fastest_mps\":%.6f,\"checksum\":\"%016llx\","
           "\"at_rest\":%s}",
           (unsigned long long)result->begins, a_pair(result, result->begins),
           (unsigned long long)result->collisions, a_pair(result, result->collisions),
           result->fastest_mps, (unsigned long long)result->checksum,
           result->at_rest ? "true" : "false");
}

static void print_head(const struct bench_options *options)
{
    printf(options->json ? "{\"vehicles\":%u,\"frames\":%u,\"engines\":["
                         : "%u tanks, %u frames; CPU ms of a step, overlap in mm\n",
           options->vehicles, options->frames);
    if (!options->json)
        printf("%-7s %7s %8s %8s %8s %8s %8s %8s %8s %8s %6s %7s %7s  %s\n", "engine", "threads",
               "median", "p99", "worst", "wall ms", "at rest", "impact", "steady", "end", "pairs",
               "begins", "told", "rests");
}

int bench_heap(struct bench_options options)
{
    struct heap_scene scene;
    heap_tanks_open(&scene, options.vehicles);
    print_head(&options);
    for (size_t i = 0; i < (options.peers ? ENGINES : 1); i++) {
        struct heap_result result = heap_run(engines[i], &scene, options.threads, options.frames);
        if (!options.json) {
            print_row(engines[i]->name, &result);
            continue;
        }
        printf("%s", i > 0 ? "," : "");
        print_member(engines[i]->name, &result);
    }
    if (options.json)
        printf("]}\n");
    heap_tanks_close(&scene);
    return EXIT_OK;
}
