/* Which files a role may touch: Landlock. */
#ifndef JOLON_IPC_SANDBOX_FILE_RULES_H
#define JOLON_IPC_SANDBOX_FILE_RULES_H

#include "ipc/segment/role.h"

#include <stddef.h>

/* Confines the calling thread, and those that it starts, to the folders (read, write, make and
 * remove), of a renderer also to what graphics drivers read, and of the console to reading
 * worlds. 0; a negative errno, -ENOSYS or -EOPNOTSUPP where the kernel has no Landlock. */
int file_rules_confine(enum role role, const int *folders, size_t count);

/* Confines the keeper, and with it every process that it starts: files are written only beneath the
 * folders and on the devices that drivers use, everything is read and run. Where the kernel knows
 * how (Landlock 6), signals reach only the keeper's own processes. The same results. */
int file_rules_confine_keeper(const char *const *folders, size_t count);

#endif
