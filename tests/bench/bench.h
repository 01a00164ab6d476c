/* jolon-bench: one function for each benchmark. A benchmark prints one line for each result, or one
 * object with --json. */
#ifndef JOLON_TESTS_BENCH_BENCH_H
#define JOLON_TESTS_BENCH_BENCH_H

#include "ipc/process/option_table.h"

#include <stdbool.h>
#include <stdint.h>

/* What the vehicles of a world to measure on do. */
#define BENCH_MODE_WORDS "scenario|idle|patrol|war|dense"
enum bench_mode {
    BENCH_MODE_SCENARIO, /* Hunter-Liggett's own; with another number of vehicles than its: patrol
                          */
    BENCH_MODE_IDLE,     /* stand all over the map */
    BENCH_MODE_PATROL,   /* are on crossing paths all over the map */
    BENCH_MODE_WAR,      /* two forces; they patrol, and attack all enemies that they see */
    BENCH_MODE_DENSE     /* patrol, with 800 square metres for each: 5,000 in a square of 2 km */
};

/* Returns the word of a mode in BENCH_MODE_WORDS. */
const char *bench_mode_word(enum bench_mode mode);

struct bench_options {
    uint32_t vehicles, threads, frames;
    int mode;        /* enum bench_mode */
    uint32_t burst;  /* bombs */
    uint32_t settle; /* frames before those that are measured */
    bool json, peers, agents, driven, cruise, gl, beside, all;
    struct option_size size; /* of one picture */
    double seconds;
    uint32_t follow;  /* entity id, 0: the most active vehicle */
    const char *kind; /* NULL: all */
    const char *out;  /* folder for some of the pictures, NULL: none */
    const char *file; /* the argument besides the options, NULL: none */
};

int bench_battle(struct bench_options options);   /* agents/battle.c */
int bench_detect(struct bench_options options);   /* detect.c */
int bench_handover(struct bench_options options); /* handover.c */
int bench_encode(struct bench_options options);   /* encode.c */
int bench_frame(struct bench_options options);    /* frame.c */
int bench_heap(struct bench_options options);     /* heap.c */
int bench_methods(struct bench_options options);  /* methods.c */
int bench_models(struct bench_options options);   /* models.c */
int bench_render(struct bench_options options);   /* render.c */
int bench_shapes(struct bench_options options);   /* shapes.c */
int bench_traffic(struct bench_options options);  /* agents/traffic.c */

/* Returns the value at or below which this fraction (0..1) of the values lies. Sorts the values. */
double bench_quantile(double *values, uint32_t count, double fraction);

#endif
