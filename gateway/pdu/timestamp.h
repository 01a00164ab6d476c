/* Time stamps of PDUs: the upper 31 bits are the time past the hour in units of 3600 s / 2^31, and
 * the low bit says whether the sender's clock is UTC. Pure; any thread. */
#ifndef JOLON_GATEWAY_PDU_TIMESTAMP_H
#define JOLON_GATEWAY_PDU_TIMESTAMP_H

#include <stdbool.h>
#include <stdint.h>

#define TIMESTAMP_HOUR_S 3600.0

/* Returns the time stamp of a time [s]; whole hours are left out. absolute: the time is UTC. */
uint32_t timestamp_of(double time_s, bool absolute);

/* Returns the time past the hour [s], 0 to below 3600. */
double timestamp_seconds(uint32_t timestamp);

static inline bool timestamp_absolute(uint32_t timestamp)
{
    return timestamp & 1;
}

/* Returns the time from one stamp to another [s], -1800 to below 1800: an hour's end may lie
 * between them. */
double timestamp_between(uint32_t from, uint32_t to);

#endif
