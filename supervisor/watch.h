/* The watch: finds processes of the set that hang and kills them.
 *
 * A role hangs when its heart stands still for longer than it may: stopped by a signal, blocked, or
 * running in circles. One that wants to run and is not let is starved by the machine, and no
 * replacement would do better. A watcher that itself stood still judges nobody by that time. */
#ifndef JOLON_SUPERVISOR_WATCH_H
#define JOLON_SUPERVISOR_WATCH_H

#include "supervisor/set.h"

#define WATCH_TICK_NS (10 * (uint64_t)NS_PER_MS) /* how often to look */

struct watch {
    uint64_t last_ns;  /* of the look before */
    uint64_t since_ns; /* silence counts from here */
};

/* One look at everybody. Kills; the deaths are the caller's to wait for. Call at least every
 * WATCH_TICK_NS; later calls mean that the watcher itself was held up. */
void watch_turn(struct watch *watch, struct set *set, uint64_t now_ns);

#endif
