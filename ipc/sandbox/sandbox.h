/* The sandbox of a role: the privileges that a process gives up once it has what it needs. A
 * process that was taken over by a forged segment, a hostile DDS sample or a bug can then do no
 * more than its role. docs/decisions/012-sandbox.md says why it is made this way.
 *
 * Three steps, in this order, called by the roles' mains only:
 *
 *   sandbox_begin   before the first thread: no new privileges, no capabilities
 *   sandbox_files   before the first thread, by roles that open files: only beneath their folders
 *   sandbox_enter   when the world is mapped and the threads run: only the role's system calls,
 *                   for every thread; there is no way back
 *
 * A forbidden system call is not made. It ends the process by SIGSYS (status 159), after one line
 * that names the call. Each step returns 0, or -1 with a reason that names --no-sandbox when the
 * kernel refuses. A role never runs without its sandbox unless it was told to. */
#ifndef JOLON_IPC_SANDBOX_SANDBOX_H
#define JOLON_IPC_SANDBOX_SANDBOX_H

#include "ipc/segment/role.h"
#include "ipc/segment/segment.h"

#include <stdbool.h>
#include <stddef.h>

struct sandbox {
    enum role role;
    bool on; /* false: every further step does nothing, as sandbox_begin() has logged */
};

/* ROLE_CONSOLE is for every console, also for one outside a set. off is the user's --no-sandbox.
 * The sandbox is also off in builds with sanitizers or crash points, which need more system calls;
 * but mover and collider keep it with the address and undefined-behaviour sanitizers. */
int sandbox_begin(struct sandbox *sandbox, enum role role, bool off, struct error_text *error);

/* Confines file access: files are made, written and removed only beneath these folders
 * (descriptors, which may be closed afterwards), and read only there. A renderer may also read
 * drivers and fonts, the console worlds. On a kernel without Landlock it only logs that. */
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
