/* The system calls of each role, and the kernel's filter made of them. */
#ifndef JOLON_IPC_SANDBOX_SYSCALL_FILTER_H
#define JOLON_IPC_SANDBOX_SYSCALL_FILTER_H

#include "ipc/segment/role.h"

/* Built with the address sanitizer: mover and collider are confined all the same, with a list of
 * what it does beside their work. */
#if defined(__SANITIZE_ADDRESS__)
#define SANDBOX_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANDBOX_SANITIZED
#endif
#endif

/* Loads the role's filter, or of ROLE_NONE the keeper's, into every thread of the process, for
 * good. 0, or a negative errno. */
int syscall_filter_load(enum role role);

#endif
