/* The watch: finds processes of the set that hang and kills them.
 *
 * A role hangs when its heart stands still for longer than it may: stopped by a signal, blocked, or
 * running in circles. A role that wants to run and is not let is starved by the machine, and no
 * replacement would do better. A watcher that itself stood still judges nobody by that time.
 *
 * Mover and collider beat between frames and count their work within them
 * (world/runtime/work_done.h). One whose heart stands still while its work goes on has a long
 * frame, which a replacement would have to begin anew: the watch says so once and leaves it alone,
 * but for no longer than WATCHDOG_FRAME_MAX_NS, since a loop without an end may count, too. */
#ifndef JOLON_SUPERVISOR_WATCHDOG_H
#define JOLON_SUPERVISOR_WATCHDOG_H

#include "supervisor/process_set.h"

#define WATCHDOG_TICK_NS      (10 * (uint64_t)NS_PER_MS) /* how often to look */
#define WATCHDOG_FRAME_MAX_NS (300 * (uint64_t)NS_PER_S) /* one frame's work, of the clock */

struct watchdog {
    uint64_t last_ns;  /* of the look before */
    uint64_t since_ns; /* silence counts from here */
};

/* One look at everybody. Kills; the deaths are the caller's to wait for. Call at least every
 * WATCHDOG_TICK_NS; later calls mean that the watcher itself was held up. */
void watchdog_turn(struct watchdog *watchdog, struct process_set *set, uint64_t now_ns);

#endif
