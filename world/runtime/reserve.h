/* Memory for what grows within a step, taken before the first one.
 *
 * An ordinary step of mover or collider asks the kernel for nothing. Its growing arrays have, from
 * the start, the address space of what a heavy frame needs. Only the pages that are written to take
 * memory, which the kernel provides as they are touched. An array of which a frame needs still more
 * moves once into a larger mapping (reserve_grow). */
#ifndef JOLON_WORLD_RUNTIME_RESERVE_H
#define JOLON_WORLD_RUNTIME_RESERVE_H

#include <stddef.h>
#include <stdint.h>

/* Address space for count items of size bytes, all zero, on a page's border and aligned to
 * RESERVE_ALIGN. NULL with errno: ENOMEM where the process may not have that much address space
 * (ulimit -v; vm.overcommit_memory = 2 counts all of it as used). */
#define RESERVE_ALIGN 65536u
void *reserve_take(uint64_t count, size_t size);

/* For a step that needs more than was set aside. A kernel that refuses the address space ends the
 * process, and the log says so. Any thread; one at a time for one array. */

/* Returns a larger array instead of memory, which begins with the same held items and goes on with
 * zeros. memory is given back, so the caller keeps no pointer into it. It maps, copies and unmaps,
 * and makes no other system call but madvise. */
void *reserve_grow(void *memory, uint64_t held, uint64_t count, size_t size);

/* Returns one more array, of count items that are zero. */
void *reserve_more(uint64_t count, size_t size);

/* How many arrays reserve_grow() and reserve_more() have returned in this process. */
uint64_t reserve_growths(void);

/* Gives it back; NULL is allowed. */
void reserve_free(void *memory);

#endif
