/* The storm: a real set of processes, killed and stopped at random, and an account of it at the
 * end.
 *
 *   storm.c     options and the storm itself
 *   band.c      the set: its start, its supervisor, its processes, what it leaves behind
 *   victim.c    what is done to whom, and when
 *   watcher.c   the commits as they come, and how long each recovery took
 *   witness.c   snapshots taken all the time, and zombies
 *   sender.c    commands over the command socket, each repeated until it is answered
 *   accounts.c  the event log and the digest against the undisturbed run
 *   report.c    the table
 *
 * Threads: main (strikes), the watcher of commits, the reader of snapshots, the housekeeper, the
 * sender. What a thread counts is its own until it has ended. */
#ifndef JOLON_TESTS_STORM_STORM_H
#define JOLON_TESTS_STORM_STORM_H

#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#define STORM_PATH_MAX 512

struct storm_options {
    const char *world; /* name of the set */
    const char *scenario;
    const char *out; /* folder; made, and removed after a good end unless it was named */
    char bin[STORM_PATH_MAX - 64];
    uint64_t kills, seed;
    uint64_t commands; /* sent during the storm, 0: none and no reporter */
    double gap_ms;     /* longest between two strikes */
    double hang_ms;    /* the keeper's limit */
    bool renderer, json, keep;
};

/* What is done to a process. */
enum deed {
    DEED_KILL,
    DEED_STOP,          /* left stopped: it must be replaced */
    DEED_STOP_CONTINUE, /* continued at about the time when it is replaced */
    DEED_COUNT
};

#define STRUCK_ROLES      (ROLE_RENDERER + 1)
#define STRUCK_SUPERVISOR STRUCK_ROLES /* a row of its own in the tally */

/* splitmix64: the storm's only source of chance. */
struct chance {
    uint64_t state;
};

uint64_t chance_next(struct chance *chance);
double chance_unit(struct chance *chance);                  /* [0, 1) */
uint64_t chance_below(struct chance *chance, uint64_t end); /* 0 .. end - 1 */

#endif
