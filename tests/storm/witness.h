/* Witnesses of what must never be seen: torn snapshots, frames that go back, zombies that nobody
 * waits for. A thread each. */
#ifndef JOLON_TESTS_STORM_WITNESS_H
#define JOLON_TESTS_STORM_WITNESS_H

#include "ipc/frame/snapshot.h"
#include "tests/storm/band.h"

#include <pthread.h>

#define ZOMBIES_MAX 64

struct witness {
    const struct band *band;
    uint64_t seed;
    pthread_t reader, housekeeper;
    _Atomic bool end;
    struct snapshot snapshot;
    uint64_t snapshots, torn, back; /* back: of an older frame than the one before */
    uint64_t missed;                /* the world was faster than the copy, 100 times in a row */
    uint64_t zombies; /* dead for more than a second, and the supervisor does not care */
    struct zombie {
        int pid; /* 0: no entry */
        uint64_t since_ns, looks;
        bool counted;
    } zombie[ZOMBIES_MAX];
};

/* 0, or -1 with errno. */
int witness_start(struct witness *witness, const struct band *band, uint64_t seed);
void witness_stop(struct witness *witness);

#endif
