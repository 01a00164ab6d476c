/* The storm: kills and stops the processes of a real set at random, and checks that nothing is
 * torn, lost, repeated or leaked. A strike is one signal to one process.
 *
 *   storm.c              options and the storm itself
 *   tested_set.c         starts and stops the set, finds its processes and what it leaves behind
 *   fault_injector.c     draws the strikes and sends their signals
 *   recovery_monitor.c   observes the commits and measures each recovery
 *   invariant_monitor.c  takes snapshots and looks for zombies
 *   sender.c             sends commands, each repeated until it is answered
 *   consistency.c        compares the event log and the digest with the undisturbed run
 *   report.c             prints the results
 *
 * Threads: main (strikes), the recovery monitor, the reader of snapshots, the search for zombies,
 * the sender. Only the thread that counts something uses the count until the thread has ended. */
#ifndef JOLON_TESTS_STORM_STORM_H
#define JOLON_TESTS_STORM_STORM_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#define STORM_PATH_MAX 512

struct storm_options {
    const char *world; /* the set's world */
    const char *scenario;
    const char *out; /* folder; made here, and removed after a good end unless the user named it */
    char bin[STORM_PATH_MAX - 64];
    uint64_t kills, seed;
    uint64_t commands; /* sent during the storm; 0: the set has no reporter */
    double gap_ms;     /* longest gap between two rounds */
    double hang_ms;    /* the keeper's hang limit */
    bool renderer, json, keep;
};

/* What a strike does to a process. */
enum fault_kind {
    FAULT_KILL,
    FAULT_STOP,          /* not continued: the process must be replaced */
    FAULT_STOP_CONTINUE, /* continued at about the time of its replacement */
    FAULT_COUNT
};

#define STRUCK_ROLES      ROLE_COUNT
#define STRUCK_SUPERVISOR STRUCK_ROLES /* its row in the counts of strikes */

/* splitmix64, the only source of randomness of the storm */
struct prng {
    uint64_t state;
};

uint64_t prng_next(struct prng *prng);
double prng_unit(struct prng *prng);                  /* [0, 1) */
uint64_t prng_below(struct prng *prng, uint64_t end); /* 0 .. end - 1 */

#endif
