/* The renderer's sign of life. One picture may take longer than the supervisor waits for a beat,
 * so a thread beats for it, but only as long as the drawing thread goes on from stage to stage: a
 * renderer that hangs falls silent. */
#ifndef JOLON_RENDERER_PULSE_H
#define JOLON_RENDERER_PULSE_H

#include "ipc/segment.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>

#define PULSE_INTERVAL_NS 20000000u /* between two beats; far below the supervisor's patience */
#define PULSE_PATIENCE_NS                                                                          \
    20000000000ull /* that one stage may take: shaders on a loaded machine                         \
                    */

struct pulse {
    struct view *view;
    _Atomic uint64_t stage_ns; /* CLOCK_MONOTONIC when the drawing thread last went on */
    _Atomic uint32_t ending;
    pthread_t thread;
};

/* 0, or -1 with errno. The view must stay attached until pulse_stop(). */
int pulse_start(struct pulse *pulse, struct view *view);
void pulse_stop(struct pulse *pulse);

/* The drawing thread goes on to its next stage. */
void pulse_stage(struct pulse *pulse);

#endif
