/* The renderer's sign of life. One picture may take longer than the supervisor waits for a beat,
 * so a thread beats for it, but only as long as the drawing thread goes on from stage to stage: a
 * renderer that hangs falls silent. */
#ifndef JOLON_RENDERER_HEARTBEAT_H
#define JOLON_RENDERER_HEARTBEAT_H

#include "ipc/segment/segment.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>

#define HEARTBEAT_INTERVAL_NS                                                                      \
    20000000u /* between two beats; far below the supervisor's patience                            \
               */
#define HEARTBEAT_PATIENCE_NS                                                                      \
    20000000000ull /* that one stage may take: shaders on a loaded machine                         \
                    */

struct heartbeat {
    struct view *view;
    _Atomic uint64_t stage_ns; /* CLOCK_MONOTONIC when the drawing thread last went on */
    _Atomic uint32_t ending;
    pthread_t thread;
};

/* 0, or -1 with errno. The view must stay attached until heartbeat_stop(). */
int heartbeat_start(struct heartbeat *heartbeat, struct view *view);
void heartbeat_stop(struct heartbeat *heartbeat);

/* The drawing thread goes on to its next stage. */
void heartbeat_stage(struct heartbeat *heartbeat);

#endif
