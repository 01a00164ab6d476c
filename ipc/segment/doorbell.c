/* Doorbells on POSIX semaphores. */
#include "ipc/segment/doorbell.h"

#include "ipc/process/clock.h"
#include "ipc/process/crash_point.h"

#include <time.h>

/* More rings than this were never ours (one is enough): do not count them down for ever. */
#define DRAIN_MAX 64

int doorbells_init(struct doorbells *doors)
{
    for (int role = 0; role < ROLE_COUNT; role++) {
        CRASH_POINT("doorbell made");
        if (sem_init(&doors->role[role].bell, 1, 0) != 0)
            return -1;
    }
    return 0;
}

void doorbell_ring(struct doorbells *doors, enum role role)
{
    int value = 0;
    CRASH_POINT("doorbell rung");
    if (sem_getvalue(&doors->role[role].bell, &value) == 0 && value <= 0)
        sem_post(&doors->role[role].bell);
}

void doorbell_wait(struct doorbells *doors, enum role role, uint64_t until_ns)
{
    struct timespec until = {.tv_sec = (time_t)(until_ns / NS_PER_S),
                             .tv_nsec = (long)(until_ns % NS_PER_S)};
    CRASH_POINT("doorbell waited for");
    if (sem_clockwait(&doors->role[role].bell, CLOCK_MONOTONIC, &until) != 0)
        return; /* time is over, or a signal came: look again */
    CRASH_POINT("doorbell silenced");
    for (int i = 0; i < DRAIN_MAX && sem_trywait(&doors->role[role].bell) == 0; i++)
        continue;
}
