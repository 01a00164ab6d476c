/* The report of a forbidden system call, by the process that tried it. */
#ifndef JOLON_IPC_SANDBOX_SYSCALL_REPORT_H
#define JOLON_IPC_SANDBOX_SYSCALL_REPORT_H

#include "ipc/segment/role.h"

/* Installs the handler of SIGSYS: it writes "jolon-ROLE: the sandbox forbids system call N (NAME)"
 * to standard error and lets the signal end the process. Returns 0, or a negative errno.
 *
 * A thread that blocks every signal does not block SIGSYS: syscall_report.c replaces the C
 * library's sigprocmask() and pthread_sigmask(). */
int syscall_report_install(enum role role);

#endif
