/* Which files a role may touch: Landlock. */
#ifndef JOLON_SANDBOX_FILES_H
#define JOLON_SANDBOX_FILES_H

#include <stdbool.h>
#include <stddef.h>

/* Confines the calling thread, and those that it starts, to the folders (read, write, make and
 * remove) and, with drivers, to what graphics drivers read. 0; a negative errno, -ENOSYS or
 * -EOPNOTSUPP where the kernel has no Landlock. */
int files_confine(const int *folders, size_t count, bool drivers);

#endif
