/* Memory for what grows within a step, taken before the first one.
 *
 * A step of mover or collider asks the kernel for nothing. So each of its growing arrays has, from
 * the start, the address space of the most that it can ever hold. Only the pages that are written
 * to take memory, which the kernel provides as they are touched. */
#ifndef JOLON_WORLD_RESERVE_H
#define JOLON_WORLD_RESERVE_H

#include <stddef.h>
#include <stdint.h>

/* Address space for count items of size bytes, all zero, on a page's border and aligned to
 * RESERVE_ALIGN. NULL with errno: ENOMEM where the process may not have that much address space
 * (ulimit -v; vm.overcommit_memory = 2 counts all of it as used). */
#define RESERVE_ALIGN 65536u
void *reserve_take(uint64_t count, size_t size);

/* Gives it back; NULL is allowed. */
void reserve_free(void *memory);

#endif
