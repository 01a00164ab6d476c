/* The renderer's heartbeat. One picture may take longer than the supervisor waits for a beat, so a
 * thread of its own beats. It stops when the drawing thread stays in one stage for too long, so
 * that the supervisor notices a renderer that hangs. */
#ifndef JOLON_RENDERER_HEARTBEAT_H
#define JOLON_RENDERER_HEARTBEAT_H

#include "ipc/segment/segment.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>

#define HEARTBEAT_INTERVAL_NS  20000000u      /* far below the supervisor's time limit */
#define HEARTBEAT_STAGE_MAX_NS 20000000000ull /* compiling shaders on a loaded machine is slow */

struct heartbeat {
    struct view *view;
    _Atomic uint64_t stage_ns; /* CLOCK_MONOTONIC when the present stage began */
    _Atomic uint32_t ending;
    pthread_t thread;
};

/* Starts the thread. The view must stay attached until heartbeat_stop(). Returns 0, or -1 with
 * errno. */
int heartbeat_start(struct heartbeat *heartbeat, struct view *view);
void heartbeat_stop(struct heartbeat *heartbeat);

/* Begins the next stage. Called by the drawing thread. */
void heartbeat_stage(struct heartbeat *heartbeat);

#endif
