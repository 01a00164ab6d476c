/* The state of the keeper and one pass of its loop. One thread uses it. */
#ifndef JOLON_SUPERVISOR_KEEPER_H
#define JOLON_SUPERVISOR_KEEPER_H

#include "supervisor/process_set.h"
#include "supervisor/progress.h"
#include "supervisor/watchdog.h"

#include <signal.h>

struct keeper {
    const struct plan *plan;
    struct process_set set;
    struct watchdog watchdog;
    struct progress progress;
    sigset_t signals; /* blocked, and taken by keeper_step() */
    int ready_fd;     /* the pipe in which the script waits, -1: none */
    bool over;        /* the run has ended, or the set gives up */
    bool gave_up;
    bool starting; /* not every role is up yet */
    int exit_code;
    uint64_t repaired_frame; /* the last repair was at this frame, UINT64_MAX: there was none */
    uint64_t begun_frame;    /* frame of the world when the keeper was started */
    uint64_t begun_ns;
};

/* Blocks the signals, attaches to the plan's world, waits for the processes of an earlier set to
 * end, and confines the process. 0, or -1 with the reason. */
int keeper_open(struct keeper *keeper, const struct plan *plan, struct error_text *error);

/* Waits for a signal, at most WATCHDOG_TICK_NS. Then handles ended processes, the watchdog, and
 * due restarts. */
void keeper_step(struct keeper *keeper);

/* Ends the run with this exit code and logs the reason. */
void keeper_give_up(struct keeper *keeper, int exit_code, const char *reason);

#endif
