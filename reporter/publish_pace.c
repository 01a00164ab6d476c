/* Plans batches. */
#include "reporter/publish_pace.h"

#define PERIOD_NS 100000000u

/* Batches may take one part in so many of the time. A world that is too large for ten batches a
 * second gets fewer, and does not occupy a whole processor. */
#define SHARE 8u

bool publish_pace_due(struct publish_pace *pace, uint64_t now_ns)
{
    if (now_ns < pace->due_ns)
        return false;
    pace->due_ns += PERIOD_NS;
    if (pace->due_ns <= now_ns)
        pace->due_ns = now_ns + PERIOD_NS;
    return true;
}

void publish_pace_begin(struct publish_pace *pace, uint64_t now_ns)
{
    pace->begun_ns = now_ns;
    pace->spent_ns = 0;
}

void publish_pace_spent(struct publish_pace *pace, uint64_t spent_ns)
{
    pace->spent_ns += spent_ns;
    if (pace->spent_ns * SHARE > PERIOD_NS)
        pace->due_ns = pace->begun_ns + pace->spent_ns * SHARE;
}

uint32_t publish_pace_parts(uint32_t entities, uint32_t room)
{
    return entities > 0 ? (entities + room - 1) / room : 1;
}
