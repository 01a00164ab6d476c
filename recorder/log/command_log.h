/* The log of commands: what the run was made of, and every command with its frame, so that it can
 * be played again (docs/replay.md). It is a projection of the event stream: a command's event
 * carries the whole command and its number in the run, so nothing is lost while the ring has it,
 * and what is lost is known to the number. */
#ifndef JOLON_RECORDER_LOG_COMMAND_LOG_H
#define JOLON_RECORDER_LOG_COMMAND_LOG_H

#include "ipc/frame/event_cursor.h"
#include "recorder/log/command_record.h"
#include "recorder/log/journal.h"

struct command_log {
    struct journal journal;
    struct event_cursor cursor;
    struct record_place at;     /* of the last record */
    uint64_t written;           /* every event before it was looked at, and its record written */
    struct command_record mark; /* that is due once all events before it are in */
    bool marking;
    uint64_t marked_ns;
};

/* Opens the log of this world, begins it or finds where to go on. A log that another run left there
 * is kept as path.old, in the place of what had that name. A file that is no such log ends the
 * process (exit 1). */
void command_log_open(struct command_log *log, const struct view *view, const char *path);

/* As event_log_turn(). */
bool command_log_turn(struct command_log *log, const struct view *view);

/* Writes the end: the last committed frame and its digests. 0, or -1 when that or anything before
 * it could not be written. */
int command_log_close(struct command_log *log, const struct view *view);

#endif
