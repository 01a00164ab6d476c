/* The event log: every event of the run, each once, as docs/events.md describes it. */
#ifndef JOLON_RECORDER_LOG_EVENT_LOG_H
#define JOLON_RECORDER_LOG_EVENT_LOG_H

#include "ipc/frame/event_cursor.h"
#include "recorder/log/journal.h"

struct event_log {
    struct journal journal;
    struct event_cursor cursor; /* the event to read next */
    uint64_t written; /* every event before this one is in the file, or counted in a gap */
    bool to_compare;  /* the log's last event is still to be compared with the world's */
    uint64_t gaps;    /* number of events that the ring overwrote before they could be written */
};

/* Opens the log of this world and finds the next event to write. A world made from an image may be
 * behind its log. The log is then cut back to the image, and the rest is kept as path.old. A log of
 * another run ends the process (exit 1). */
void event_log_open(struct event_log *log, const struct view *view, const char *path);

/* Appends some of the new events. Returns true if there may be more to write at once; false when
 * all is written or the file system has no room (log->journal.error). */
bool event_log_append(struct event_log *log, const struct view *view);

/* Closes the log. Returns the number of committed events that it does not hold. */
uint64_t event_log_close(struct event_log *log, const struct view *view);

#endif
