/* Landlock rules: the files that a role may use. */
#ifndef JOLON_IPC_SANDBOX_FILE_RULES_H
#define JOLON_IPC_SANDBOX_FILE_RULES_H

#include "ipc/segment/role.h"

#include <stddef.h>

/* Confines the calling thread, and those that it starts, to the folders (read, write, make and
 * remove). A renderer may also read what graphics drivers need, and the console may read worlds.
 * Returns 0, or a negative errno: -ENOSYS or -EOPNOTSUPP when the kernel has no Landlock. */
int file_rules_confine(enum role role, const int *folders, size_t count);

/* Confines the keeper and every process that it starts. All files may be read and run. Files are
 * written only beneath the folders and on the devices that drivers use. With Landlock 6, signals
 * reach only the keeper's own processes. Returns the same results. */
int file_rules_confine_keeper(const char *const *folders, size_t count);

#endif
