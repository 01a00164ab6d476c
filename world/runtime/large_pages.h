/* Memory in large pages of 2 MB.
 *
 * A processor finds a page by a table that lies in memory. For rows that lie all over a large table
 * that takes longer than to read them, and in a virtual machine several times as long. Large pages
 * need so few entries that the processor keeps them all.
 *
 * All of this is advice: where the kernel has no large pages, or none free, the small ones stay.
 * The content of memory never changes, also while another process writes it. */
#ifndef JOLON_WORLD_RUNTIME_LARGE_PAGES_H
#define JOLON_WORLD_RUNTIME_LARGE_PAGES_H

#include <stddef.h>

/* Arrays from this size on gain by large pages. Smaller ones would take more memory than they
 * need. */
#define LARGE_PAGES_LEAST_BYTES ((size_t)512 << 10)

/* Maps the first bytes of an object in shared memory at an address at which large pages fit, for
 * prot (PROT_READ, PROT_WRITE); fd -1 is new memory that child processes share. Returns MAP_FAILED
 * with errno where mmap() does. munmap() frees it. */
void *large_pages_map(size_t bytes, int prot, int fd);

/* Advises the kernel to give private memory large pages at the first write. */
void large_pages_advise(void *memory, size_t bytes);

/* Moves memory that is there, private or shared, into large pages, and takes it if it is not there.
 * Since Linux 6.1; no setting of the administrator forbids it. The large pages that the memory
 * touches are taken as far as they lie in the same mapping. Takes about 2 ms for one of 2 MB, and
 * a microsecond where it is large already. */
void large_pages_collapse(const void *memory, size_t bytes);

#endif
