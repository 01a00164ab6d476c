/* Pages by madvise(). */
#include "world/runtime/prefault.h"

#include <stdint.h>
#include <sys/mman.h>
#include <unistd.h>

#ifndef MADV_POPULATE_WRITE /* of Linux 5.14, which is newer than some C libraries */
#define MADV_POPULATE_WRITE 23
#endif

#define LARGE ((uintptr_t)2 << 20)

static uintptr_t page_bytes(void)
{
    return (uintptr_t)sysconf(_SC_PAGESIZE);
}

/* Advises the kernel about the whole pages that the memory lies in, or about those within it. */
static void advise(void *memory, size_t bytes, uintptr_t page, int outwards, int advice)
{
    uintptr_t first = (uintptr_t)memory, end = first + bytes;
    first = (outwards ? first : first + page - 1) / page * page;
    end = (outwards ? end + page - 1 : end) / page * page;
    if (bytes > 0 && first < end)
        (void)madvise((char *)memory + ((intptr_t)first - (intptr_t)(uintptr_t)memory), end - first,
                      advice);
}

void prefault_own(void *memory, size_t bytes)
{
    if (bytes >= PREFAULT_LARGE_BYTES)
        advise(memory, bytes, LARGE, 0, MADV_HUGEPAGE);
    advise(memory, bytes, page_bytes(), 1, MADV_POPULATE_WRITE);
}

void prefault_large(void *memory, size_t bytes)
{
    advise(memory, bytes, page_bytes(), 1, MADV_HUGEPAGE);
}

void prefault_shared(void *memory, size_t bytes)
{
    advise(memory, bytes, page_bytes(), 1, MADV_POPULATE_WRITE);
}

void prefault_readable(const void *memory, size_t bytes)
{
    advise((void *)(uintptr_t)memory, bytes, page_bytes(), 1, MADV_POPULATE_READ);
}
