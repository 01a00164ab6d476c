/* The command log: how the run was made, and every command with its frame, so that the run can be
 * replayed (docs/replay.md). It is written from the event stream. The event of a command holds the
 * whole command and its number in the run. So no command is lost that the event ring still holds,
 * and the number of lost commands is known. */
#ifndef JOLON_RECORDER_LOG_COMMAND_LOG_H
#define JOLON_RECORDER_LOG_COMMAND_LOG_H

#include "ipc/frame/event_cursor.h"
#include "recorder/log/command_record.h"
#include "recorder/log/journal.h"

struct command_log {
    struct journal journal;
    struct event_cursor cursor;
    struct record_position at;  /* position of the last record */
    uint64_t written;           /* the commands of all events before this one are in the file */
    struct command_record mark; /* to be written once all commands before it are */
    bool marking;
    uint64_t marked_ns;
    uint64_t inputs_taken; /* what frames had taken from the gateway's ring at the last inputs */
};

/* Opens the log of this world: begins it, or continues it after its last record. A log of another
 * run is renamed to path.old, which is replaced. A file that is not a command log ends the process
 * (exit 1). */
void command_log_open(struct command_log *log, const struct view *view, const char *path);

/* Appends some of the new commands, like event_log_append(). */
bool command_log_append(struct command_log *log, const struct view *view);

/* Writes the end record: the last committed frame and its digests. Returns 0, or -1 if that or an
 * earlier record could not be written. */
int command_log_close(struct command_log *log, const struct view *view);

#endif
