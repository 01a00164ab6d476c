/* Progress of a step: a counter that increases while the step works. By it the watchdog
 * distinguishes a long frame from a process that hangs. No result depends on it. */
#ifndef JOLON_WORLD_RUNTIME_WORK_DONE_H
#define JOLON_WORLD_RUNTIME_WORK_DONE_H

#include <stdatomic.h>
#include <stdint.h>

/* The counter in use: the process's own until work_done_into() sets another. */
extern _Atomic uint64_t *work_done_counter;

/* Sets the counter, which must exist for as long as the process lives. Call it before the first
 * thread starts. */
void work_done_into(_Atomic uint64_t *counter);

/* Counts a unit of work: a block of rows, a strip, a contact, a sweep of the solver. Any thread. */
static inline void work_done(void)
{
    atomic_fetch_add_explicit(work_done_counter, 1, memory_order_relaxed);
}

/* Counts a piece of a job (world/runtime/thread_pool.h) if it is the caller's. The counter is one
 * for all threads, and two that count short pieces wait for each other. */
static inline void work_done_by(uint32_t worker)
{
    if (worker == 0)
        work_done();
}

#endif
