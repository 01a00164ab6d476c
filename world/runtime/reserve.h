/* Memory for arrays that grow within a step, reserved before the first one.
 *
 * An ordinary step of mover or collider makes no system call. Its growing arrays have, from the
 * start, the address space that a heavy frame needs. Only pages that are written take memory; the
 * kernel provides them at the first write. If a frame needs still more, the array is moved once
 * into a larger mapping (reserve_grow). */
#ifndef JOLON_WORLD_RUNTIME_RESERVE_H
#define JOLON_WORLD_RUNTIME_RESERVE_H

#include <stddef.h>
#include <stdint.h>

/* Returns address space for count items of size bytes, all zero, on a page border and aligned to
 * RESERVE_ALIGN. NULL with errno: ENOMEM if the process may not have that much address space
 * (ulimit -v; vm.overcommit_memory = 2 counts all of it as used). */
#define RESERVE_ALIGN 65536u
void *reserve_take(uint64_t count, size_t size);

/* For a step that needs more than was reserved. If the kernel refuses the address space, the
 * process ends, and the log says so. Any thread; one at a time for one array. */

/* Returns a larger array that begins with the held items of memory and continues with zeros. memory
 * is freed, so the caller keeps no pointer into it. Maps, copies and unmaps, and makes no other
 * system call but madvise. */
void *reserve_grow(void *memory, uint64_t held, uint64_t count, size_t size);

/* Returns one more array, of count items that are zero. */
void *reserve_more(uint64_t count, size_t size);

/* Returns how many arrays reserve_grow() and reserve_more() have returned in this process. */
uint64_t reserve_growths(void);

/* Frees the memory; NULL is allowed. */
void reserve_free(void *memory);

#endif
