/* Worlds to measure on, in this process's own memory. */
#ifndef JOLON_TESTS_BENCH_WORLD_H
#define JOLON_TESTS_BENCH_WORLD_H

#include "ipc/segment/segment.h"

#include <stdint.h>

#define BENCH_SCENARIO_VEHICLES 500u

/* The scenario of a path, NULL for Hunter-Liggett, as it comes, or, with another number of vehicles
 * than Hunter-Liggett's own, its ground with so many on patrol. At frame 0; given up with
 * segment_abandon. Refused (exit 1) when the scenario cannot be read or memory is out. */
void bench_world_open(struct view *view, const char *path, uint32_t vehicles);

/* Hunter-Liggett's ground with so many armed vehicles of two forces all over it, on patrol and at
 * war: they engage whom they see. Otherwise the same. */
void bench_world_agents(struct view *view, uint32_t vehicles);

#endif
