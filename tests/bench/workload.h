/* The workload that engines are measured on side by side, W(n): the 50 km square, flat; the fixed
 * objects of Table 1 where Hunter Liggett has them, as spheres; n spheres of 3 m that move at 0 to
 * 16.6 m/s in any direction, in steps of 1/60 s. Whatever an engine finds to touch while coming
 * nearer is one contact begun and bounces: the component along the line of centres is exchanged, or
 * turned round by a fixed object. The contacts of a step are bounced in the order of their bodies,
 * whatever order an engine found them in. So a run depends neither on the engine's threads nor on
 * its structures, and the counts of contacts tell that the work was the same. */
#ifndef JOLON_TESTS_BENCH_WORKLOAD_H
#define JOLON_TESTS_BENCH_WORKLOAD_H

#include "tests/bench/engine.h"

#include <stdint.h>

struct workload {
    struct engine_scene scene;
    uint64_t contacts, fixed_contacts; /* begun: all, and those with fixed objects */
};

/* Refused (exit 1) when the scenario cannot be read. */
void workload_open(struct workload *workload, uint32_t vehicles);
void workload_close(struct workload *workload);

/* Everything back to where it began. */
void workload_rewind(struct workload *workload);

/* Puts the touches in the order of their bodies, bounces what comes nearer, then moves all bodies
 * by a step. */
void workload_step(struct workload *workload, struct engine_touches *touches);

#endif
