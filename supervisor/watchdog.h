/* The watchdog: finds processes of the set that hang, and kills them.
 *
 * A role hangs when its heartbeat stands still for longer than allowed: it is stopped by a signal,
 * blocked, or in an endless loop. A runnable process may get no processor time. Restarting it would
 * not help, so the watchdog leaves it alone. After a time in which the watchdog itself stood still,
 * silence is counted anew.
 *
 * Mover and collider beat between frames and count their work within them
 * (world/runtime/work_done.h). If the heartbeat stands still while the work goes on, the frame is
 * long, and a new process would have to begin it again. The watchdog logs that once and leaves the
 * role alone, but for no longer than WATCHDOG_FRAME_MAX_NS, as an endless loop may count work,
 * too. */
#ifndef JOLON_SUPERVISOR_WATCHDOG_H
#define JOLON_SUPERVISOR_WATCHDOG_H

#include "supervisor/process_set.h"

#define WATCHDOG_TICK_NS      (10 * (uint64_t)NS_PER_MS) /* interval of the checks */
#define WATCHDOG_FRAME_MAX_NS (300 * (uint64_t)NS_PER_S) /* longest frame, wall-clock time */

struct watchdog {
    uint64_t last_ns;  /* time of the last check */
    uint64_t since_ns; /* silence counts from here */
};

/* Checks every role and kills those that hang; the caller waits for the deaths. Call at least every
 * WATCHDOG_TICK_NS. A later call means that the watchdog itself was held up. */
void watchdog_check(struct watchdog *watchdog, struct process_set *set, uint64_t now_ns);

#endif
