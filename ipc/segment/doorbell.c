/* Doorbells by POSIX semaphores. */
#include "ipc/segment/doorbell.h"

#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"

#include <time.h>

/* At most so many rings are cleared at once. One is normal; a damaged count may be huge. */
#define DRAIN_MAX 64

int doorbells_init(struct doorbells *doorbells)
{
    for (int role = 0; role < ROLE_COUNT; role++) {
        CRASH_POINT("doorbell made");
        if (sem_init(&doorbells->role[role].bell, 1, 0) != 0)
            return -1;
    }
    return 0;
}

void doorbell_ring(struct doorbells *doorbells, enum role role)
{
    int value = 0;
    CRASH_POINT("doorbell rung");
    if (sem_getvalue(&doorbells->role[role].bell, &value) == 0 && value <= 0)
        sem_post(&doorbells->role[role].bell);
}

void doorbell_wait(struct doorbells *doorbells, enum role role, uint64_t until_ns)
{
    struct timespec until = {.tv_sec = (time_t)(until_ns / NS_PER_S),
                             .tv_nsec = (long)(until_ns % NS_PER_S)};
    CRASH_POINT("doorbell waited for");
    if (sem_clockwait(&doorbells->role[role].bell, CLOCK_MONOTONIC, &until) != 0)
        return; /* the time is over, or a signal came */
    CRASH_POINT("doorbell silenced");
    for (int i = 0; i < DRAIN_MAX && sem_trywait(&doorbells->role[role].bell) == 0; i++)
        continue;
}
