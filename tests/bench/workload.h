/* The workload W(n) on which engines are compared: the level 50 km square, the fixed objects of
 * Table 1 at their places in Hunter-Liggett as spheres, and n spheres of 3 m that move at 0 to 16.6
 * m/s in any direction, in steps of 1/60 s. Each touch of approaching bodies begins one contact,
 * and the bodies bounce: they exchange the velocity components along the line of centres. A fixed
 * object reverses the component. The contacts of a step are ordered by their bodies, so a run
 * depends neither on the engine's threads nor on its data structures. Equal counts of contacts show
 * that engines did the same work. */
#ifndef JOLON_TESTS_BENCH_WORKLOAD_H
#define JOLON_TESTS_BENCH_WORKLOAD_H

#include "tests/bench/engine.h"

#include <stdint.h>

struct workload {
    struct engine_scene scene;
    uint64_t contacts, fixed_contacts; /* begun: all, and those with fixed objects */
};

/* Ends the process (exit code 1) when the scenario cannot be read. */
void workload_open(struct workload *workload, uint32_t vehicles);
void workload_close(struct workload *workload);

/* Resets all bodies to the beginning. */
void workload_rewind(struct workload *workload);

/* Orders the touches by their bodies, bounces approaching bodies, then moves all bodies by a step.
 */
void workload_step(struct workload *workload, struct engine_touches *touches);

#endif
