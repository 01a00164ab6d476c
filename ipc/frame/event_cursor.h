/* A reader's position in the ring of events. */
#ifndef JOLON_IPC_FRAME_EVENT_CURSOR_H
#define JOLON_IPC_FRAME_EVENT_CURSOR_H

#include "ipc/segment/segment.h"

#include <stdint.h>

struct event;

struct event_cursor {
    uint64_t next; /* sequence of the event to read next */
    uint64_t gap;  /* events lost because the ring had overwritten them */
};

/* Copies up to max committed events from cursor on, moves the cursor and returns their number. Adds
 * the events that were lost to cursor->gap. The ring of a world made from an image begins at
 * header->first_event; earlier events are skipped and are no gap. A cursor beyond the last event
 * reads nothing until the world reaches it. */
uint32_t events_read(const struct view *view, struct event_cursor *cursor, struct event *events,
                     uint32_t max);

#endif
