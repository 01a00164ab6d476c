/* jolon-bench: one function a benchmark. Each reads its own arguments (argv[0] is its name) and
 * prints a line a result; --json prints objects. */
#ifndef JOLON_TESTS_BENCH_BENCH_H
#define JOLON_TESTS_BENCH_BENCH_H

#include <stdbool.h>
#include <stdint.h>

#define BENCH_SIDE_MIN 64u /* [pixel] of pictures */
#define BENCH_SIDE_MAX 4096u

struct bench_options {
    uint32_t vehicles, threads, frames;
    bool json, peers, agents;
};

/* An option that is not there, or without its value: ends the process (exit 2). */
_Noreturn void bench_refuse(const char *option);

/* --vehicles N, --threads T, --frames F, --peers, --json, --agents; wrong usage ends the process
 * (exit 2). */
struct bench_options bench_options(int argc, char **argv, struct bench_options defaults);

int bench_detect(int argc, char **argv);   /* detect.c */
int bench_handover(int argc, char **argv); /* handover.c */
int bench_encode(int argc, char **argv);   /* encode.c */
int bench_frame(int argc, char **argv);    /* frame.c */
int bench_methods(int argc, char **argv);  /* methods.c */
int bench_models(int argc, char **argv);   /* models.c */
int bench_render(int argc, char **argv);   /* render.c */
int bench_shapes(int argc, char **argv);   /* shapes.c */
int bench_traffic(int argc, char **argv);  /* traffic.c */

/* The fraction (0..1) of the values that lie at or below the result; sorts them. */
double bench_quantile(double *values, uint32_t count, double fraction);

#endif
