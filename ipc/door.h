/* Doorbells: one POSIX process-shared semaphore a waiting role. A doorbell says "look again", it is
 * never a token: a lost ring costs one time-out, a spurious one costs one look, and nothing needs
 * re-arming after a kill. The predicate is always a frame word. */
#ifndef JOLON_IPC_DOOR_H
#define JOLON_IPC_DOOR_H

#include "ipc/role.h"

#include <semaphore.h>
#include <stdint.h>

struct doors {
    struct {
        _Alignas(64) sem_t bell;
    } role[ROLE_COUNT];
};

/* Once, at creation. 0, or -1 with errno. */
int doors_init(struct doors *doors);

/* Rings the role's bell unless it rings already. Async-signal-safe; never blocks. */
void door_ring(struct doors *doors, enum role role);

/* Waits until the bell rings or CLOCK_MONOTONIC reaches until_ns, then silences it. */
void door_wait(struct doors *doors, enum role role, uint64_t until_ns);

#endif
