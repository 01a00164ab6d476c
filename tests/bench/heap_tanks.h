/* The tanks of the benchmark of heaps and their hulls. One thread. */
#ifndef JOLON_TESTS_BENCH_HEAP_TANKS_H
#define JOLON_TESTS_BENCH_HEAP_TANKS_H

#include "ipc/segment/segment.h"
#include "supervisor/physics/hull_shape.h"
#include "tests/bench/heap_engine.h"

#include <stdint.h>

/* The hulls that overlaps are measured with. */
struct heap_hulls {
    struct hull_shape *shape;
    uint32_t count;
    double reach_m; /* no vertex is farther from the origin */
};

struct heap_scene {
    struct view view;
    struct heap_tanks tanks;
    struct heap_hulls model, box; /* a tank's hulls, and a box of its size */
};

/* Makes a world of level ground with this many tanks in rings, which cannot be destroyed. Ends the
 * process (exit code 1) when the data cannot be read or memory is out. */
void heap_tanks_open(struct heap_scene *scene, uint32_t count);
void heap_tanks_close(struct heap_scene *scene);

#endif
