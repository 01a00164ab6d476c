/* The clock of frames and waits: CLOCK_MONOTONIC in nanoseconds. */
#ifndef JOLON_IPC_PROCESS_CLOCK_H
#define JOLON_IPC_PROCESS_CLOCK_H

#include <stdint.h>

#define NS_PER_S  1000000000u
#define NS_PER_MS 1000000u

uint64_t clock_now_ns(void);

/* Returns earlier when a signal comes. */
void clock_sleep_until_ns(uint64_t until_ns);

#endif
