/* What the recorder writes of a run: the command log, the event log, checkpoints. */
#ifndef JOLON_RECORDER_RECORDING_H
#define JOLON_RECORDER_RECORDING_H

#include "ipc/process/log.h"
#include "recorder/back_pressure.h"
#include "recorder/checkpoint.h"
#include "recorder/log/command_log.h"
#include "recorder/log/event_log.h"
#include "recorder/options.h"

struct recorder {
    struct options options;
    struct view view;
    struct command_log commands;
    struct event_log events;
    struct checkpoint checkpoint;
    struct back_pressure pressure;
};

/* Opens the files that the options name, for the attached view. A failure ends the process with the
 * reason (exit 1). */
void recording_open(struct recorder *recorder);

/* Writes the new records of this frame. Returns true if there is more to write at once. */
bool recording_step(struct recorder *recorder, uint64_t frame);

/* Completes and closes the files. Logs each one that is incomplete. Returns EXIT_REFUSED if a log
 * is. */
enum exit_code recording_close(struct recorder *recorder);

#endif
