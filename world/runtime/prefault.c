/* Pages by madvise(). */
#include "world/runtime/prefault.h"

#include "world/runtime/large_pages.h"

#include <stdint.h>
#include <sys/mman.h>
#include <unistd.h>

#ifndef MADV_POPULATE_WRITE /* of Linux 5.14, which is newer than some C libraries */
#define MADV_POPULATE_WRITE 23
#endif

/* Advises the kernel about the pages that the memory lies in. */
static void advise(void *memory, size_t bytes, int advice)
{
    uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), over = (uintptr_t)memory % page;
    if (bytes > 0)
        (void)madvise((char *)memory - over, bytes + over, advice);
}

void prefault_own(void *memory, size_t bytes)
{
    large_pages_advise(memory, bytes);
    advise(memory, bytes, MADV_POPULATE_WRITE);
    large_pages_collapse(memory, bytes);
}

void prefault_shared(void *memory, size_t bytes)
{
    advise(memory, bytes, MADV_POPULATE_WRITE);
    large_pages_collapse(memory, bytes);
}

void prefault_readable(const void *memory, size_t bytes)
{
    advise((void *)(uintptr_t)memory, bytes, MADV_POPULATE_READ);
    large_pages_collapse(memory, bytes);
}
