/* A limit on requests: per_s a second on average, and at most burst at once. */
#ifndef JOLON_IPC_PROCESS_RATE_H
#define JOLON_IPC_PROCESS_RATE_H

#include <stdbool.h>
#include <stdint.h>

struct rate {
    uint64_t due_ns; /* when the granted requests would end if they came evenly */
};

/* Returns true if one more request is granted. A refused request does not count. per_s > 0. */
static inline bool rate_take(struct rate *rate, uint32_t per_s, uint32_t burst, uint64_t now_ns)
{
    uint64_t step_ns = 1000000000u / per_s;
    uint64_t due_ns = rate->due_ns > now_ns ? rate->due_ns : now_ns;
    if (due_ns - now_ns >= burst * step_ns)
        return false;
    rate->due_ns = due_ns + step_ns;
    return true;
}

#endif
