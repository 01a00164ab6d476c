/* The event log: every event of the run, each once, as docs/events.md describes it. */
#ifndef JOLON_RECORDER_LOG_EVENT_LOG_H
#define JOLON_RECORDER_LOG_EVENT_LOG_H

#include "ipc/frame/event_cursor.h"
#include "recorder/log/journal.h"

struct event_log {
    struct journal journal;
    struct event_cursor cursor; /* the event to read next */
    uint64_t written;           /* every event before it is in the file, or counted in a gap */
    bool to_compare;            /* its last event, once the world has made it again */
    uint64_t gaps;              /* events that the ring overwrote before they could be written */
};

/* Opens the log of this world and finds where to go on. A log that goes beyond a world made from an
 * image is cut back to that image; what it held beyond is kept as path.old. A log of another run
 * ends the process (exit 1). */
void event_log_open(struct event_log *log, const struct view *view, const char *path);

/* Writes some of what is new. True when there may be more at once; false when all is written, or
 * the file system has no room (log->journal.error). */
bool event_log_turn(struct event_log *log, const struct view *view);

/* Closes it. How many committed events it does not hold. */
uint64_t event_log_close(struct event_log *log, const struct view *view);

#endif
