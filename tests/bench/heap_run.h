/* Drives a heap of tanks together in one engine and measures it. One thread. */
#ifndef JOLON_TESTS_BENCH_HEAP_RUN_H
#define JOLON_TESTS_BENCH_HEAP_RUN_H

#include "tests/bench/heap_tanks.h"

#include <stdbool.h>
#include <stdint.h>

#define HEAP_IMPACT_S 2.0  /* the first phase */
#define HEAP_REST_MPS 0.05 /* tanks that are all slower are at rest */

struct heap_result {
    uint32_t threads, frames;
    double cpu_ms, cpu_p99_ms, cpu_worst_ms; /* processor time of a step, of all threads, */
    double wall_ms;                          /* and its median length, while the tanks push */
    double caller_ms;    /* the median of the calling thread's processor time in a step */
    double rest_ms;      /* median processor time in the last ninth of the frames */
    double impact_m;     /* deepest overlap at the end of a frame of the first phase, */
    double steady_m;     /* of the frames in which the tanks push after that, */
    double end_m;        /* and of the last frame */
    uint32_t pairs;      /* in contact when the tanks stop pushing */
    uint64_t begins;     /* contacts that began until then */
    uint64_t collisions; /* told until then, by an engine that tells them; else as many */
    bool at_rest;        /* at the end */
    double fastest_mps;  /* at the end */
    uint64_t checksum;   /* of the last frame; 0: the engine has none */
};

/* Runs so many frames. The tanks push for two thirds of them. */
struct heap_result heap_run(const struct heap_engine *engine, const struct heap_scene *scene,
                            uint32_t threads, uint32_t frames);

#endif
