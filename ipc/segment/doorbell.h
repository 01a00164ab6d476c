/* Doorbells: one process-shared POSIX semaphore for each role that waits. A ring means "look
 * again"; the condition that a role waits for is always a frame word. A lost ring costs one
 * time-out, a spurious ring costs one look, and nothing needs re-arming after a kill. */
#ifndef JOLON_IPC_SEGMENT_DOORBELL_H
#define JOLON_IPC_SEGMENT_DOORBELL_H

#include "ipc/segment/role.h"

#include <semaphore.h>
#include <stdint.h>

struct doorbells {
    struct {
        _Alignas(64) sem_t bell;
    } role[ROLE_COUNT];
};

/* Initialises the semaphores of a new world. Returns 0, or -1 with errno. */
int doorbells_init(struct doorbells *doorbells);

/* Rings the role's bell unless it is rung already. Async-signal-safe; never blocks. */
void doorbell_ring(struct doorbells *doorbells, enum role role);

/* Waits until the bell is rung, a signal comes or CLOCK_MONOTONIC reaches until_ns. Clears the
 * bell. */
void doorbell_wait(struct doorbells *doorbells, enum role role, uint64_t until_ns);

#endif
