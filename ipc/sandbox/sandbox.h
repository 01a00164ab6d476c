/* The sandbox of a role: what a process gives up once it has what it needs, so that one that was
 * taken over, by a forged segment, a hostile DDS sample or a bug, can do no more than its role. Why
 * it is as it is stands in docs/decisions/012-sandbox.md.
 *
 * Three steps, in this order, by the roles' mains alone:
 *   sandbox_begin   before the first thread: no new privileges, no capabilities
 *   sandbox_files   before the first thread, by roles that open files: only beneath their folders
 *   sandbox_enter   when the world is mapped and the threads are there: only the system calls of
 *                   the role, for every thread; there is no way back
 *
 * A system call that is not the role's is not done and ends the process by SIGSYS (status 159),
 * after one line that names it. Each step returns 0, or -1 with a reason that names --no-sandbox
 * when the kernel refuses: a role never runs without its sandbox unless it was told to. */
#ifndef JOLON_IPC_SANDBOX_SANDBOX_H
#define JOLON_IPC_SANDBOX_SANDBOX_H

#include "ipc/segment/role.h"
#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stddef.h>

struct sandbox {
    enum role role;
    bool on; /* false: every further step does nothing, which sandbox_begin has said in the log */
};

/* ROLE_CONSOLE is every console, also one that is not its set's. off: the user's --no-sandbox.
 * Sanitizers and crash points need system calls of their own: there the sandbox is off, too, but
 * for mover and collider with the sanitizers of addresses and of undefined behaviour. */
int sandbox_begin(struct sandbox *sandbox, enum role role, bool off, struct error_text *error);

/* From here on files are made, written and removed only beneath these folders (descriptors, which
 * may be closed afterwards), and read only there and, by a renderer, where drivers and fonts are,
 * by the console where worlds are. On a kernel without Landlock it says so in the log and does
 * nothing. */
int sandbox_files(const struct sandbox *sandbox, const int *folders, size_t count,
                  struct error_text *error);

int sandbox_enter(const struct sandbox *sandbox, struct error_text *error);

/* The keeper's sandbox, in one step, before it starts its first process. It is passed on to every
 * process that the keeper starts, beneath that process's own. So it forbids what none of them
 * needs: new privileges and capabilities, writing anywhere but beneath the folders (paths), and
 * system calls into other processes, to other users, to mounts and to the kernel's administration,
 * which fail with EPERM. Running programs is allowed. 0, or -1 with the reason. Builds with
 * sanitizers or crash points have no sandbox: 0. */
int sandbox_keeper(const char *const *folders, size_t count, struct error_text *error);

#endif
