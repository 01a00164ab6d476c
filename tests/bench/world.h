/* Worlds to measure on, in this process's memory. */
#ifndef JOLON_TESTS_BENCH_WORLD_H
#define JOLON_TESTS_BENCH_WORLD_H

#include "ipc/segment/segment.h"
#include "tests/bench/bench.h"
#include "tests/bench/heap_engine.h"

#include <stdint.h>

#define BENCH_SCENARIO_VEHICLES 500u
#define BENCH_MIDDLE_M          25000.0 /* x and z of the middle of the world */

/* Makes the world of a scenario at frame 0; NULL: Hunter-Liggett. With another number of vehicles
 * than Hunter-Liggett's, the world is its ground with this many vehicles on patrol.
 * segment_abandon() frees it. Ends the process (exit code 1) when the scenario cannot be read or
 * memory is out. */
void bench_world_open(struct view *view, const char *path, uint32_t vehicles);

/* Makes a world on Hunter-Liggett's ground whose vehicles do what the mode says, with room for this
 * many rows more. Otherwise the same. */
void bench_world_mode(struct view *view, enum bench_mode mode, uint32_t vehicles, uint32_t more);

/* Makes a world of level ground with tanks at places relative to its middle, which cannot be
 * destroyed and move forward at HEAP_SPEED_MPS. Row i holds tank i. Otherwise the same. */
void bench_world_tanks(struct view *view, const struct heap_tanks *tanks);

#endif
