/* How deep tanks are inside each other, by the separating axes of the physics check, which shares
 * no code with the collider. One thread. */
#ifndef JOLON_TESTS_BENCH_HEAP_OVERLAP_H
#define JOLON_TESTS_BENCH_HEAP_OVERLAP_H

#include "tests/bench/heap_tanks.h"

#include <stdint.h>

/* Returns the greatest depth of two hulls of different bodies [m], or least_m if none is deeper. */
double heap_overlap_deepest(const struct heap_hulls *hulls, const struct heap_body *body,
                            uint32_t count, double least_m);

#endif
