/* Growth of arrays within a step: rare, and counted. */
#include "collider/array.h"

#include "ipc/process/log.h"
#include "world/runtime/reserve.h"

#include <errno.h>
#include <inttypes.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

static _Atomic uint64_t growths;

/* Counts a larger array, or ends the process for want of one. */
static void *given(void *array, uint64_t count, size_t size)
{
    bool grown = array != NULL;
    if (!grown)
        log_warn("this frame needs an array of %" PRIu64 " items of %zu bytes, and the kernel "
                 "refuses the address space: %s; allow more (ulimit -v, vm.overcommit_memory)",
                 count, size, strerror(errno));
    CHECK(grown);
    atomic_fetch_add_explicit(&growths, 1, memory_order_relaxed);
    return array;
}

void *array_grow(void *array, uint64_t held, uint64_t count, size_t size)
{
    return given(reserve_grow(array, held, count, size), count, size);
}

void *array_take(uint64_t count, size_t size)
{
    return given(reserve_take(count, size), count, size);
}

uint64_t array_growths(void)
{
    return atomic_load_explicit(&growths, memory_order_relaxed);
}
