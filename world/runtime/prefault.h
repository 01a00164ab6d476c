/* Takes the pages of an array from the kernel before a step needs them. The first write to a page
 * else costs a step a page fault, about half a microsecond for 4 KB.
 *
 * All of this is advice: where the kernel does not know the call (before Linux 5.14) or has no
 * large pages, nothing happens and steps take the pages themselves. The content of memory never
 * changes, so a stand-by process may touch tables that another process writes. */
#ifndef JOLON_WORLD_RUNTIME_PREFAULT_H
#define JOLON_WORLD_RUNTIME_PREFAULT_H

#include <stddef.h>

/* Large arrays get large pages (world/runtime/large_pages.h). */

/* Takes the pages of private, writable memory. */
void prefault_own(void *memory, size_t bytes);

/* Takes the pages of a shared mapping for writing. The mapping is writable. */
void prefault_shared(void *memory, size_t bytes);

/* Takes the pages of a mapping for reading. */
void prefault_readable(const void *memory, size_t bytes);

#endif
