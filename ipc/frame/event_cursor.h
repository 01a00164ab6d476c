/* A reader's walk along the ring of events. */
#ifndef JOLON_IPC_FRAME_EVENT_CURSOR_H
#define JOLON_IPC_FRAME_EVENT_CURSOR_H

#include "ipc/segment/segment.h"

#include <stdint.h>

struct event;

struct event_cursor {
    uint64_t next; /* sequence of the event to read next */
    uint64_t gap;  /* events lost since the last read, because the ring had gone round */
};

/* Copies up to max committed events from cursor on; how many. Adds to cursor->gap what was lost.
 * Of a world that goes on from an image, the ring begins at header->first_event: what was before
 * is not to be had here, is skipped and is no gap. A reader that wants those looks at first_event
 * itself. A cursor beyond the last event reads nothing until the world comes there. */
uint32_t events_read(const struct view *view, struct event_cursor *cursor, struct event *events,
                     uint32_t max);

#endif
