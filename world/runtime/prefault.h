/* Takes the pages of an array from the kernel before a step needs them. The first write to a page
 * else costs a step a page fault, about half a microsecond for 4 KB.
 *
 * All of this is advice: where the kernel does not know the call (before Linux 5.14) or has no
 * large pages, nothing happens and steps take the pages themselves. The content of memory never
 * changes, so a stand-by process may touch tables that another process writes. */
#ifndef JOLON_WORLD_RUNTIME_PREFAULT_H
#define JOLON_WORLD_RUNTIME_PREFAULT_H

#include <stddef.h>

/* Takes the pages of private, writable memory. From PREFAULT_LARGE_BYTES on they are large ones. */
#define PREFAULT_LARGE_BYTES ((size_t)4 << 20)
void prefault_own(void *memory, size_t bytes);

/* Lets the kernel back a mapping by large pages. Of shared memory it does so only where the
 * administrator allows it (/sys/kernel/mm/transparent_hugepage/shmem_enabled, or the mount option
 * huge= of /dev/shm). */
void prefault_large(void *memory, size_t bytes);

/* Takes the pages of a shared mapping for writing. The mapping is writable. */
void prefault_shared(void *memory, size_t bytes);

/* Takes the pages of a mapping for reading. */
void prefault_readable(const void *memory, size_t bytes);

#endif
