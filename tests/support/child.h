/* Processes of a test: started by fork, always waited for, killed when they overstay. A child must
 * not use cmocka's asserts (their way out is the parent's); it returns a code instead. */
#ifndef JOLON_TESTS_SUPPORT_CHILD_H
#define JOLON_TESTS_SUPPORT_CHILD_H

#include <sys/types.h>

#define CHILD_TIMEOUT_S 20

/* Forks; the child leaves with body's result. No core files, faults kill it, and it dies with the
 * test. */
pid_t child_start(int (*body)(void *context), void *context);

/* Waits for its end, at most CHILD_TIMEOUT_S: then kills it and fails the test. Returns the status
 * of waitpid(). */
int child_wait(pid_t pid);

/* SIGKILL, then waits. */
void child_kill(pid_t pid);

/* Start and wait: the exit code, or minus the signal that ended it. */
int child_run(int (*body)(void *context), void *context);

#endif
