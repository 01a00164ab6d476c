/* A burst of bombs: rows that are in use for a second, after which a world should cost what it did
 * before. */
#ifndef JOLON_TESTS_BENCH_BURST_H
#define JOLON_TESTS_BENCH_BURST_H

#include "ipc/segment/segment.h"

#include <stdint.h>

/* Adds bombs to the committed frame, spread over the map at BURST_HEIGHT_M. Their lives end one to
 * two seconds later, high above everything else. No stage may have begun the next frame, and the
 * steps that computed the last one do not go on: the next frame is computed by new ones. Ends the
 * process (exit code 1) if the world has no room for them. */
#define BURST_HEIGHT_M 8000.0
void burst_drop(struct view *view, uint32_t bombs);

#endif
