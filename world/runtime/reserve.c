/* Mappings that the kernel backs page by page. */
#include "world/runtime/reserve.h"

#include "world/runtime/check.h"

#include <errno.h>
#include <inttypes.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/mman.h>

/* Large pages would take more memory than an array of few items needs. */
#define SMALL_PAGES_BYTES (UINT64_C(2) << 20)

static _Atomic uint64_t growths;

/* Lies in RESERVE_ALIGN bytes before the memory. */
struct reservation {
    void *mapping;
    size_t bytes;
};

static struct reservation *of(void *memory)
{
    return (struct reservation *)(void *)((char *)memory - RESERVE_ALIGN);
}

void *reserve_take(uint64_t count, size_t size)
{
    if (size == 0 || count > (SIZE_MAX / 2 - 3 * (uint64_t)RESERVE_ALIGN) / size) {
        errno = ENOMEM;
        return NULL;
    }
    size_t wanted = (size_t)count * size, bytes = wanted + 2 * (size_t)RESERVE_ALIGN;
    char *mapping = mmap(NULL, bytes, PROT_READ | PROT_WRITE,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapping == MAP_FAILED)
        return NULL;
    size_t first = bytes < SMALL_PAGES_BYTES ? bytes : SMALL_PAGES_BYTES;
    (void)madvise(mapping, first,
                  MADV_NOHUGEPAGE); /* only advice: a kernel without large pages needs none */
    uintptr_t over = (uintptr_t)mapping % RESERVE_ALIGN;
    char *memory = mapping + (over > 0 ? 2 * (size_t)RESERVE_ALIGN - over : RESERVE_ALIGN);
    *of(memory) = (struct reservation){mapping, bytes};
    return memory;
}

void *reserve_more(uint64_t count, size_t size)
{
    void *memory = reserve_take(count, size);
    if (!memory)
        check_report("this frame needs an array of %" PRIu64 " items of %zu bytes, and the kernel "
                     "refuses the address space: %s; allow more (ulimit -v, vm.overcommit_memory)",
                     count, size, strerror(errno));
    CHECK(memory != NULL);
    atomic_fetch_add_explicit(&growths, 1, memory_order_relaxed);
    return memory;
}

uint64_t reserve_growths(void)
{
    return atomic_load_explicit(&growths, memory_order_relaxed);
}

void *reserve_grow(void *memory, uint64_t held, uint64_t count, size_t size)
{
    void *larger = reserve_more(count, size);
    memcpy(larger, memory, (size_t)held * size);
    reserve_free(memory);
    return larger;
}

void reserve_free(void *memory)
{
    if (!memory)
        return;
    struct reservation reservation = *of(memory);
    munmap(reservation.mapping, reservation.bytes);
}
