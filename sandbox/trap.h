/* What is said of a forbidden system call, by the process that tried it. */
#ifndef JOLON_SANDBOX_TRAP_H
#define JOLON_SANDBOX_TRAP_H

#include "ipc/role.h"

/* Installs the handler of SIGSYS: it writes "jolon-ROLE: the sandbox forbids system call N (NAME)"
 * to standard error and lets the signal end the process. 0, or a negative errno.
 *
 * A thread that blocks every signal does not block this one: trap.c puts its own sigprocmask() and
 * pthread_sigmask() in front of the C library's. */
int trap_install(enum role role);

#endif
