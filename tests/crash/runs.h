/* Kinds of runs. In each one process may be told to die; it is started again, and in the end the
 * world is run by its roles and removed. Nothing else may be left, and every program must end with
 * the exit code that it ought to. */
#ifndef JOLON_TESTS_CRASH_RUNS_H
#define JOLON_TESTS_CRASH_RUNS_H

#include "tests/crash/trial.h"

/* death and count as of trial_start(). */
typedef void run_function(struct ending *ending, const struct plan *plan, const struct death *death,
                          const char *count);

/* Writes the scenario that run_created creates. After trial_open(). */
void runs_open(const char *scenario_text);

run_function run_roles;    /* a role or the writer of commands dies */
run_function run_created;  /* who creates the world, beside what a dead creator left */
run_function run_refused;  /* who would create it where one is that goes on */
run_function run_removed;  /* who removes it; nobody runs it */
run_function run_saved;    /* who writes its image, which then goes on in its place */
run_function run_from;     /* who creates it from the image that run_saved left */
run_function run_repaired; /* who repairs it: it was run, and its last frame and the table that that
                            * was made of were spoilt */

#endif
