/* The arrays of a collider's step that a frame may need more of than was set aside. */
#ifndef JOLON_COLLIDER_ARRAY_H
#define JOLON_COLLIDER_ARRAY_H

#include <stddef.h>
#include <stdint.h>

/* Returns a larger array of count items that begins with the same held items (reserve_grow). The
 * caller keeps no pointer into the old array. A kernel that refuses the address space ends the
 * process; the log says so. Any thread. */
void *array_grow(void *array, uint64_t held, uint64_t count, size_t size);

/* Returns one more array, of count items that are zero, on the same terms. */
void *array_take(uint64_t count, size_t size);

/* How many arrays this process has grown or taken so, up to now. */
uint64_t array_growths(void);

#endif
