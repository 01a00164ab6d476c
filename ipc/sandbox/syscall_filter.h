/* The system calls of each role, and the kernel's filter made from them. */
#ifndef JOLON_IPC_SANDBOX_SYSCALL_FILTER_H
#define JOLON_IPC_SANDBOX_SYSCALL_FILTER_H

#include "ipc/segment/role.h"

/* With the address sanitizer mover and collider are confined too, with an additional list for
 * it. */
#if defined(__SANITIZE_ADDRESS__)
#define SANDBOX_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANDBOX_SANITIZED
#endif
#endif

/* Loads the role's filter, or the keeper's for ROLE_NONE, into every thread of the process,
 * irrevocably. Returns 0, or a negative errno. */
int syscall_filter_load(enum role role);

#endif
