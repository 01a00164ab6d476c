/* The set of processes that is tested. The storm is the subreaper of all processes that it starts:
 * a process that loses its parent becomes a child of the storm and is still found. Signals go only
 * to descendants that a pidfd names. Main thread, where nothing else is said. */
#ifndef JOLON_TESTS_STORM_TESTED_SET_H
#define JOLON_TESTS_STORM_TESTED_SET_H

#include "tests/storm/storm.h"

struct tested_set {
    const struct storm_options *options;
    struct view view;        /* read-only; remains mapped after the world's file is removed */
    _Atomic int supervisor;  /* pid, 0: not running */
    uint64_t starts;         /* how often the set was started */
    uint64_t starts_refused; /* starts refused and tried again */
    int descriptors;         /* of this supervisor when it was ready first, 0: not counted yet */
    int descriptors_over;    /* most beyond that, counted later */
};

/* Starts the set and attaches to its world. Returns 0, or -1 with an error. */
int tested_set_start(struct tested_set *set, const struct storm_options *options,
                     struct error_text *error);

/* Starts the set again over the world that a killed supervisor has left. Returns 0, or -1 with an
 * error. */
int tested_set_restart(struct tested_set *set, struct error_text *error);

/* Calls `jolon stop`, which removes the world. set->view still shows its last frame. Returns the
 * exit code. */
int tested_set_stop(struct tested_set *set);

/* Returns a pidfd of the process if it is alive and descends from the supervisor, otherwise -1. */
int tested_set_pidfd(const struct tested_set *set, int pid);

/* Returns a pidfd of the supervisor if it is alive and is our child, otherwise -1. */
int tested_set_supervisor_pidfd(const struct tested_set *set);

/* Sends the signal. Returns true if the process still existed. */
bool tested_set_signal(int pidfd, int signal_number);

/* Stores the pids of at most max children of a process and returns their number. Any thread. */
int tested_set_children(int pid, int *children, int max);

/* Waits at most 20 s until every started role is ready and has a fresh heartbeat. 0, or -1 and the
 * role that is not. */
int tested_set_wait_ready(const struct tested_set *set, struct error_text *error);

/* Counts the supervisor's descriptors. All roles must be ready. */
void tested_set_count_descriptors(struct tested_set *set);

/* Reaps dead children, also those that became ours when their parent died. */
void tested_set_reap(void);

/* Count the processes that outlived the set, and the files of its world in /dev/shm and in the
 * runtime folder. */
int tested_set_processes_left(void);
int tested_set_files_left(const struct storm_options *options);

/* Runs a program of Jolon and stores its standard output in text (may be NULL). Returns its exit
 * code, or -1 if it did not exit by itself within the limit. */
int tested_set_run(const char *const *arguments, char *text, size_t bytes, unsigned limit_s);

#endif
