/* Copies events without a lock. */
#include "ipc/frame/event_cursor.h"

#include "ipc/frame/snapshot.h"
#include "world/entity/event.h"
#include "world/params.h"

#include <string.h>

/* Returns the oldest event that the writer cannot be overwriting: one frame's most is left out. */
static uint64_t oldest_safe(const struct view *view, uint64_t end)
{
    uint64_t kept = view->header->event_slots - view->world.params->events_per_frame;
    uint64_t first = view->header->first_event;
    return end > kept && end - kept > first ? end - kept : first;
}

uint32_t events_read(const struct view *view, struct event_cursor *cursor, struct event *events,
                     uint32_t max)
{
    struct state_head head;
    uint32_t count = 0;
    if (snapshot_head(&head, view) != 0)
        return 0;
    uint64_t oldest = oldest_safe(view, head.event_end);
    if (cursor->next < view->header->first_event) /* these never were in this ring: no gap */
        cursor->next = view->header->first_event;
    if (cursor->next < oldest) {
        cursor->gap += oldest - cursor->next;
        cursor->next = oldest;
    }
    uint64_t first = cursor->next;
    while (count < max && first + count < head.event_end) {
        events[count] = view->events[(first + count) & (view->header->event_slots - 1)];
        count++;
    }
    /* Events that the writer may have begun to overwrite during the copy count as lost. */
    atomic_thread_fence(memory_order_acquire);
    if (snapshot_head(&head, view) != 0)
        return 0;
    oldest = oldest_safe(view, head.event_end);
    if (first < oldest) {
        uint64_t lost = oldest - first < count ? oldest - first : count;
        memmove(events, events + lost, (count - lost) * sizeof *events);
        cursor->gap += lost;
        first += lost;
        count -= (uint32_t)lost;
    }
    cursor->next = first + count;
    return count;
}
