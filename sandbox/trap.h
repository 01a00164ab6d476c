/* What is said of a forbidden system call, by the process that tried it. */
#ifndef JOLON_SANDBOX_TRAP_H
#define JOLON_SANDBOX_TRAP_H

#include "ipc/role.h"

/* Installs the handler of SIGSYS: it writes "jolon-ROLE: the sandbox forbids system call N (NAME)"
 * to standard error and lets the signal end the process. 0, or a negative errno. */
int trap_install(enum role role);

#endif
