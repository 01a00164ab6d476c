/* The system calls of each role, and the kernel's filter made of them. */
#ifndef JOLON_SANDBOX_FILTER_H
#define JOLON_SANDBOX_FILTER_H

#include "ipc/role.h"

/* Loads the role's filter, or of ROLE_NONE the keeper's, into every thread of the process, for
 * good. 0, or a negative errno. */
int filter_load(enum role role);

#endif
