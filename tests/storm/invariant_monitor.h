/* Checks what must hold at all times: no snapshot is torn, frame numbers never decrease, the
 * supervisor reaps its children. One thread takes snapshots, another looks for zombies. */
#ifndef JOLON_TESTS_STORM_INVARIANT_MONITOR_H
#define JOLON_TESTS_STORM_INVARIANT_MONITOR_H

#include "ipc/frame/snapshot.h"
#include "tests/storm/tested_set.h"

#include <pthread.h>

#define ZOMBIES_MAX 64

struct invariant_monitor {
    const struct tested_set *set;
    uint64_t seed;
    pthread_t snapshot_thread, zombie_thread;
    _Atomic bool end;
    struct snapshot snapshot;
    uint64_t snapshots, torn, backward; /* backward: older than the snapshot before */
    uint64_t missed;  /* snapshots given up, because the world overtook 100 copies in a row */
    uint64_t zombies; /* dead for more than a second beside a sleeping supervisor */
    struct zombie {
        int pid; /* 0: entry is free */
        uint64_t since_ns, looks;
        bool counted;
    } zombie[ZOMBIES_MAX];
};

/* Returns 0, or -1 with errno. */
int invariant_monitor_start(struct invariant_monitor *invariants, const struct tested_set *set,
                            uint64_t seed);
void invariant_monitor_stop(struct invariant_monitor *invariants);

#endif
