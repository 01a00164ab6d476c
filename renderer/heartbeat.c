/* The heartbeat thread. */
#include "renderer/heartbeat.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"

#include <errno.h>
#include <signal.h>

static void *beat(void *argument)
{
    struct heartbeat *heartbeat = argument;
    while (atomic_load_explicit(&heartbeat->ending, memory_order_acquire) == 0) {
        uint64_t now = clock_now_ns();
        if (now - atomic_load_explicit(&heartbeat->stage_ns, memory_order_relaxed) <
            HEARTBEAT_STAGE_MAX_NS)
            frame_protocol_beat(heartbeat->view);
        clock_sleep_until_ns(now + HEARTBEAT_INTERVAL_NS);
    }
    return NULL;
}

int heartbeat_start(struct heartbeat *heartbeat, struct view *view)
{
    heartbeat->view = view;
    atomic_store(&heartbeat->ending, 0);
    heartbeat_stage(heartbeat);
    /* Signals must go to the drawing thread, to interrupt its waits. */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int error = pthread_create(&heartbeat->thread, NULL, beat, heartbeat);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return error == 0 ? 0 : -1;
}

void heartbeat_stop(struct heartbeat *heartbeat)
{
    atomic_store_explicit(&heartbeat->ending, 1, memory_order_release);
    pthread_join(heartbeat->thread, NULL);
}

void heartbeat_stage(struct heartbeat *heartbeat)
{
    atomic_store_explicit(&heartbeat->stage_ns, clock_now_ns(), memory_order_relaxed);
}
