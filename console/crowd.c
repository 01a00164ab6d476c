/* Who goes first. */
#include "console/crowd.h"

#include <stddef.h>
#include <sys/socket.h>

/* Its owner then finds it closed, and says that it left. */
static void end(struct seat *seat)
{
    seat->ending = true;
    (void)shutdown(seat->fd, SHUT_RDWR);
}

/* Of those that are not answered just now. */
static struct seat *longest_idle(struct crowd *crowd)
{
    struct seat *found = NULL;
    for (uint32_t i = 0; i < CROWD_ROOM; i++) {
        struct seat *seat = &crowd->seat[i];
        if (seat->taken && !seat->busy && !seat->ending &&
            (!found || seat->since_ns < found->since_ns))
            found = seat;
    }
    return found;
}

struct seat *crowd_come(struct crowd *crowd, int fd, uint64_t now_ns)
{
    for (uint32_t i = 0; i < CROWD_ROOM; i++) {
        struct seat *seat = &crowd->seat[i];
        if (seat->taken)
            continue;
        struct seat *idle = crowd->taken >= CROWD_SEATS ? longest_idle(crowd) : NULL;
        if (idle)
            end(idle);
        *seat = (struct seat){.fd = fd, .taken = true, .since_ns = now_ns};
        crowd->taken++;
        return seat;
    }
    return NULL;
}

void crowd_leave(struct crowd *crowd, struct seat *seat)
{
    seat->taken = false;
    crowd->taken--;
}

void crowd_begin(struct seat *seat, uint64_t now_ns)
{
    seat->busy = true;
    seat->since_ns = now_ns;
}

void crowd_done(struct seat *seat, uint64_t now_ns)
{
    seat->busy = false;
    seat->since_ns = now_ns;
}

void crowd_sweep(struct crowd *crowd, uint64_t now_ns)
{
    for (uint32_t i = 0; i < CROWD_ROOM; i++) {
        struct seat *seat = &crowd->seat[i];
        uint64_t patience_ns = seat->busy ? CROWD_BUSY_NS : CROWD_PATIENCE_NS;
        if (seat->taken && !seat->ending && now_ns > seat->since_ns + patience_ns)
            end(seat);
    }
}
