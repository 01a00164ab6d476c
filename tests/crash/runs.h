/* Kinds of runs. In each, one process may be told to die and is then started again. In the end the
 * roles run the world, and it is removed. Nothing else may be left, and every program must end with
 * the expected exit code. */
#ifndef JOLON_TESTS_CRASH_RUNS_H
#define JOLON_TESTS_CRASH_RUNS_H

#include "tests/crash/trial.h"

/* death and count: as for trial_start(). */
typedef void run_function(struct run_outcome *outcome, const struct plan *plan,
                          const struct death *death, const char *count);

/* Writes the scenario that run_created() uses. Call it after trial_open(). */
void runs_open(const char *scenario_text);

run_function run_roles;   /* a role or the writer of commands dies */
run_function run_created; /* the creator dies; an earlier creator has left its name */
run_function
    run_refused; /* a creator dies that must be refused, because a world of this name continues */
run_function run_removed;  /* the program that removes the world dies */
run_function run_saved;    /* the writer of the image dies; a world of the image then continues */
run_function run_from;     /* the creator of a world from the image of run_saved() dies */
run_function run_repaired; /* the repair of the world dies; its last frame and the moved table were
                              damaged after the run */

#endif
