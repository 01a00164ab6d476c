/* How far a step is: a counter that goes up while it works. Who watches the process tells by it a
 * frame that is long from one that hangs. Nothing in a result depends on it. */
#ifndef JOLON_WORLD_RUNTIME_WORK_DONE_H
#define JOLON_WORLD_RUNTIME_WORK_DONE_H

#include <stdatomic.h>
#include <stdint.h>

/* The process's counter: its own until work_done_into() names another. */
extern _Atomic uint64_t *work_done_counter;

/* From now on this one is counted up, for as long as the process lives. Before the first thread. */
void work_done_into(_Atomic uint64_t *counter);

/* A piece of work is done: a block of rows, a strip, a contact, a sweep of the solver. Any thread.
 */
static inline void work_done(void)
{
    atomic_fetch_add_explicit(work_done_counter, 1, memory_order_relaxed);
}

#endif
