/* Time stamps. */
#include "gateway/pdu/timestamp.h"

#include <math.h>

#define UNITS_PER_HOUR 2147483648.0 /* 2^31 */

uint32_t timestamp_of(double time_s, bool absolute)
{
    if (!isfinite(time_s))
        return absolute;
    double hours = time_s / TIMESTAMP_HOUR_S;
    double units = floor((hours - floor(hours)) * UNITS_PER_HOUR);
    if (units >= UNITS_PER_HOUR) /* a time just before 0 rounds up to a whole hour */
        units = UNITS_PER_HOUR - 1.0;
    return (uint32_t)units << 1 | (uint32_t)absolute;
}

double timestamp_seconds(uint32_t timestamp)
{
    return (double)(timestamp >> 1) * (TIMESTAMP_HOUR_S / UNITS_PER_HOUR);
}

double timestamp_between(uint32_t from, uint32_t to)
{
    /* The difference modulo an hour, as a signed number of units. */
    int32_t units = (int32_t)((to & ~1u) - (from & ~1u)) / 2;
    return units * (TIMESTAMP_HOUR_S / UNITS_PER_HOUR);
}
