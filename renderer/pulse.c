/* The beating thread. */
#include "renderer/pulse.h"

#include "ipc/clock.h"
#include "ipc/frame.h"

#include <errno.h>
#include <signal.h>

static void *beat(void *argument)
{
    struct pulse *pulse = argument;
    while (atomic_load_explicit(&pulse->ending, memory_order_acquire) == 0) {
        uint64_t now = clock_now_ns();
        if (now - atomic_load_explicit(&pulse->stage_ns, memory_order_relaxed) < PULSE_PATIENCE_NS)
            frame_beat(pulse->view);
        clock_sleep_until_ns(now + PULSE_INTERVAL_NS);
    }
    return NULL;
}

int pulse_start(struct pulse *pulse, struct view *view)
{
    pulse->view = view;
    atomic_store(&pulse->ending, 0);
    pulse_stage(pulse);
    /* Signals are the drawing thread's: they must wake its waits. */
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int error = pthread_create(&pulse->thread, NULL, beat, pulse);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return error == 0 ? 0 : -1;
}

void pulse_stop(struct pulse *pulse)
{
    atomic_store_explicit(&pulse->ending, 1, memory_order_release);
    pthread_join(pulse->thread, NULL);
}

void pulse_stage(struct pulse *pulse)
{
    atomic_store_explicit(&pulse->stage_ns, clock_now_ns(), memory_order_relaxed);
}
