/* Sorting within a frame's step: in place, without allocation, in bounded time.
 *
 * The C library's qsort() allocates memory for more than 1 KiB and asks the kernel for the memory
 * size, which the sandbox of mover and collider forbids. */
#ifndef JOLON_WORLD_MATHS_SORT_H
#define JOLON_WORLD_MATHS_SORT_H

#include <stdint.h>

/* Sorts count records of two uint32_t each: ascending by the first, equal ones by the second. The
 * time grows with count alone, whatever the values are, and so the result depends on nothing but
 * the records. */
void sort_words(void *records, uint32_t count);

#endif
