/* Child processes of a test. They are started by fork, always waited for, and killed after
 * CHILD_TIMEOUT_S. A child must not use cmocka's asserts, because they jump back into the parent's
 * code. It returns a code instead. */
#ifndef JOLON_TESTS_SUPPORT_CHILD_H
#define JOLON_TESTS_SUPPORT_CHILD_H

#include <sys/types.h>

#define CHILD_TIMEOUT_S 120 /* long, because a busy machine may run a child at a tenth */

/* Forks. The child calls body and exits with its result. It writes no core file, faults kill it,
 * and it dies with the test. */
pid_t child_start(int (*body)(void *context), void *context);

/* Waits until the child ends. After CHILD_TIMEOUT_S it kills the child and fails the test. Returns
 * the status of waitpid(). */
int child_wait(pid_t pid);

/* Kills the child with SIGKILL and waits for it. */
void child_kill(pid_t pid);

/* Starts a child and waits for it. Returns its exit code, or minus the signal that ended it. */
int child_run(int (*body)(void *context), void *context);

#endif
