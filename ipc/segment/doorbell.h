/* Doorbells: one POSIX process-shared semaphore a waiting role. A doorbell says "look again", it is
 * never a token: a lost ring costs one time-out, a spurious one costs one look, and nothing needs
 * re-arming after a kill. The predicate is always a frame word. */
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

/* Once, at creation. 0, or -1 with errno. */
int doorbells_init(struct doorbells *doors);

/* Rings the role's bell unless it rings already. Async-signal-safe; never blocks. */
void doorbell_ring(struct doorbells *doors, enum role role);

/* Waits until the bell rings or CLOCK_MONOTONIC reaches until_ns, then silences it. */
void doorbell_wait(struct doorbells *doors, enum role role, uint64_t until_ns);

#endif
