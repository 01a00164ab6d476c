/* Large pages by madvise(). */
#include "world/runtime/large_pages.h"

#include <errno.h>
#include <stdint.h>
#include <sys/mman.h>
#include <unistd.h>

#ifndef MADV_COLLAPSE /* of Linux 6.1, which is newer than some C libraries */
#define MADV_COLLAPSE 25
#endif

#define LARGE ((size_t)2 << 20)

void *large_pages_map(size_t bytes, int prot, int fd)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), whole = (bytes + page - 1) / page * page;
    char *space =
        mmap(NULL, whole + LARGE, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (space == MAP_FAILED)
        return MAP_FAILED;
    const size_t before = (LARGE - (uintptr_t)space % LARGE) % LARGE;
    void *memory = mmap(space + before, bytes, prot,
                        MAP_SHARED | MAP_FIXED | (fd < 0 ? MAP_ANONYMOUS : 0), fd, 0);
    if (memory == MAP_FAILED) {
        int code = errno;
        munmap(space, whole + LARGE);
        errno = code;
        return MAP_FAILED;
    }
    if (before > 0)
        munmap(space, before);
    munmap(space + before + whole, LARGE - before);
    return memory;
}

/* One large page after the other: the kernel gives up at the first that lies in two mappings. */
static void advise(const void *memory, size_t bytes, int advice)
{
    char *first = (char *)(uintptr_t)memory - (uintptr_t)memory % LARGE;
    const char *end = (const char *)memory + bytes;
    if (bytes < LARGE_PAGES_LEAST_BYTES)
        return;
    for (char *at = first; at < end; at += LARGE)
        (void)madvise(at, LARGE, advice);
}

void large_pages_advise(void *memory, size_t bytes)
{
    advise(memory, bytes, MADV_HUGEPAGE);
}

void large_pages_collapse(const void *memory, size_t bytes)
{
    advise(memory, bytes, MADV_COLLAPSE);
}
