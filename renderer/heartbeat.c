/* The beating thread. */
#include "renderer/heartbeat.h"

#include "ipc/process/clock.h"
#include "ipc/frame/frame_protocol.h"

#include <errno.h>
#include <signal.h>

static void *beat(void *argument)
{
    struct heartbeat *pulse = argument;
    while (atomic_load_explicit(&pulse->ending, memory_order_acquire) == 0) {
        uint64_t now = clock_now_ns();
        if (now - atomic_load_explicit(&pulse->stage_ns, memory_order_relaxed) <
            HEARTBEAT_PATIENCE_NS)
            frame_protocol_beat(pulse->view);
        clock_sleep_until_ns(now + HEARTBEAT_INTERVAL_NS);
    }
    return NULL;
}

int heartbeat_start(struct heartbeat *pulse, struct view *view)
{
    pulse->view = view;
    atomic_store(&pulse->ending, 0);
    heartbeat_stage(pulse);
    /* Signals are the drawing thread's: they must wake its waits. */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int error = pthread_create(&pulse->thread, NULL, beat, pulse);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return error == 0 ? 0 : -1;
}

void heartbeat_stop(struct heartbeat *pulse)
{
    atomic_store_explicit(&pulse->ending, 1, memory_order_release);
    pthread_join(pulse->thread, NULL);
}

void heartbeat_stage(struct heartbeat *pulse)
{
    atomic_store_explicit(&pulse->stage_ns, clock_now_ns(), memory_order_relaxed);
}
